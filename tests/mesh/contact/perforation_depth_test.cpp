#include "mesh/contact/perforation_depth.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tests/mesh/contact/sheets_that_meet.h"

namespace prismesh::mesh::contact {
namespace {

using test::SheetsThatMeet;

constexpr double kTurn = 3.14159265358979323846 / 180;

std::vector<PerforationDepth> depths_of(const Model& model, double thickness_share = 0) {
  return perforation_depths(model, spatial::BoxTree(model), test::perforations_of(model), thickness_share);
}
PerforationDepth depth_of(const SheetsThatMeet& sheets) {
  const auto depths = depths_of(sheets.model());
  EXPECT_EQ(depths.size(), 1u);
  return depths.empty() ? PerforationDepth{} : depths.front();
}

/// A sheet that stands across the plate, with its lowest row below.
SheetsThatMeet standing(double below) {
  SheetsThatMeet sheets;
  return sheets.add_plate(1).add(2, 6, 3, [=](int i, int j) { return Vec3(i - 3.2, 0.3, j - below); });
}

TEST(PerforationDepth, of_a_sheet_that_stands_in_another) {
  for (const double below : {0x1p-30, 0.25, 0.9, 1.4}) {
    const SheetsThatMeet sheets = standing(below);
    const PerforationDepth depth = depth_of(sheets);
    EXPECT_FALSE(depth.a_enters) << "the plate isn't cut";
    ASSERT_TRUE(depth.max);
    EXPECT_NEAR(*depth.max, below, 1e-12);
    EXPECT_NEAR(depth.mean, below > 1 ? below - 0.5 : below, 1e-12) << "of one row or two";
    EXPECT_EQ(depth.entering.size(), below > 1 ? 14u : 7u);
    EXPECT_EQ(sheets.model().position(depth.deepest).z(), -below);
  }
}

TEST(PerforationDepth, of_the_smaller_piece) {
  const PerforationDepth depth = depth_of(standing(2.75));
  ASSERT_TRUE(depth.max);
  EXPECT_NEAR(*depth.max, 0.25, 1e-12) << "the upper row";
}

TEST(PerforationDepth, of_inclined_plates) {
  for (const double degrees : {10.0, 45.0, 80.0}) {
    SheetsThatMeet sheets;
    sheets.add_plate(1).add(2, 6, 4, [=](int i, int j) {
      const double along = j - 0.6;
      return Vec3(i - 3.1, along * std::cos(degrees * kTurn), along * std::sin(degrees * kTurn));
    });
    const PerforationDepth depth = depth_of(sheets);
    ASSERT_TRUE(depth.max);
    EXPECT_NEAR(*depth.max, 0.6 * std::sin(degrees * kTurn), 1e-12);
  }
}

TEST(PerforationDepth, isnt_known_half_through) {
  SheetsThatMeet slotted;  // each ends inside the other
  slotted.add_plate(1).add(2, 6, 4, [](int i, int j) { return Vec3(i + 1.3, 0.3, j - 1.6); });
  const PerforationDepth depth = depth_of(slotted);
  EXPECT_FALSE(depth.max);
  EXPECT_TRUE(depth.entering.empty());
  EXPECT_FALSE(depth.deepest.valid());
}

TEST(PerforationDepth, leaves_out_nodes_on_the_other_sheet) {
  const PerforationDepth depth = depth_of(standing(1));
  ASSERT_TRUE(depth.max);
  EXPECT_EQ(*depth.max, 1);
  EXPECT_EQ(depth.entering.size(), 7u) << "the row on the plate belongs to no piece";
}

TEST(PerforationDepth, adds_thicknesses) {
  Model model = standing(0.25).model();
  for (std::size_t s = 0; s < model.shell_count(); ++s) model.shell_thickness.set(s, s < 100 ? 2 : 1);
  EXPECT_NEAR(depths_of(model, 0.5).front().max.value_or(0), 0.25 + 1.5, 1e-12);
  EXPECT_NEAR(depths_of(model, 0).front().max.value_or(0), 0.25, 1e-12);
}

TEST(PerforationDepth, of_a_ball_through_a_plate) {
  constexpr int kAround = 40, kUp = 20;
  SheetsThatMeet sheets;
  sheets.add_plate(1).add(2, kAround, kUp, [](int i, int j) {
    const double turn = 360.0 * i / kAround * kTurn, up = (-84 + 168.0 * j / kUp) * kTurn;
    return Vec3(3 * std::cos(up) * std::cos(turn), 3 * std::cos(up) * std::sin(turn), 2.2 + 3 * std::sin(up));
  });
  const PerforationDepth depth = depth_of(sheets);
  ASSERT_TRUE(depth.max);
  EXPECT_NEAR(*depth.max, 0.8, 0.05);
}

TEST(PerforationDepth, of_a_piece_that_is_nearest_to_shells_away_from_the_curve) {
  SheetsThatMeet sheets;  // a floor with a wall below its end, and a sheet that comes down through the floor and ends near the wall
  sheets.add(1, 10, 10, [](int i, int j) { return j <= 5 ? Vec3(i - 5, j - 5, 0) : Vec3(i - 5, 0, 5 - j); });
  sheets.add(2, 4, 12, [](int i, int j) { return Vec3(i - 2.2, 0.8 * (j - 8) - 3.5, 0.4 - 0.6 * (j - 8)); });
  const PerforationDepth depth = depth_of(sheets);
  ASSERT_TRUE(depth.max);
  EXPECT_EQ(depth.entering.size(), 20u);
  EXPECT_NEAR(*depth.max, 1.1, 1e-12) << "the row before the last one, from the wall; the last is 2 below the floor and 0.3 from the wall";
}

TEST(PerforationDepth, of_a_fold) {
  SheetsThatMeet strip;
  strip.add(1, 12, 4, [](int i, int j) {
    if (i <= 5) return Vec3(i, j, 0);
    return i == 6 ? Vec3(6, j, 1) : Vec3(12 - i + 0.5, j, 1.3 - 0.4 * (i - 6));
  });
  const PerforationDepth depth = depth_of(strip);
  ASSERT_TRUE(depth.max);
  EXPECT_GE(*depth.max, 1.1) << "the end's own height";
  EXPECT_EQ(depth.entering.size(), 15u) << "three rows";
}

TEST(PerforationDepth, is_the_same_with_any_number_of_threads) {
  const Model model = standing(1.4).model();
  const auto with_threads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return depths_of(model).front();
  };
  const PerforationDepth one = with_threads(1), four = with_threads(4);
  EXPECT_EQ(one.max, four.max);
  EXPECT_EQ(one.entering, four.entering);
}

}  // namespace
}  // namespace prismesh::mesh::contact
