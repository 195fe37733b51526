#include "mesh/contact/moved_shells.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "mesh/contact/close_shells.h"
#include "mesh/contact/shell_crossings.h"
#include "mesh/model/adjacency.h"
#include "tests/mesh/contact/sheets_that_meet.h"

namespace prismesh::mesh::contact {
namespace {

using test::SheetsThatMeet;

/// A drag of some nodes of a model, all by the same way.
struct TestDrag {
  Model model;
  NodeSet nodes;
  ShellSet shells;
  std::vector<Vec3> start;
  MovedShells moved;

  TestDrag(const Model& of, double thickness, const std::function<bool(const Vec3&)>& moves)
      : model(of),
        nodes(nodes_where(of, moves)),
        shells(shells_touching(of, nodes)),
        start(places(of, nodes)),
        moved(of, spatial::BoxTree(of),
              std::make_shared<const ContactThickness>(thickness > 0 ? given_thickness(of, thickness) : section_thickness(of)), nodes,
              shells) {}

  static NodeSet nodes_where(const Model& of, const std::function<bool(const Vec3&)>& moves) {
    NodeSet nodes;
    for (std::size_t n = 0; n < of.node_count(); ++n)
      if (moves(of.positions[n])) nodes.push_back(NodeIndex(n));
    return nodes;
  }
  static std::vector<Vec3> places(const Model& of, const NodeSet& nodes) {
    std::vector<Vec3> at;
    for (const NodeIndex node : nodes) at.push_back(of.position(node));
    return at;
  }
  std::vector<Touch> by(const Vec3& way) {
    std::vector<Vec3> at = start;
    for (Vec3& each : at) each += way;
    return moved.at(at);
  }
};

/// The plate below has 10 x 10 shells of 1, the one above 4 x 4, 0.3 off its nodes.
Model plates(double height) {
  SheetsThatMeet sheets;
  return sheets.add_plate(1).add(2, 4, 4, [=](int i, int j) { return Vec3(i - 1.7, j - 1.7, height); }).model();
}
bool above(const Vec3& at) { return at.z() > 0.1; }

TEST(MovedShells, touch_what_they_come_too_close_to) {
  TestDrag drag(plates(5), 1, above);
  EXPECT_TRUE(drag.by({0, 0, -3.9}).empty()) << "1.1 apart";
  const std::vector<Touch> touches = drag.by({0, 0, -4.3});
  ASSERT_FALSE(touches.empty());
  double deepest = 0;
  for (const Touch& touch : touches) {
    EXPECT_GE(touch.moved.value, 100u) << "the upper plate moves";
    EXPECT_LT(touch.other.value, 100u);
    EXPECT_FALSE(touch.cross);
    deepest = std::max(deepest, touch.depth);
  }
  EXPECT_NEAR(deepest, 0.3, 1e-12) << "0.7 apart";
  EXPECT_TRUE(drag.by({0, 0, -3.9}).empty()) << "nothing remains of a step before";
  EXPECT_TRUE(drag.by({0, 0, -7}).empty()) << "through it, and away below";
}

TEST(MovedShells, find_what_the_whole_search_finds_in_the_moved_model) {
  TestDrag drag(plates(5), 1, above);
  const Vec3 way(0.2, -0.1, -4.6);
  const std::vector<Touch> touches = drag.by(way);
  Model moved = drag.model;
  for (const NodeIndex node : drag.nodes) moved.positions.set(node.value, moved.position(node) + way);
  const spatial::BoxTree tree(moved);
  std::map<std::pair<ShellIndex, ShellIndex>, double> expected;
  std::set<ShellIndex> expected_shells, shells;
  for (const CloseShells& pair : find_close_shells(moved, tree, given_thickness(moved, 1), 0)) {
    expected.emplace(std::pair(pair.b, pair.a), pair.depth);
    expected_shells.insert(pair.b);
  }
  for (const Touch& touch : touches) {
    shells.insert(touch.moved);
    const auto pair = expected.find({touch.moved, touch.other});
    ASSERT_NE(pair, expected.end());
    EXPECT_EQ(pair->second, touch.depth);
  }
  EXPECT_EQ(shells, expected_shells) << "each that touches is found";
  EXPECT_EQ(shells.size(), 16u);
}

TEST(MovedShells, find_those_whose_nearest_shell_does_not_touch) {
  SheetsThatMeet sheets;
  // The long shell's centre is far away; the small one's is nearer, but it lies beside.
  sheets.add(1, 1, 1, [](int i, int j) { return Vec3(-1 + 40 * i, j, 0); });
  sheets.add(2, 1, 1, [](int i, int j) { return Vec3(1.02 + 0.1 * i, j, 0.8); });
  sheets.add(3, 1, 1, [](int i, int j) { return Vec3(i, j, 5); });
  Model model = sheets.model();
  model.shell_thickness.set(0, 1);
  model.shell_thickness.set(1, 0.05F);
  model.shell_thickness.set(2, 1);
  TestDrag drag(model, 0, [](const Vec3& at) { return at.z() > 1; });
  const std::vector<Touch> touches = drag.by({0, 0, -4.2});
  ASSERT_EQ(touches.size(), 1u);
  EXPECT_EQ(touches[0].other, ShellIndex(0u));
  EXPECT_NEAR(touches[0].depth, 0.2, 1e-12);
}

TEST(MovedShells, cross_what_they_pass_through_without_any_thickness) {
  SheetsThatMeet sheets;
  sheets.add_plate(1).add(2, 2, 2, [](int i, int j) { return Vec3(i - 0.7, 0.3, 1 + j); });
  TestDrag drag(sheets.model(), 0, above);
  EXPECT_TRUE(drag.by({0, 0, -0.9}).empty());
  const std::vector<Touch> touches = drag.by({0, 0, -1.5});
  ASSERT_FALSE(touches.empty());
  std::set<std::pair<ShellIndex, ShellIndex>> expected, found;
  Model moved = drag.model;
  for (const NodeIndex node : drag.nodes) moved.positions.set(node.value, moved.position(node) + Vec3(0, 0, -1.5));
  for (const ShellCrossing& crossing : find_shell_crossings(moved, spatial::BoxTree(moved))) expected.emplace(crossing.b, crossing.a);
  for (const Touch& touch : touches) {
    found.emplace(touch.moved, touch.other);
    EXPECT_TRUE(touch.cross);
  }
  EXPECT_EQ(found, expected);
}

TEST(MovedShells, say_nothing_of_what_touched_before) {
  TestDrag drag(plates(0.6), 1, above);
  EXPECT_TRUE(drag.by({0, 0, 0}).empty());
  EXPECT_TRUE(drag.by({0, 0, -0.2}).empty()) << "deeper, but with the same shells";
  const std::vector<Touch> touches = drag.by({2, 0, 0});
  ASSERT_FALSE(touches.empty()) << "along the plate come new ones";
  EXPECT_FALSE(touches.front().cross);
}

TEST(MovedShells, leave_out_neighbours_in_their_sheet_and_each_other) {
  SheetsThatMeet sheets;
  sheets.add_plate(1);
  TestDrag bulge(sheets.model(), 0.9, [](const Vec3& at) { return at.norm() < 2.5; });
  EXPECT_TRUE(bulge.by({0, 0, 0.4}).empty());
  TestDrag both(plates(0.6), 1, [](const Vec3&) { return true; });
  EXPECT_TRUE(both.by({1, 0, 0}).empty());
}

TEST(MovedShells, take_no_thickness_and_no_number_as_no_touch) {
  TestDrag thin(plates(5), 0, above);
  EXPECT_TRUE(thin.by({0, 0, -4.9}).empty()) << "no thickness: only crossing counts";
  TestDrag drag(plates(5), 1, above);
  EXPECT_TRUE(drag.by({0, 0, std::numeric_limits<double>::quiet_NaN()}).empty());
  EXPECT_TRUE(drag.by({0, 0, std::numeric_limits<double>::infinity()}).empty());
  EXPECT_FALSE(drag.by({0, 0, -4.5}).empty());
}

TEST(MovedShells, are_the_same_on_one_core) {
  const auto numbers = [] {
    TestDrag drag(plates(5), 1, above);
    std::vector<std::tuple<std::uint32_t, std::uint32_t, double>> all;
    for (const Touch& touch : drag.by({0.1, 0.2, -4.4})) all.emplace_back(touch.moved.value, touch.other.value, touch.depth);
    return all;
  };
  const auto several = numbers();
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(numbers(), several);
}

TEST(TouchSummary, names_the_parts_of_the_worst_pair) {
  SheetsThatMeet sheets;
  sheets.add_plate(7).add_plate(9).add_plate(3);
  const Model model = sheets.model();
  const auto part = [&](std::size_t shell) { return model.shell_parts[shell]; };
  std::vector<Touch> touches{{ShellIndex(0u), ShellIndex(100u), false, 0.2}, {ShellIndex(1u), ShellIndex(200u), false, 0.5}};
  TouchSummary summary = summary_of(model, touches);
  EXPECT_EQ(summary.parts, 3u);
  EXPECT_EQ(summary.part_a, part(0));
  EXPECT_EQ(summary.part_b, part(200));
  EXPECT_EQ(summary.depth, 0.5);
  EXPECT_FALSE(summary.cross);
  touches.push_back({ShellIndex(2u), ShellIndex(101u), true, 0});
  summary = summary_of(model, touches);
  EXPECT_TRUE(summary.cross) << "a crossing is worse than any depth";
  EXPECT_EQ(summary.part_b, part(100));
}

}  // namespace
}  // namespace prismesh::mesh::contact
