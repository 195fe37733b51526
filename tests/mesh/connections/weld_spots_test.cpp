#include "mesh/connections/weld_spots.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/connections/read_points.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::connections {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<double> along_x(double length, const SpotSpacing& spacing) {
  const std::vector<Vec3> line{{0, 0, 0}, {length / 3, 0, 0}, {length, 0, 0}};
  std::vector<double> at;
  for (const Vec3& spot : spots_along(line, false, spacing)) at.push_back(spot.x());
  return at;
}

TEST(WeldSpots, begin_and_end_at_the_end_distance_evenly_spaced) {
  EXPECT_THAT(along_x(100, {20, 10}), ElementsAre(10, 30, 50, 70, 90));
  // 80 between the ends: three steps of 26.7, since four would be farther from the pitch
  const std::vector<double> uneven = along_x(100, {30, 10});
  ASSERT_EQ(uneven.size(), 4u);
  EXPECT_DOUBLE_EQ(uneven[1] - uneven[0], 80.0 / 3);
  EXPECT_DOUBLE_EQ(uneven.back(), 90);
  EXPECT_THAT(along_x(100, {100, 50}), ElementsAre(50));
  EXPECT_THAT(along_x(100, {90, 45}), ElementsAre(50));
  EXPECT_THAT(along_x(100, {50, 0}), ElementsAre(0, 50, 100));
}

TEST(WeldSpots, go_around_a_closed_line) {
  const std::vector<Vec3> square{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}, {0, 0, 0}};
  const std::vector<Vec3> spots = spots_along(square, true, {10, 5});
  ASSERT_EQ(spots.size(), 4u);
  EXPECT_EQ(spots[2], Vec3(10, 10, 0));
}

TEST(WeldSpots, follow_corners_of_the_line) {
  const std::vector<Vec3> corner{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}};
  const std::vector<Vec3> spots = spots_along(corner, false, {5, 2.5});
  ASSERT_EQ(spots.size(), 4u);
  EXPECT_EQ(spots[3], Vec3(10, 7.5, 0));
}

TEST(WeldSpots, distance_from_a_line_is_to_its_segments) {
  const std::vector<Vec3> line{{0, 0, 0}, {10, 0, 0}};
  EXPECT_DOUBLE_EQ(distance_to(line, {5, 3, 0}), 3);
  EXPECT_DOUBLE_EQ(distance_to(line, {13, 4, 0}), 5);
}

/// Sheets of 4 x 4 quads of 5 at heights, parts 1 and on, each 1 thick.
Model sheets_at(const std::vector<double>& heights, double tilt_degrees = 0) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  const double slope = std::tan(tilt_degrees * std::numbers::pi / 180);
  for (std::size_t part = 0; part < heights.size(); ++part)
    for (int j = 0; j <= 4; ++j)
      for (int i = 0; i <= 4; ++i) {
        const auto corner = static_cast<std::int64_t>(1000 * part + 1 + static_cast<std::size_t>(i + 5 * j));
        nodes.push_back({corner, Vec3(5.0 * i, 5.0 * j, heights[part] + (part == 0 ? 0 : slope * (5.0 * i - 10)))});
        if (i < 4 && j < 4) shells.push_back({corner, static_cast<std::int64_t>(part + 1), {corner, corner + 1, corner + 6, corner + 5}});
      }
  Model model = test::make_model(nodes, shells);
  auto parts = std::make_shared<std::vector<Part>>(*model.parts);
  for (Part& part : *parts) part.thickness = 1;
  model.parts = std::move(parts);
  return model;
}

std::vector<double> heights_at(const Model& model, const Vec3& place, double gap = 0) {
  std::vector<double> heights;
  for (const SheetAtSpot& sheet : stack_at(model, spatial::BoxTree(model), place, {2, gap}).sheets) heights.push_back(sheet.point.z());
  return heights;
}

TEST(WeldSpots, the_stack_goes_on_as_long_as_sheets_are_near) {
  EXPECT_THAT(heights_at(sheets_at({0, 1, 2}), {10, 10, 1}), ElementsAre(0, 1, 2));
  EXPECT_THAT(heights_at(sheets_at({0, 1, 3.5}), {7, 8, 0.4}), ElementsAre(0, 1));
  EXPECT_THAT(heights_at(sheets_at({0, 1, 3.5}), {7, 8, 0.4}, 0.6), ElementsAre(0, 1, 3.5));
  EXPECT_THAT(heights_at(sheets_at({0, 4}), {10, 10, 0}), ElementsAre(0));
}

TEST(WeldSpots, a_place_on_an_edge_or_a_node_meets_each_sheet_once) {
  const Model model = sheets_at({0, 1});
  EXPECT_THAT(heights_at(model, {10, 7, 0}), ElementsAre(0, 1));
  EXPECT_THAT(heights_at(model, {10, 10, 0}), ElementsAre(0, 1));
  EXPECT_THAT(heights_at(model, {7.5, 7.5, 0}), ElementsAre(0, 1));  // on a quad's diagonal
}

TEST(WeldSpots, sheets_at_an_angle_do_not_count) {
  EXPECT_EQ(heights_at(sheets_at({0, 1}, 10), {10, 10, 0}).size(), 2u);
  EXPECT_EQ(heights_at(sheets_at({0, 1}, 20), {10, 10, 0}).size(), 1u);
}

TEST(WeldSpots, say_how_far_the_nearest_sheet_is) {
  const Model model = sheets_at({0, 1});
  const SpotStack stack = stack_at(model, spatial::BoxTree(model), {10, 10, 30}, {});
  EXPECT_TRUE(stack.sheets.empty());
  ASSERT_TRUE(stack.nearest);
  EXPECT_THAT(*stack.nearest, DoubleNear(29, 1e-9));
}

TEST(PointTable, reads_columns_by_place_or_by_name) {
  EXPECT_THAT(read_points("1,2,3\n\n# note\r\n+4.5;5;6e1\r\n7\t8\t9", "p.csv").value(),
              ElementsAre(Vec3(1, 2, 3), Vec3(4.5, 5, 60), Vec3(7, 8, 9)));
  EXPECT_THAT(read_points("\xef\xbb\xbfid, z, Y, \"x\"\nw1, 3, 2, 1\n", "p.csv").value(), ElementsAre(Vec3(1, 2, 3)));
}

TEST(PointTable, refuses_with_the_line) {
  const auto why = [](const std::string& text) {
    const auto points = read_points(text, "p.csv");
    return points ? std::string("it was read") : points.error().text();
  };
  EXPECT_THAT(why(""), HasSubstr("p.csv: the table has no point"));
  EXPECT_THAT(why("x,y,z\n"), HasSubstr("the table has no point"));
  EXPECT_THAT(why("a,b,c\n1,2,3"), HasSubstr("p.csv:1: the first line must name the columns"));
  EXPECT_THAT(why("1,2,3\n1,2"), HasSubstr("p.csv:2: the column z is missing"));
  EXPECT_THAT(why("1,2,3\n1,two,3"), HasSubstr("p.csv:2: y must be a number, not \"two\""));
  EXPECT_THAT(why("1,2,inf"), HasSubstr("z must be a number"));
  EXPECT_THAT(why("1,2,1e999"), HasSubstr("z must be a number"));
}

}  // namespace
}  // namespace prismesh::mesh::connections
