// What an eye sees through the mask: the known figures of the example display, and properties that hold for any eye.
#include "drivers/display/optics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace prismesh::drivers::display {
namespace {

using Eigen::Vector3d;

constexpr double kPitch = 0.2805, kWidth = 359;

/// Snell's law in two dimensions, forward: from the element to the position on the panel.
double seen_through(const MaskOptics& optics, double eye_x, double distance, double m) {
  const double angle = std::atan2(m - eye_x, distance);
  return m + optics.air_gap_mm() * optics.refractive_index * std::tan(std::asin(std::sin(angle) / optics.refractive_index));
}

TEST(Optics, the_example_display_has_its_known_figures) {
  const MaskOptics optics;
  EXPECT_NEAR(optics.air_gap_mm(), 2.894, 1e-3);
  EXPECT_NEAR(optics.air_gap_mm() * optics.refractive_index, 4.40, 5e-3) << "thickness of the glass";
  EXPECT_NEAR(optics.mask_pitch_mm(), 0.5585, 1e-4);
  EXPECT_NEAR(mask_position_mm(optics, {1, 0, 650}) * 1e3, 4.43, 5e-3) << "micrometres per millimetre of the head";
  EXPECT_NEAR(mask_position_mm(optics, {63, 0, 650}), optics.mask_pitch_mm() / 2, 1e-9) << "an eye separation on, the eyes swap";
}

TEST(Optics, a_windows_number_is_that_of_its_element) {
  MaskOptics optics;
  for (const double eye_x : {0.0, -31.5, 200.0})
    for (const double distance : {400.0, 650.0, 900.0})
      for (const double mask : {0.0, 0.2, -1.3})
        for (const int k : {-300, -17, 0, 1, 290}) {
          const double m = k * optics.mask_pitch_mm() + mask;
          const double u = seen_through(optics, eye_x, distance, m);
          ASSERT_NEAR(window_number(optics, {eye_x, 0, distance}, mask, u, 0), k, 1e-8) << eye_x << " " << distance << " " << mask;
        }
  optics.refractive_index = 1;
  const double m = 55 * optics.mask_pitch_mm();
  EXPECT_NEAR(window_number(optics, {20, 5, 600}, 0, m + (m - 20) * optics.air_gap_mm() / 600, 80), 55, 1e-9);
}

TEST(Optics, at_the_design_position_each_eye_has_its_columns_on_a_panel_of_any_width) {
  for (int columns = 1; columns < 2000; columns += columns < 40 ? 1 : 61) {
    MaskOptics optics;
    optics.refractive_index = 1;
    optics.panel_columns = columns;
    const EyePair eyes = eyes_from({0, 0, 650}, 63);
    for (int c = 0; c < columns; ++c) {
      const double u = (c + 0.5 - 0.5 * columns) * optics.pixel_pitch_mm;
      const double own = window_number(optics, c % 2 == 0 ? eyes.left : eyes.right, 0, u, 0);
      ASSERT_NEAR(own, std::round(own), 1e-6) << columns << " columns, column " << c;
    }
    EXPECT_LE(std::abs(optics.reference_mm()), 1.0001 * optics.pixel_pitch_mm);
  }
}

/// Max. distance, in pixels, between an observer's windows and their own pixels on the example's panel, with the mask at its linear
/// position.
double worst_with_shift_alone(double x, double distance) {
  const MaskOptics optics;
  const Vector3d head(x, 0, distance);
  double worst = 0;
  for (int i = 0; i <= 400; ++i) {
    const double u = kWidth * (i / 400.0 - 0.5);
    const double pixel = 2 * kPitch * std::round(u / (2 * kPitch));
    const double number = window_number(optics, head, mask_position_mm(optics, head), pixel, 0);
    worst = std::max(worst, std::abs(number - pixel / (2 * kPitch)) * 2);
  }
  return worst;
}

TEST(Optics, the_linear_law_has_its_known_error) {
  EXPECT_LT(worst_with_shift_alone(0, 650), 0.08);
  EXPECT_NEAR(worst_with_shift_alone(63, 650), 0.14, 0.01);
  EXPECT_NEAR(worst_with_shift_alone(126, 650), 0.27, 0.01);
  EXPECT_NEAR(worst_with_shift_alone(0, 582), 0.25, 0.01) << "the nearest at which a shift alone serves the whole panel";
  EXPECT_NEAR(worst_with_shift_alone(0, 699), 0.25, 0.01) << "and the farthest";
}

TEST(Optics, the_mask_keeps_the_windows_in_the_middle_when_the_head_moves) {
  for (const double lean : {0.0, 0.3333, -0.18})
    for (const Vector3d& head : {Vector3d(0, 0, 650), Vector3d(240, -130, 480), Vector3d(-90, 60, 1200)}) {
      MaskOptics optics;
      optics.lean = lean;
      optics.zero_mm = 0.123;
      optics.refractive_index = 1;
      EXPECT_NEAR(window_number(optics, head, mask_position_mm(optics, head), 0, 0), 0, 1e-9);
    }
}

TEST(Optics, a_leaning_mask_shifts_the_pattern_with_height) {
  MaskOptics optics;
  optics.lean = 1.0 / 3;
  optics.refractive_index = 1;  // the relation is exact without refraction
  const Vector3d eye(-40, 30, 700);
  for (const double v : {-120.0, 0.0, 77.0})
    EXPECT_NEAR(window_number(optics, eye, 0.1, 20 + optics.lean * v, v), window_number(optics, eye, 0.1, 20, 0), 1e-9);
}

TEST(Optics, skew_rays_obey_snells_law) {
  const MaskOptics optics;
  const Vector3d eye(50, 80, 500);
  const double m = 31 * optics.mask_pitch_mm(), w = -90;
  // In the plane of incidence, from the mask into the glass.
  const Eigen::Vector2d aside(m - eye.x(), w - eye.y());
  const double in_air = std::atan2(aside.norm(), eye.z()), in_glass = std::asin(std::sin(in_air) / optics.refractive_index);
  const Eigen::Vector2d on_panel =
      Eigen::Vector2d(m, w) + aside.normalized() * (optics.air_gap_mm() * optics.refractive_index * std::tan(in_glass));
  EXPECT_NEAR(window_number(optics, eye, 0, on_panel.x(), on_panel.y()), 31, 1e-8);
}

TEST(Optics, evenly_spaced_windows_are_near_the_exact_ones) {
  MaskOptics optics;
  for (const Vector3d& eye : {Vector3d(-31.5, 0, 650), Vector3d(150, 40, 500), Vector3d(-200, 0, 900)}) {
    const WindowRow row = window_row(optics, eye, 0.2, kWidth);
    double worst = 0;
    for (double u = -kWidth / 2; u <= kWidth / 2; u += 3.1)
      worst = std::max(worst, std::abs(row.first_mm + row.spacing_mm * window_number(optics, eye, 0.2, u, 0) - u));
    EXPECT_LT(worst, 0.25 * kPitch);
    EXPECT_NEAR(row.spacing_mm, optics.mask_pitch_mm() * (1 + optics.air_gap_mm() / eye.z()), 0.002 * row.spacing_mm);
  }
  optics.refractive_index = 1;
  const WindowRow exact = window_row(optics, {10, 0, 650}, 0, kWidth);
  EXPECT_NEAR(exact.spacing_mm, 2 * kPitch, 1e-12) << "two pixels at the design distance";
}

TEST(Optics, calibrated_scales_are_independent) {
  MaskOptics optics;
  const double pitch = optics.mask_pitch_mm(), gap = optics.air_gap_mm();
  optics.gap_scale = 1.1;
  EXPECT_DOUBLE_EQ(optics.mask_pitch_mm(), pitch);
  optics.pitch_scale = 1.01;
  EXPECT_DOUBLE_EQ(optics.mask_pitch_mm(), 1.01 * pitch);
  EXPECT_DOUBLE_EQ(optics.air_gap_mm(), 1.1 * gap);
}

TEST(Optics, any_finite_eye_gives_finite_numbers) {
  const MaskOptics optics;
  const double extreme[] = {0, -1e308, 1e308, 1e-308, -5, 650, std::numeric_limits<double>::denorm_min()};
  for (const double x : extreme)
    for (const double y : extreme)
      for (const double z : extreme) {
        const Vector3d eye(x, y, z);
        ASSERT_TRUE(std::isfinite(mask_position_mm(optics, eye)));
        ASSERT_TRUE(std::isfinite(window_number(optics, eye, 0, 100, -100)));
        ASSERT_TRUE(std::isfinite(window_number(optics, eye, 0, x, y)));
        const WindowRow row = window_row(optics, eye, 0, kWidth);
        ASSERT_TRUE(std::isfinite(row.first_mm) && std::isfinite(row.spacing_mm));
      }
}

}  // namespace
}  // namespace prismesh::drivers::display
