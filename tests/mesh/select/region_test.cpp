#include "mesh/select/region.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/make_model.h"

namespace prismesh::mesh::select {
namespace {

using test::grid_node;
using test::make_grid;

Model flat_grid(int columns, int rows) {
  return make_grid(columns, rows, [](int i, int j) { return Vec3(i, j, 0); });
}

TEST(Region, stops_at_creases_sharper_than_the_angle) {
  // a plate folded by 40 degrees at x = 3 and by 20 at x = 6
  const double fold = 40 * 3.14159265358979 / 180;
  const Model model = make_grid(9, 2, [&](int i, int j) {
    const double a = std::min(i, 3);
    const double b = std::clamp(i - 3, 0, 3);
    const double c = std::max(i - 6, 0);
    return Vec3(a + b * std::cos(fold) + c * std::cos(1.5 * fold), j, b * std::sin(fold) + c * std::sin(1.5 * fold));
  });
  EXPECT_EQ(region(model, grid_node(9, 1, 1), 30).size(), 6u);
  EXPECT_EQ(region(model, grid_node(9, 4, 1), 30).size(), 12u);
  EXPECT_EQ(region(model, grid_node(9, 4, 1), 10).size(), 6u);
  EXPECT_EQ(region(model, grid_node(9, 4, 1), 45).size(), 18u);
  // on the crease: both sides
  EXPECT_EQ(region(model, grid_node(9, 3, 1), 30).size(), 18u);
}

TEST(Region, stops_at_junctions_and_needs_shells) {
  // a web stands on a flat sheet along node 2-3: three shells at that edge
  const Model model = test::make_model({{1, {0, 0, 0}},
                                        {2, {1, 0, 0}},
                                        {3, {1, 1, 0}},
                                        {4, {0, 1, 0}},
                                        {5, {2, 0, 0}},
                                        {6, {2, 1, 0}},
                                        {7, {1, 0, 1}},
                                        {8, {1, 1, 1}},
                                        {9, {7, 7, 7}}},
                                       {{1, 1, {1, 2, 3, 4}}, {2, 1, {2, 5, 6, 3}}, {3, 1, {2, 7, 8, 3}}});
  EXPECT_EQ(region(model, NodeIndex(0), 30), ShellSet{ShellIndex(0)});
  EXPECT_TRUE(region(model, NodeIndex(8), 30).empty());
  EXPECT_TRUE(region(model, NodeIndex(), 30).empty());
}

TEST(NearestNode, finds_it_and_prefers_the_first_of_equals) {
  const Model model = flat_grid(100, 90);
  EXPECT_EQ(nearest_node(model, Vec3(41.2, 17.4, 3)), grid_node(100, 41, 17));
  EXPECT_EQ(nearest_node(model, Vec3(0.5, 0, 0)), grid_node(100, 0, 0));
  EXPECT_EQ(nearest_node(model, Vec3(-1e9, 0, 0)), grid_node(100, 0, 0));
  EXPECT_FALSE(nearest_node(test::make_model({}, {}), Vec3(0, 0, 0)).valid());
}

TEST(Rings, grow_and_shrink_undo_each_other_inside_a_sheet) {
  const Model model = flat_grid(30, 30);
  const NodeSet one{grid_node(30, 15, 15)};
  const NodeSet grown = grow(model, one, 3);
  EXPECT_EQ(grown.size(), 49u);
  EXPECT_TRUE(std::is_sorted(grown.begin(), grown.end()));
  EXPECT_EQ(shrink(model, grown, 3), one);
  EXPECT_EQ(grow(model, grow(model, one, 1), 2), grown);
  EXPECT_TRUE(shrink(model, grown, 4).empty());
  EXPECT_EQ(grow(model, one, 0), one);
}

TEST(Rings, end_at_the_sheets_own_boundary) {
  const Model model = flat_grid(6, 6);
  EXPECT_EQ(grow(model, {grid_node(6, 0, 0)}, 100).size(), 49u);
  NodeSet left;
  for (int j = 0; j <= 6; ++j)
    for (int i = 0; i <= 3; ++i) left.push_back(grid_node(6, i, j));
  EXPECT_EQ(shrink(model, left, 1).size(), 21u);
  EXPECT_EQ(shrink(model, grow(model, left, 3), 5).size(), 49u) << "all is selected: there is no rim";
}

TEST(Invert, swaps_selected_and_unselected) {
  const Model model = flat_grid(6, 6);
  const NodeSet some{NodeIndex(0), NodeIndex(5), NodeIndex(48)};
  const NodeSet rest = invert(model, some);
  EXPECT_EQ(rest.size(), 46u);
  EXPECT_EQ(invert(model, rest), some);
  EXPECT_EQ(invert(model, {}).size(), 49u);
}

}  // namespace
}  // namespace prismesh::mesh::select
