#include "mesh/repair/strips.h"

#include <gtest/gtest.h>

#include "tests/mesh/repair/patch_fixture.h"
#include "tests/mesh/repair/validator.h"

namespace prismesh::mesh::repair {
namespace {

std::size_t edges_with(const Model& model, std::size_t shells) {
  std::size_t count = 0;
  for (std::size_t e = 0; e < model.adjacency->edge_count(); ++e)
    count += model.adjacency->shells_of(EdgeIndex(e)).size() == shells ? 1 : 0;
  return count;
}

TEST(Strips, go_from_one_end_of_the_sheet_to_the_other_without_a_triangle) {
  const Grid grid = flat(5, 4);
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  const Strip strip{fixture.shell(grid.shell(2, 1)), 0};
  EXPECT_EQ(path_of(fixture.patch, strip).quads.size(), 4U);
  ASSERT_FALSE(fixture.divide(strip));
  const Model after = fixture.after();
  EXPECT_EQ(what_is_wrong(after), "");
  EXPECT_EQ(live_shells(after), 24U);
  EXPECT_EQ(live_nodes(after), 35U);
  EXPECT_EQ(triangles(after), 0U);
}

TEST(Strips, are_divided_into_as_many_as_asked_evenly) {
  const Grid grid{4, 3, [](double x, double y) { return Vec3(x < 3 ? x : x + 3, y, 0); }, {}};
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  ASSERT_FALSE(fixture.divide({fixture.shell(grid.shell(2, 1)), 0}, 4));
  const Model after = fixture.after();
  EXPECT_EQ(what_is_wrong(after), "");
  EXPECT_EQ(live_shells(after), 12U + 3 * 3);
  for (const ShellIndex shell : all_shells(after)) {
    const ShellNodes& nodes = after.shell(shell);
    EXPECT_NEAR((after.position(nodes.node[0]) - after.position(nodes.node[1])).norm(), 1, 1e-6);
  }
}

TEST(Strips, end_before_or_behind_shells_that_may_not_become_triangles) {
  // Columns that become narrower with y: an edge along x is 2 - 0.2 y long.
  const Grid grid{5, 8, [](double x, double y) { return Vec3((x - 2.5) * (2 - 0.2 * y), y, 0); }, {}};
  const auto triangle_rows = [&](const Rules& rules) {
    PatchFixture fixture(model_of(grid.positions(), grid.shells()), rules);
    EXPECT_FALSE(fixture.divide({fixture.shell(grid.shell(2, 0)), 0, 1.25, 1e9}));
    const Model after = fixture.after();
    EXPECT_EQ(what_is_wrong(after), "");
    std::vector<double> rows;
    for (const ShellIndex shell : all_shells(after))
      if (after.shell(shell).is_triangle()) rows.push_back(std::floor(after.position(after.shell(shell).node[0]).y()));
    return rows;
  };
  EXPECT_EQ(triangle_rows({}), std::vector<double>{3}) << "where the edges are shorter than 1.25";
  Rules rules;
  rules.shell = [](ShellIndex shell) { return static_cast<std::uint8_t>(shell.value / 5 == 3 || shell.value / 5 == 4 ? kNoTriangle : 0); };
  EXPECT_EQ(triangle_rows(rules), std::vector<double>{5});
  rules.shell = [](ShellIndex shell) { return static_cast<std::uint8_t>(shell.value / 5 >= 3 ? kNoTriangle : 0); };
  EXPECT_EQ(triangle_rows(rules), std::vector<double>{}) << "through the whole sheet";
}

TEST(Strips, close_around_a_tube) {
  constexpr std::size_t kAround = 12, kLong = 4;
  std::vector<Vec3> positions;
  std::vector<std::array<std::size_t, 4>> shells;
  for (std::size_t j = 0; j <= kLong; ++j)
    for (std::size_t i = 0; i < kAround; ++i) {
      const double angle = 2 * M_PI * static_cast<double>(i) / kAround;
      positions.emplace_back(2 * std::cos(angle), 2 * std::sin(angle), static_cast<double>(j));
    }
  for (std::size_t j = 0; j < kLong; ++j)
    for (std::size_t i = 0; i < kAround; ++i) {
      const std::size_t next = (i + 1) % kAround;
      shells.push_back({i + j * kAround, next + j * kAround, next + (j + 1) * kAround, i + (j + 1) * kAround});
    }
  PatchFixture fixture(model_of(positions, shells));
  ASSERT_FALSE(fixture.divide({fixture.shell(17), 1}));
  const Model after = fixture.after();
  EXPECT_EQ(what_is_wrong(after), "");
  EXPECT_EQ(live_shells(after), 5 * kAround);
  EXPECT_EQ(edges_with(after, 1), 2 * kAround);
  EXPECT_EQ(triangles(after), 0U);
}

/// Three sheets of 3 by 4 quads that meet along the y axis.
Model star() {
  std::vector<Vec3> positions;
  std::vector<std::array<std::size_t, 4>> shells;
  for (std::size_t j = 0; j <= 4; ++j) positions.emplace_back(0, static_cast<double>(j), 0);
  for (int arm = 0; arm < 3; ++arm) {
    const double angle = 2 * M_PI * arm / 3;
    const std::size_t first = positions.size();
    for (std::size_t i = 1; i <= 3; ++i)
      for (std::size_t j = 0; j <= 4; ++j)
        positions.emplace_back(static_cast<double>(i) * std::cos(angle), static_cast<double>(j), static_cast<double>(i) * std::sin(angle));
    const auto node = [&](std::size_t i, std::size_t j) { return i == 0 ? j : first + (i - 1) * 5 + j; };
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 4; ++j) shells.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
  }
  return model_of(positions, shells);
}

TEST(Strips, divide_every_sheet_where_three_meet) {
  PatchFixture fixture(star());
  ASSERT_EQ(edges_with(fixture.model, 3), 4U);
  ASSERT_FALSE(fixture.divide({fixture.shell(1), 1}));  // across the edges that run along the junction
  const Model after = fixture.after();
  EXPECT_EQ(live_shells(after), 36U + 9);
  EXPECT_EQ(edges_with(after, 3), 5U);
  EXPECT_EQ(triangles(after), 0U);
  for (const ShellIndex shell : all_shells(after)) EXPECT_FALSE(after.shell(shell).is_triangle());
}

TEST(Strips, end_before_short_edges_in_a_triangle_that_has_the_shorter_diagonal) {
  // Columns get narrower from 3 to 0.75.
  const Grid grid{3, 6, [](double x, double y) { return Vec3(x == 2 || x == 3 ? 1 + (x - 1) * (3 - 0.375 * y) : x, y, 0); }, {}};
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  const Strip strip{fixture.shell(grid.shell(1, 0)), 0, 2.0};
  const std::vector<StripQuad> quads = path_of(fixture.patch, strip).quads;
  EXPECT_EQ(quads.size(), 2U) << "the edges are 3, 2.625, 2.25 and then 1.875 long";
  ASSERT_FALSE(fixture.divide(strip));
  const Model after = fixture.after();
  EXPECT_EQ(what_is_wrong(after), "");
  EXPECT_EQ(triangles(after), 1U);
  EXPECT_EQ(live_shells(after), 18U + 3);
}

TEST(Strips, of_three_end_in_a_quad_between_two_triangles) {
  const Grid grid{3, 6, [](double x, double y) { return Vec3(x == 2 || x == 3 ? 1 + (x - 1) * (3 - 0.375 * y) : x, y, 0); }, {}};
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  ASSERT_FALSE(fixture.divide({fixture.shell(grid.shell(1, 0)), 0, 2.0}, 3));
  const Model after = fixture.after();
  EXPECT_EQ(what_is_wrong(after), "");
  EXPECT_EQ(triangles(after), 2U);
  EXPECT_EQ(triangle_pairs(after), 0U);
  EXPECT_EQ(live_shells(after), 18U + 2 * 2 + 2);
  EXPECT_TRUE(fixture.divide({fixture.shell(grid.shell(1, 0)), 0, 2.0}, 4)) << "there is no way to end four";
}

TEST(Strips, end_in_a_triangle) {
  const Model model = model_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.5, 2, 0}}, {{0, 1, 3, 2}, {2, 3, 4, 4}});
  for (const bool absorbs : {true, false}) {
    PatchFixture fixture(model);
    ASSERT_FALSE(fixture.divide({fixture.shell(0), 0}, 2, absorbs));
    const Model after = fixture.after();
    EXPECT_EQ(what_is_wrong(after), "");
    EXPECT_EQ(live_shells(after), absorbs ? 3U : 4U);
    EXPECT_EQ(triangles(after), absorbs ? 0U : 2U);
  }
}

TEST(Strips, go_around_a_triangle) {
  // Quads at two edges of a triangle, and a third one that leads from one to the other outside.
  const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {-1, 1, 0}, {0, -1, 0}, {1, -1, 0}};
  PatchFixture fixture(model_of(positions, {{0, 1, 2, 2}, {3, 0, 2, 4}, {5, 6, 1, 0}, {3, 4, 6, 5}}));
  ASSERT_FALSE(fixture.divide({fixture.shell(1), 1}));
  const Model after = fixture.after();
  EXPECT_EQ(what_is_wrong(after), "");
  EXPECT_EQ(live_shells(after), 8U);
  EXPECT_EQ(triangles(after), 1U) << "at the corner between the quads";
}

TEST(Strips, stop_before_what_may_not_be_divided) {
  const Grid grid = flat(5, 6);
  Rules rules;
  rules.shell = [&](ShellIndex shell) { return shell == shell_at(2 + 3 * 5) ? std::uint8_t{kIndivisible} : std::uint8_t{0}; };
  PatchFixture fixture(model_of(grid.positions(), grid.shells()), rules);
  const Strip strip{fixture.shell(2 + 0 * 5), 0};
  EXPECT_EQ(path_of(fixture.patch, strip).quads.size(), 2U);
  ASSERT_FALSE(fixture.divide(strip));
  const Model after = fixture.after();
  EXPECT_EQ(what_is_wrong(after), "");
  EXPECT_EQ(triangles(after), 1U) << "in the shell before";
  EXPECT_EQ(after.shell(shell_at(17)).node, fixture.model.shell(shell_at(17)).node);
}

TEST(Strips, that_cross_themselves_are_refused) {
  // The way from edge 2-3 of the first quad leads through the second and third into its edge 3-0.
  const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}};
  PatchFixture fixture(model_of(positions, {{0, 1, 2, 3}, {3, 2, 4, 1}, {1, 4, 3, 0}}));
  const Strip strip{fixture.shell(0), 0};
  const Refusal refusal = fixture.divide(strip);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(*refusal, "the strip of quads there crosses itself");
  EXPECT_TRUE(path_of(fixture.patch, strip).quads.empty());
}

TEST(Strips, go_and_leave_the_sheet_whole) {
  const Grid grid{5, 4, [](double x, double y) { return Vec3(x < 3 ? x : x - 0.75, y, 0); }, {}};
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  ASSERT_FALSE(fixture.collapse({fixture.shell(grid.shell(2, 1)), 0}));
  const Model after = fixture.after();
  EXPECT_EQ(what_is_wrong(after), "");
  EXPECT_EQ(live_shells(after), 16U);
  EXPECT_EQ(triangles(after), 0U);
  const Shape was = shape_of(fixture.model), is = shape_of(after);
  EXPECT_EQ(is.euler, was.euler);
  EXPECT_NEAR(is.free_length, was.free_length, 1e-9);
  EXPECT_NEAR(is.area, was.area, 1e-9);
}

TEST(Strips, that_go_end_before_long_edges_in_a_triangle) {
  // The third column widens from 0.25 upwards.
  const Grid grid{4, 6, [](double x, double y) { return Vec3(x < 3 ? x : x - 0.75 + 0.2 * y, y, 0); }, {}};
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  ASSERT_FALSE(fixture.collapse({fixture.shell(grid.shell(2, 0)), 0, 0, 0.7}));
  const Model after = fixture.after();
  EXPECT_EQ(what_is_wrong(after), "");
  EXPECT_EQ(triangles(after), 1U);
  EXPECT_EQ(live_shells(after), 24U - 2) << "the edges are 0.25, 0.45, 0.65 and then 0.85 long";
}

TEST(Strips, between_two_lines_of_the_part_stay) {
  // A sheet of one column between two free edges.
  const Grid grid = flat(1, 4);
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  EXPECT_TRUE(fixture.collapse({fixture.shell(1), 0}));
}

TEST(Repairs, cure_a_squeezed_sheet_by_taking_strips_out) {
  const Grid grid{12,
                  9,
                  [](double x, double y) {
                    const double at[13] = {0, 1, 2, 3, 4, 4.2, 4.4, 5.4, 6.4, 7.4, 8.4, 9.4, 10.4};
                    return Vec3(at[static_cast<int>(x)], y, 0);
                  },
                  {}};
  const Model model = model_of(grid.positions(), grid.shells());
  const relax::ReferenceSurface surface(model, all_shells(model), Options{}.relax.feature_angle);
  const auto repaired = repair({model, surface, {}, {quality::default_criteria(), 1}, {}}, all_shells(model));
  ASSERT_TRUE(repaired) << repaired.error().message;
  EXPECT_EQ(repaired->bad_before, 18U);
  const Model after = carried_out(model, repaired->change);
  EXPECT_EQ(what_is_wrong(after), "");
  EXPECT_EQ(triangles(after), 0U);
  EXPECT_TRUE(repaired->unrepaired.empty());
}

TEST(Repairs, cure_a_stretched_sheet_by_whole_strips) {
  // Stretched to 3.4 in the middle, 1.7 beside.
  const Grid grid{12,
                  9,
                  [](double x, double y) {
                    const double at[13] = {0, 1, 2, 3, 4.7, 8.1, 11.5, 13.2, 14.2, 15.2, 16.2, 17.2, 18.2};
                    return Vec3(at[static_cast<int>(x)], y, 0);
                  },
                  {}};
  const Model model = model_of(grid.positions(), grid.shells());
  const relax::ReferenceSurface surface(model, all_shells(model), Options{}.relax.feature_angle);
  const quality::SizedCriteria criteria{quality::default_criteria(), 1};
  const auto repaired = repair({model, surface, {}, criteria, {}}, all_shells(model));
  ASSERT_TRUE(repaired) << repaired.error().message;
  EXPECT_EQ(repaired->bad_before, 36U);
  const Model after = carried_out(model, repaired->change);
  EXPECT_EQ(what_is_wrong(after), "");
  EXPECT_EQ(triangles(after), 0U);
  EXPECT_TRUE(repaired->unrepaired.empty());
}

}  // namespace
}  // namespace prismesh::mesh::repair
