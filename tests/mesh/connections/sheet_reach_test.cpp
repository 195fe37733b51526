#include "mesh/connections/sheet_reach.h"

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/make_model.h"

namespace prismesh::mesh::connections {
namespace {

/// A rectangle of 4 x 2 and a triangle of sides 3, 4, 5.
Model two_shells(double thickness) {
  Model model =
      test::make_model({{1, {0, 0, 0}}, {2, {4, 0, 0}}, {3, {4, 2, 0}}, {4, {0, 2, 0}}, {5, {0, 0, 9}}, {6, {4, 0, 9}}, {7, {0, 3, 9}}},
                       {{1, 1, {1, 2, 3, 4}}, {2, 1, {5, 6, 7}}});
  std::vector<Part> parts = *model.parts;
  if (thickness > 0) parts[0].thickness = thickness;
  model.parts = std::make_shared<const std::vector<Part>>(std::move(parts));
  return model;
}

TEST(SheetReach, is_a_share_of_the_mean_side_where_shells_are_wide) {
  for (const double thickness : {0.0, 0.5}) {
    const Model model = two_shells(thickness);
    EXPECT_DOUBLE_EQ(sheet_reach(model, ShellIndex(std::size_t{0}), Attachment::placed), 0.75);
    EXPECT_DOUBLE_EQ(sheet_reach(model, ShellIndex(std::size_t{0}), Attachment::tied), 1.5);
    EXPECT_DOUBLE_EQ(sheet_reach(model, ShellIndex(std::size_t{1}), Attachment::placed), 1);
    EXPECT_DOUBLE_EQ(sheet_reach(model, ShellIndex(std::size_t{1}), Attachment::tied), 2);
  }
}

TEST(SheetReach, is_by_thickness_where_shells_are_thick) {
  const Model model = two_shells(2);
  for (const std::size_t shell : {0, 1}) {
    EXPECT_DOUBLE_EQ(sheet_reach(model, ShellIndex(shell), Attachment::placed), 2);
    EXPECT_DOUBLE_EQ(sheet_reach(model, ShellIndex(shell), Attachment::tied), 2 * 1.2);
  }
}

TEST(SheetReach, takes_the_thickness_of_the_shells_own_card_first) {
  Model model = two_shells(2);
  model.shell_thickness.set(0, 3);
  EXPECT_DOUBLE_EQ(sheet_reach(model, ShellIndex(std::size_t{0}), Attachment::placed), 3);
}

TEST(Sides, are_those_of_the_corners) {
  const Model model = two_shells(0);
  EXPECT_DOUBLE_EQ(mean_side(model, ShellIndex(std::size_t{0})), 3);
  EXPECT_DOUBLE_EQ(mean_side(model, ShellIndex(std::size_t{1})), 4);
  EXPECT_DOUBLE_EQ(max_side(model, ShellIndex(std::size_t{0})), 4);
  EXPECT_DOUBLE_EQ(max_side(model, ShellIndex(std::size_t{1})), 5);
}

}  // namespace
}  // namespace prismesh::mesh::connections
