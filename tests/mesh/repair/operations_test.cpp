// Operations on a patch one by one, in small sheets whose result is known beforehand.
#include "mesh/repair/redivide.h"

#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "mesh/quality/report.h"
#include "mesh/repair/candidates.h"
#include "mesh/repair/collapse.h"
#include "mesh/repair/divide.h"
#include "mesh/repair/node_moves.h"
#include "tests/mesh/repair/patch_fixture.h"
#include "tests/mesh/repair/validator.h"

namespace prismesh::mesh::repair {
namespace {

/// A fixture on a grid, whose nodes are named by their places in it.
struct GridFixture : PatchFixture {
  explicit GridFixture(const Grid& made, Rules forbidden = {})
      : PatchFixture(model_of(made.positions(), made.shells()), std::move(forbidden)), grid(made) {
    patch.begin();
  }
  LocalNode node(std::size_t i, std::size_t j) const { return patch.find(at(grid.node(i, j))); }
  std::string refusal(const Refusal& why) const { return why ? std::string(*why) : "done"; }
  Grid grid;
};

/// Forbids what `of` says of a node of the model.
Rules rules_of_nodes(std::function<std::uint8_t(NodeIndex)> of) {
  Rules rules;
  rules.node = std::move(of);
  return rules;
}

TEST(Divisions, are_all_with_at_most_so_many_triangles) {
  const std::map<std::pair<std::size_t, int>, std::size_t> wanted{{{4, 0}, 1}, {{4, 1}, 1}, {{4, 2}, 3},  {{5, 0}, 0}, {{5, 1}, 10},
                                                                  {{6, 0}, 3}, {{6, 1}, 3}, {{6, 2}, 12}, {{7, 2}, 0}};
  for (const auto& [what, count] : wanted) {
    const auto& [corners, max_triangles] = what;
    Loop loop;
    for (std::size_t i = 0; i < corners; ++i) loop.emplace_back(10 + i);
    const std::vector<std::vector<Loop>> found = divisions(loop, max_triangles);
    EXPECT_EQ(found.size(), count) << corners << " corners, " << max_triangles << " triangles";
    EXPECT_EQ(std::set<std::vector<Loop>>(found.begin(), found.end()).size(), found.size()) << "one is there twice";
    for (const std::vector<Loop>& pieces : found) {
      int triangles = 0;
      std::map<std::pair<std::size_t, std::size_t>, int> sides;
      for (const Loop& piece : pieces) {
        ASSERT_TRUE(piece.size() == 3 || piece.size() == 4);
        triangles += piece.size() == 3 ? 1 : 0;
        for (std::size_t k = 0; k < piece.size(); ++k) ++sides[{piece[k].value, piece[(k + 1) % piece.size()].value}];
      }
      EXPECT_LE(triangles, max_triangles);
      // In the loop's sense: its own sides once, those between pieces once each way.
      for (std::size_t i = 0; i < corners; ++i) EXPECT_EQ(sides[std::pair(loop[i].value, loop[(i + 1) % corners].value)], 1);
      for (const auto& [side, times] : sides) {
        EXPECT_EQ(times, 1);
        const bool outer = (side.first - 10 + 1) % corners == side.second - 10;
        EXPECT_EQ(sides.contains({side.second, side.first}), !outer);
      }
    }
  }
}

TEST(UnionOf, takes_the_freer_node_away) {
  // A roof: its ridge is the line of nodes with i = 2.
  const Grid roof{4, 4, [](double x, double y) { return Vec3(x, y, 1 - std::abs(x - 2)); }, {}};
  const GridFixture fixture(roof);
  const auto goes = [&](LocalNode a, LocalNode b) {
    const std::optional<Collapse> there = collapse_of(fixture.context, a, b), back = collapse_of(fixture.context, b, a);
    EXPECT_EQ(there.has_value(), back.has_value());
    if (!there || !back) return LocalNode();
    EXPECT_EQ(there->removed, back->removed) << "whatever the order";
    EXPECT_EQ(there->kept, there->removed == a ? b : a);
    return there->removed;
  };
  EXPECT_EQ(goes(fixture.node(1, 1), fixture.node(1, 2)), fixture.node(1, 2)) << "of equals the one that was there before stays";
  EXPECT_EQ(goes(fixture.node(1, 1), fixture.node(2, 1)), fixture.node(1, 1)) << "one on the ridge stays";
  EXPECT_EQ(goes(fixture.node(0, 1), fixture.node(1, 1)), fixture.node(1, 1)) << "one on the border stays";
  EXPECT_EQ(goes(fixture.node(0, 0), fixture.node(0, 1)), fixture.node(0, 1)) << "the corner stays";
  EXPECT_EQ(goes(fixture.node(2, 0), fixture.node(2, 1)), fixture.node(2, 1)) << "the ridge's end stays";
  EXPECT_FALSE(goes(fixture.node(0, 0), fixture.node(4, 0)).valid()) << "both hold the shape";
}

TEST(UnionOf, keeps_what_is_needed_or_has_to_stay) {
  const Grid grid = flat(4, 4);
  const NodeIndex needed = at(grid.node(1, 2)), staying = at(grid.node(2, 3));
  const GridFixture fixture(grid, rules_of_nodes([&](NodeIndex node) -> std::uint8_t {
                              return node == needed ? std::uint8_t{kNeeded} : node == staying ? std::uint8_t{kStays} : std::uint8_t{0};
                            }));
  EXPECT_EQ(collapse_of(fixture.context, fixture.node(1, 1), fixture.node(1, 2))->removed, fixture.node(1, 1));
  EXPECT_EQ(collapse_of(fixture.context, fixture.node(2, 2), fixture.node(2, 3))->removed, fixture.node(2, 2));
  EXPECT_EQ(collapse_of(fixture.context, fixture.node(0, 2), fixture.node(1, 2))->removed, fixture.node(0, 2))
      << "even one of the border goes";
}

TEST(Unite, puts_the_node_in_the_middle_unless_it_has_to_stay) {
  for (const bool stays : {false, true}) {
    const Grid grid = flat(4, 4);
    const NodeIndex kept = at(grid.node(1, 1));
    GridFixture fixture(grid, rules_of_nodes([&](NodeIndex node) -> std::uint8_t {
                          return stays && node == kept ? std::uint8_t{kStays} : std::uint8_t{0};
                        }));
    ASSERT_EQ(fixture.refusal(collapse_nodes(fixture.context, {{fixture.node(2, 1), fixture.node(1, 1)}})), "done");
    EXPECT_NEAR((fixture.patch.position(fixture.node(1, 1)) - Vec3(stays ? 1 : 1.5, 1, 0)).norm(), 0, 1e-9);
    const Model after = fixture.after();
    EXPECT_EQ(what_is_wrong(after), "");
    EXPECT_EQ(live_nodes(after), 24U);
    EXPECT_EQ(live_shells(after), 16U) << "the two quads at the edge are triangles now";
    EXPECT_EQ(triangles(after), 2U);
  }
}

TEST(Unite, shortens_a_straight_line_and_bends_none) {
  GridFixture fixture(flat(4, 4));
  ASSERT_EQ(fixture.refusal(collapse_nodes(fixture.context, {{fixture.node(2, 0), fixture.node(1, 0)}})), "done");
  EXPECT_EQ(fixture.patch.position(fixture.node(1, 0)), Vec3(1, 0, 0)) << "on a line the node stays where it is";
  EXPECT_EQ(what_is_wrong(fixture.after()), "");
  GridFixture arc(Grid{4, 4, [](double x, double y) { return Vec3(x, y * (1 + 0.1 * x * (4 - x)) - 0.2 * x * (4 - x), 0); }, {}});
  EXPECT_EQ(arc.refusal(collapse_nodes(arc.context, {{arc.node(2, 0), arc.node(1, 0)}})), "that would bend an edge of the part");
  GridFixture corner(flat(4, 4));
  EXPECT_EQ(corner.refusal(collapse_nodes(corner.context, {{corner.node(0, 0), corner.node(1, 0)}})), "both nodes hold the part's shape");
  GridFixture across(flat(4, 1));
  EXPECT_EQ(across.refusal(collapse_nodes(across.context, {{across.node(2, 0), across.node(2, 1)}})), "that would bend an edge of the part")
      << "the sheet would be pinched off";
  GridFixture twice(flat(4, 4));
  EXPECT_EQ(twice.refusal(collapse_nodes(twice.context, {{twice.node(2, 1), twice.node(1, 1)}, {twice.node(2, 2), twice.node(2, 1)}})),
            "the nodes run into each other");
}

TEST(LiftNode, goes_along_the_normal_whichever_way_its_shells_are_turned) {
  Grid grid{4, 4, [](double x, double y) { return Vec3(x, 0.6 * y, 0.8 * y); }, {}};
  std::vector<std::array<std::size_t, 4>> shells = grid.shells();
  for (const std::size_t turned : {grid.shell(1, 1), grid.shell(2, 2), grid.shell(2, 1)})
    std::reverse(shells[turned].begin(), shells[turned].end());
  PatchFixture fixture(model_of(grid.positions(), shells));
  fixture.patch.begin();
  const LocalNode middle = fixture.patch.find(at(grid.node(2, 2)));
  ASSERT_FALSE(lift_node(fixture.context, middle, 0.25));
  const Vec3 moved = fixture.patch.position(middle) - grid.place(2, 2);
  EXPECT_NEAR(moved.norm(), 0.25, 1e-9);
  EXPECT_NEAR(std::abs(moved.dot(Vec3(0, -0.8, 0.6))), 0.25, 1e-9);
  EXPECT_TRUE(lift_node(fixture.context, fixture.patch.find(at(grid.node(0, 2))), 0.25)) << "the border holds the shape";
}

TEST(LiftNode, is_refused_where_the_node_stays_or_lies_on_an_edge_of_the_part) {
  const Grid roof{4, 4, [](double x, double y) { return Vec3(x, y, 1 - std::abs(x - 2)); }, {}};
  const NodeIndex staying = at(roof.node(1, 1));
  GridFixture fixture(
      roof, rules_of_nodes([&](NodeIndex node) -> std::uint8_t { return node == staying ? std::uint8_t{kStays} : std::uint8_t{0}; }));
  EXPECT_EQ(fixture.refusal(lift_node(fixture.context, fixture.node(1, 1), 0.1)), "the node can't be moved");
  EXPECT_EQ(fixture.refusal(lift_node(fixture.context, fixture.node(2, 1), 0.1)), "the node can't be moved");
  EXPECT_EQ(fixture.refusal(lift_node(fixture.context, fixture.node(1, 2), 0.1)), "done");
}

TEST(DivideRow, is_refused_where_a_ring_of_quads_runs_into_itself) {
  // four quads around a square tube, and eight around another: the first is in the row's way again, or is beyond both of its ends
  for (const std::size_t around : {4, 8}) {
    std::vector<Vec3> positions;
    std::vector<std::array<std::size_t, 4>> shells;
    for (std::size_t i = 0; i < around; ++i) {
      const double angle = 2 * 3.14159265358979323846 * static_cast<double>(i) / static_cast<double>(around);
      for (const double height : {0.0, 1.0}) positions.emplace_back(std::cos(angle), std::sin(angle), height);
      const std::size_t next = (i + 1) % around;
      shells.push_back({2 * i, 2 * next, 2 * next + 1, 2 * i + 1});
    }
    for (const auto& [forward, back] : {std::pair{0, 0}, {1, 0}, {1, 1}, {2, 0}, {2, 1}, {3, 0}, {4, 0}}) {
      SCOPED_TRACE(std::to_string(around) + " around, " + std::to_string(forward) + " forward, " + std::to_string(back) + " back");
      PatchFixture fixture(model_of(positions, shells));
      fixture.patch.begin();
      Row row{fixture.shell(0), 1};
      row.forward = forward;
      row.back = back;
      const bool is_row = forward + back + 3 <= static_cast<int>(around);  // with its own first quad and one beyond each end
      EXPECT_EQ(ends_of(fixture.patch, row).has_value(), is_row);
      if (!is_row) {
        EXPECT_EQ(divide_row(fixture.context, row).value_or("done"), "there is no row of quads");
      }
    }
  }
}

TEST(Redivide, keeps_shells_of_different_thickness_apart) {
  for (const float thickness : {1.0F, 1.5F}) {
    Model model = model_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2, 2}, {0, 2, 3, 3}});
    model.shell_thickness.set(1, thickness);
    PatchFixture fixture(std::move(model));
    fixture.patch.begin();
    const Loop loop = loop_of(fixture.patch, fixture.shell(0), fixture.shell(1));
    ASSERT_EQ(loop.size(), 4u);
    EXPECT_EQ(redivide(fixture.context, fixture.shell(0), fixture.shell(1), {loop}).value_or("done"),
              thickness == 1 ? "done" : "they differ in part or thickness");
  }
}

TEST(Redivide, keeps_shells_of_different_sets_apart) {
  const Grid grid = flat(4, 4);
  Rules rules;
  const std::size_t first = grid.shell(1, 1), second = grid.shell(2, 1), other = grid.shell(1, 2);
  rules.may_exchange = [&](ShellIndex a, ShellIndex b) { return (a == shell_at(second)) == (b == shell_at(second)); };
  GridFixture fixture(grid, rules);
  const auto outcome = [&](std::size_t a, std::size_t b) {
    const Loop loop = loop_of(fixture.patch, fixture.shell(a), fixture.shell(b));
    const std::string said = fixture.refusal(redivide(fixture.context, fixture.shell(a), fixture.shell(b), divisions(loop, 0).front()));
    fixture.patch.take_back();
    fixture.patch.begin();
    return said;
  };
  EXPECT_EQ(outcome(first, second), "they are in different sets");
  EXPECT_EQ(outcome(second, first), "they are in different sets");
  EXPECT_EQ(outcome(first, other), "done");
}

TEST(Candidates, lift_each_corner_of_a_warped_quad_to_either_side) {
  Grid grid = flat(5, 5);
  grid.place = [](double x, double y) { return Vec3(x, y, x == 2 && y == 2 ? 0.2 : 0); };
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  const LocalShell warped = fixture.shell(grid.shell(2, 2));
  fixture.patch.begin();
  quality::ShellState state = fixture.patch.shell(warped).state;
  state.warn = 1U << static_cast<unsigned>(quality::Metric::warpage);
  fixture.patch.set_judged(warped, fixture.patch.shell(warped).composite, state);
  const LocalNode peak = fixture.patch.find(at(grid.node(2, 2)));
  const double height = fixture.patch.position(peak).z();
  int up = 0, down = 0;
  for (const Candidate& candidate : candidates_for(fixture.context, warped)) {
    if (candidate.operation != Operation::move) continue;
    if (!candidate.apply()) {
      const double by = fixture.patch.position(peak).z() - height;
      up += by > 0.01 ? 1 : 0;
      down += by < -0.01 ? 1 : 0;
    }
    fixture.patch.take_back();
    fixture.patch.begin();
  }
  EXPECT_EQ(up, 1);
  EXPECT_EQ(down, 1);
}

/// Twelve elements wide; eleven quads in a row below y = 5, ten above, and between them a triangle beside a quad, with an edge twice as
/// long as others in common.
struct Taper {
  static constexpr std::size_t kRows = 5, kLower = 11, kUpper = 10, kGap = 5;  ///< columns; the triangle is on the gap's edge
  std::vector<Vec3> positions;
  std::vector<std::array<std::size_t, 4>> shells;
  std::size_t first = 0;  ///< node at the left end of the edge; the next is at its right end

  Taper() {
    for (std::size_t j = 0; j <= 2 * kRows; ++j) {
      const std::size_t columns = j <= kRows ? kLower : kUpper;
      // From row to row the columns get as wide as the gap asks for.
      const double wide = j <= kRows ? 1 + 1.1 * static_cast<double>(j) / kRows : 1.0;
      double x = 0;
      for (std::size_t i = 0; i <= columns; ++i) {
        positions.emplace_back(x, static_cast<double>(j), 0);
        x += j <= kRows ? (i == kGap ? wide : (12 - wide) / (kLower - 1.0)) : 12.0 / kUpper;
      }
    }
    const auto node = [](std::size_t i, std::size_t j) {
      return j <= kRows ? i + j * (kLower + 1) : i + (kRows + 1) * (kLower + 1) + (j - kRows - 1) * (kUpper + 1);
    };
    for (std::size_t j = 0; j < 2 * kRows; ++j) {
      const std::size_t columns = j < kRows ? kLower : kUpper;
      for (std::size_t i = 0; i < columns; ++i) {
        const std::size_t below = j == kRows && i >= kGap ? i + 1 : i;  // beyond the triangle
        shells.push_back({node(below, j), node(below + 1, j), node(i + 1, j + 1), node(i, j + 1)});
      }
    }
    first = node(kGap, kRows);
    shells.push_back({first, first + 1, node(kGap, kRows + 1), node(kGap, kRows + 1)});
  }
};

TEST(DivideEdge, between_a_triangle_and_a_quad_is_taken_where_nothing_else_helps) {
  const Taper taper;
  const Model bad = model_of(taper.positions, taper.shells);
  const quality::SizedCriteria criteria{quality::default_criteria(), 1};
  const auto counts = [&](const Model& model) { return quality::count(quality::judge_model(model, criteria)); };
  ASSERT_GE(counts(bad).fail, 2u) << "the edge is more than twice as long as it should be";
  const std::size_t quad = (Taper::kRows - 1) * Taper::kLower + Taper::kGap, tip = taper.shells.size() - 1;
  Rules rules;  // nothing but the two can be divided, and their edge keeps its length
  rules.shell = [=](ShellIndex s) { return s == shell_at(quad) || s == shell_at(tip) ? std::uint8_t{0} : std::uint8_t{kIndivisible}; };
  rules.node = [&](NodeIndex n) { return n == at(taper.first) || n == at(taper.first + 1) ? std::uint8_t{kStays} : std::uint8_t{0}; };
  const relax::ReferenceSurface surface(bad, all_shells(bad), 30);
  const auto repaired = repair({bad, surface, rules, criteria, {}}, all_shells(bad));
  ASSERT_TRUE(repaired.has_value());
  const Model after = carried_out(bad, repaired->change);
  EXPECT_EQ(what_is_wrong(after), "");
  EXPECT_EQ(counts(after).fail, 0u);
  EXPECT_EQ(triangles(after), 1u) << "the triangle became a quad, and the quad a quad and a triangle";
  EXPECT_EQ(repaired->change.new_nodes.size(), 1u);
  EXPECT_EQ(repaired->done[static_cast<std::size_t>(Operation::split)], 1u);
}

TEST(Patch, works_on_no_node_whose_shells_it_has_not_all) {
  const Grid grid = flat(8, 8);
  const Model model = model_of(grid.positions(), grid.shells());
  const Rules rules;
  const Patch patch(model, {shell_at(grid.shell(4, 4))}, 1, rules, 30);
  EXPECT_EQ(patch.shell_count(), 9u);
  std::size_t whole = 0;
  for (std::size_t n = 0; n < patch.node_count(); ++n) whole += patch.node(LocalNode(n)).is_whole ? 1 : 0;
  EXPECT_EQ(whole, 4u) << "the corners of the shell itself";
  EXPECT_TRUE(patch.node(patch.find(at(grid.node(4, 4)))).is_whole);
  EXPECT_FALSE(patch.node(patch.find(at(grid.node(3, 3)))).is_whole);
  const auto may_divide = [&](std::size_t i, std::size_t j, std::size_t k, std::size_t l) {
    return patch.may_divide(patch.find(at(grid.node(i, j))), patch.find(at(grid.node(k, l))));
  };
  EXPECT_TRUE(may_divide(4, 4, 5, 4));
  EXPECT_TRUE(may_divide(4, 3, 4, 4)) << "all of its shells are there";
  EXPECT_FALSE(may_divide(3, 3, 4, 3)) << "the shell beyond would keep a hanging node";
  EXPECT_FALSE(may_divide(3, 4, 3, 3));
}

}  // namespace
}  // namespace prismesh::mesh::repair
