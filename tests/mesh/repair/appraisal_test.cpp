// Whether a change of a patch may be: each reason against it alone.
#include "mesh/repair/appraisal.h"

#include <cmath>

#include <gtest/gtest.h>

#include "mesh/repair/operations.h"
#include "tests/mesh/repair/patch_bench.h"

namespace prismesh::mesh::repair {
namespace {

/// Judges all shells as they are; changes begin there.
void begin_judged(Bench& bench) {
  bench.patch.begin();
  std::vector<LocalShell> all;
  for (std::size_t s = 0; s < bench.patch.shell_count(); ++s) all.emplace_back(s);
  judge_shells(bench.site, all);
  bench.patch.keep();
  bench.patch.begin();
}

LocalNode node_at(const Bench& bench, const Grid& grid, std::size_t i, std::size_t j) { return bench.patch.find(at(grid.node(i, j))); }

bool harms_after(Bench& bench, LocalNode node, const Vec3& place) {
  begin_judged(bench);
  bench.patch.move(node, place);
  judge_shells(bench.site, bench.patch.changed_shells());
  return harms(bench.patch);
}

TEST(Harms, when_a_shell_that_passed_fails) {
  const Grid grid = flat(4, 4);
  Bench bench(model_of(grid.positions(), grid.shells()));
  EXPECT_FALSE(harms_after(bench, node_at(bench, grid, 2, 2), Vec3(2.1, 2, 0)));
  EXPECT_TRUE(harms_after(bench, node_at(bench, grid, 2, 2), Vec3(2.9, 2, 0)));
}

TEST(Harms, not_when_shells_that_failed_still_do) {
  const Grid grid = flat(4, 4);
  std::vector<Vec3> positions = grid.positions();
  positions[grid.node(2, 2)].x() = 2.9;
  Bench bench(model_of(positions, grid.shells()));
  EXPECT_FALSE(harms_after(bench, node_at(bench, grid, 2, 2), Vec3(2.88, 2, 0)));
}

/// Flat quads of a tenth's width side by side: all of them fail.
struct Slats {
  Grid grid{3, 1, [](double x, double y) { return Vec3(0.1 * x, y, 0); }, {}};
  Bench bench{model_of(grid.positions(), grid.shells())};
};

TEST(Harms, when_a_new_shell_fails_and_none_is_cured) {
  Slats slats;
  begin_judged(slats.bench);
  ASSERT_FALSE(split_quad(slats.bench.site, slats.bench.shell(1), 0));
  judge_shells(slats.bench.site, slats.bench.patch.changed_shells());
  EXPECT_TRUE(harms(slats.bench.patch));
}

TEST(Harms, not_when_a_new_shell_fails_and_more_are_cured) {
  Slats slats;
  begin_judged(slats.bench);
  Patch& patch = slats.bench.patch;
  const Corners corners = patch.shell(slats.bench.shell(0)).corners;
  patch.remove_shell(slats.bench.shell(0));
  patch.remove_shell(slats.bench.shell(1));
  patch.add_shell(corners, slats.bench.shell(2));
  judge_shells(slats.bench.site, patch.changed_shells());
  EXPECT_FALSE(harms(patch));
}

/// Whether a mesh conforms in which nothing has changed.
bool conforms_as_it_is(Bench& bench) {
  bench.patch.begin();
  for (std::size_t n = 0; n < bench.patch.node_count(); ++n) bench.patch.move(LocalNode(n), bench.patch.position(LocalNode(n)));
  return conforms(bench.patch);
}

TEST(Conforms, whole_sheets_with_holes_and_creases) {
  for (const Grid& grid : {flat(4, 4), cylinder(), l_profile()}) {
    Bench bench(model_of(grid.positions(), grid.shells()));
    EXPECT_TRUE(conforms_as_it_is(bench));
  }
}

TEST(Conforms, not_a_shell_with_a_corner_twice) {
  const Grid grid = flat(1, 1);
  Bench bench(model_of(grid.positions(), grid.shells()));
  bench.patch.begin();
  const Corners c = bench.patch.shell(bench.shell(0)).corners;
  bench.patch.set_corners(bench.shell(0), {c[0], c[1], c[2], c[1]});
  EXPECT_FALSE(conforms(bench.patch));
}

TEST(Conforms, not_two_shells_with_three_corners_in_common) {
  // two quads whose common node has no other shells: flat, and every edge has its two shells
  Bench bench(model_of({{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}}, {{0, 1, 2, 3}, {0, 4, 2, 1}}));
  EXPECT_FALSE(conforms_as_it_is(bench));
}

TEST(Conforms, not_an_edge_inside_a_sheet_with_one_shell) {
  const Grid grid = flat(4, 4);
  Bench bench(model_of(grid.positions(), grid.shells()));
  bench.patch.begin();
  bench.patch.remove_shell(bench.shell(5));
  for (std::size_t n = 0; n < bench.patch.node_count(); ++n) bench.patch.move(LocalNode(n), bench.patch.position(LocalNode(n)));
  EXPECT_FALSE(conforms(bench.patch));
}

TEST(Conforms, not_a_free_edge_with_two_shells) {
  const Grid grid = flat(3, 3);
  Bench bench(model_of(grid.positions(), grid.shells()));
  bench.patch.begin();
  // a tent over the sheet's four corners: its edges have two shells, those of the sheet one too many
  const Corners c = bench.patch.shell(bench.shell(0)).corners;
  const std::array<double, 4> quarters{0.25, 0.25, 0.25, 0.25};
  const LocalNode top = bench.patch.add_node(Vec3(0.5, -0.5, -2), c, quarters, relax::Freedom::surface);
  bench.patch.add_shell(triangle(c[0], c[1], top), bench.shell(0));
  EXPECT_FALSE(conforms(bench.patch));
}

TEST(Conforms, not_a_sheet_folded_where_it_has_no_crease) {
  // two flanges 30 degrees apart
  const auto folded = [](double x, double y) { return x <= 3 ? Vec3(x, y, 0) : Vec3(3 - std::sqrt(0.75) * (x - 3), y, 0.5 * (x - 3)); };
  const Grid crease{6, 4, folded, {}};
  Bench sharp(model_of(crease.positions(), crease.shells()));
  EXPECT_TRUE(conforms_as_it_is(sharp)) << "a crease may be sharp";
  const Grid grid = flat(6, 4);
  Bench bench(model_of(grid.positions(), grid.shells()));
  bench.patch.begin();
  for (std::size_t n = 0; n < bench.patch.node_count(); ++n) {
    const Vec3& place = bench.patch.position(LocalNode(n));
    bench.patch.move(LocalNode(n), folded(place.x(), place.y()));
  }
  EXPECT_FALSE(conforms(bench.patch));
}

TEST(KeepsToSurface, within_what_is_allowed_or_was_there) {
  const Grid grid = flat(4, 4);
  Bench bench(model_of(grid.positions(), grid.shells()));
  ASSERT_EQ(bench.options.most_off_surface, 0.02);
  const LocalNode node = node_at(bench, grid, 2, 2);
  const auto keeps_at = [&](double height) {
    bench.patch.begin();
    bench.patch.move(node, Vec3(2, 2, height));
    const bool keeps = keeps_to_surface(bench.site);
    bench.patch.take_back();
    return keeps;
  };
  // an edge's middle is half as far off as the node
  EXPECT_TRUE(keeps_at(0.039));
  EXPECT_FALSE(keeps_at(0.041));
  bench.patch.begin();
  bench.patch.move(node, Vec3(2, 2, 0.4));
  bench.patch.keep();
  EXPECT_TRUE(keeps_at(0.4));
  EXPECT_TRUE(keeps_at(-0.1)) << "better than it was";
  EXPECT_FALSE(keeps_at(0.7));
}

}  // namespace
}  // namespace prismesh::mesh::repair
