// The head positions from which each eye sees its own light.
#include "drivers/display/working_box.h"

#include <cmath>

#include <gtest/gtest.h>

namespace prismesh::drivers::display {
namespace {

constexpr PanelArea kSmallPanel{0, 0, 1280, 1024, 1280, 1024};

double error_at(const Eigen::Vector3d& head, Composing composing, const PanelArea& panel = kSmallPanel, const MaskOptics& optics = {}) {
  return worst_phase_error({.optics = optics, .panel = panel, .composing = composing}, head);
}

MaskDisplay small_display(Composing composing) { return {.panel = kSmallPanel, .composing = composing}; }

TEST(WorkingBox, at_the_design_position_only_refraction_causes_errors) {
  MaskOptics air;
  air.refractive_index = 1;
  EXPECT_LT(error_at({0, 0, 650}, Composing::fixed_columns, kSmallPanel, air), 1e-3);
  EXPECT_LT(error_at({140, 0, 650}, Composing::fixed_columns, kSmallPanel, air), 1e-3) << "without refraction the law is exact sideways";
  EXPECT_NEAR(error_at({0, 0, 650}, Composing::fixed_columns), 0.13, 0.02);
}

TEST(WorkingBox, a_tiny_panel_shows_only_the_error_of_the_eyes_distance) {
  // The eyes' windows are D0 / D pixels apart, their columns one pixel.
  MaskOptics air;
  air.refractive_index = 1;
  const PanelArea tiny{0, 0, 16, 2, 16, 2};
  for (const double distance : {550.0, 600.0, 720.0})
    EXPECT_NEAR(error_at({0, 0, distance}, Composing::fixed_columns, tiny, air), 0.5 * std::abs(650 / distance - 1), 0.015) << distance;
}

TEST(WorkingBox, moving_the_mask_alone_gives_a_narrow_box) {
  const auto depths = working_depths(small_display(Composing::fixed_columns), 0, 0.25);
  ASSERT_TRUE(depths);
  // One eye straight before the panel has 582 to 699 mm (see optics_test.cpp); two eyes, beside the middle, have a little less.
  EXPECT_NEAR(depths->min_mm, 584, 2);
  EXPECT_NEAR(depths->max_mm, 676, 2);
  EXPECT_FALSE(working_depths(small_display(Composing::fixed_columns), 100, 0.25));
}

TEST(WorkingBox, subpixels_give_a_larger_box) {
  const auto depths = working_depths(small_display(Composing::subpixels), 0, 0.25);
  ASSERT_TRUE(depths);
  EXPECT_LT(depths->min_mm, 556);
  EXPECT_GT(depths->max_mm, 760);
  EXPECT_TRUE(working_depths(small_display(Composing::subpixels), 150, 0.25));
  for (const Eigen::Vector3d& head : {Eigen::Vector3d(300, 0, 650), Eigen::Vector3d(-200, 150, 450), Eigen::Vector3d(100, 0, 1500)})
    EXPECT_LT(error_at(head, Composing::subpixels), 0.5) << "no eye looks at the other's light; head at " << head.transpose();
}

TEST(WorkingBox, whole_pixels_are_too_coarse_to_enlarge_the_box) {
  // Near the panel, each window finds a pixel, max. half a pixel away (plus half the error of the eyes' distance). Far from it there are
  // more windows than pixels: one in a thousand gets none.
  for (const double distance : {450.0, 500.0}) {
    EXPECT_GT(error_at({0, 0, distance}, Composing::fixed_columns), 0.75) << distance;
    EXPECT_LT(error_at({0, 0, distance}, Composing::pixels), 0.53 + 0.5 * (650 / distance - 1)) << distance;
  }
  EXPECT_DOUBLE_EQ(error_at({0, 0, 900}, Composing::pixels), 1);
  EXPECT_LT(error_at({0, 0, 900}, Composing::subpixels), 0.32);
}

}  // namespace
}  // namespace prismesh::drivers::display
