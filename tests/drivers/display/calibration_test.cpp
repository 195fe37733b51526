#include "drivers/display/calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace prismesh::drivers::display {
namespace {

using testing::HasSubstr;

/// A display with unknown zero and gap, as after assembly.
MaskOptics real_display() {
  MaskOptics optics;
  optics.zero_mm = 0.137;
  optics.gap_scale = 1.043;
  return optics;
}

const std::vector<Eigen::Vector3d> kHeads{{0, 0, 650}, {-80, 10, 640}, {90, -20, 660}, {5, 0, 540}, {60, 0, 760}};

/// Choices of a viewer with random errors, each shifted by a number of whole pitches.
std::vector<MaskChoice> choices_on(const MaskOptics& optics, const std::vector<Eigen::Vector3d>& heads, double hand_mm, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> hand(0, hand_mm);
  std::vector<MaskChoice> choices;
  for (const Eigen::Vector3d& head : heads)
    choices.push_back(
        {head, mask_position_mm(optics, head) + hand(random) + (static_cast<int>(random() % 5) - 2) * optics.mask_pitch_mm()});
  return choices;
}

TEST(Calibration, finds_zero_and_gap_of_a_display) {
  const Result<MaskFit> fit = fit_mask(MaskOptics(), choices_on(real_display(), kHeads, 0));
  ASSERT_TRUE(fit) << fit.error().text();
  EXPECT_TRUE(fit->gap_found);
  EXPECT_NEAR(fit->zero_mm, 0.137, 1e-6);
  EXPECT_NEAR(fit->gap_scale, 1.043, 1e-5);
  EXPECT_LT(fit->scatter_px, 1e-5);
}

TEST(Calibration, averages_random_errors) {
  std::vector<Eigen::Vector3d> heads;
  for (int i = 0; i < 5; ++i) heads.insert(heads.end(), kHeads.begin(), kHeads.end());
  double worst_px = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const Result<MaskFit> fit = fit_mask(MaskOptics(), choices_on(real_display(), heads, 0.03, seed));
    ASSERT_TRUE(fit) << fit.error().text();
    MaskOptics found;
    found.zero_mm = fit->zero_mm;
    found.gap_scale = fit->gap_scale;
    for (const Eigen::Vector3d& head : kHeads)
      worst_px =
          std::max(worst_px, std::abs(mask_position_mm(found, head) - mask_position_mm(real_display(), head)) * 2 / found.mask_pitch_mm());
    EXPECT_NEAR(fit->scatter_mm, 0.03, 0.02);
  }
  EXPECT_LT(worst_px, 0.15);  // the random error of one choice is 0.1 px
}

TEST(Calibration, keeps_the_gap_if_the_head_did_not_move) {
  MaskOptics start;
  start.gap_scale = 1.01;
  MaskOptics real = real_display();
  real.gap_scale = start.gap_scale;
  const Result<MaskFit> fit = fit_mask(start, choices_on(real, {{0, 0, 650}, {8, 0, 652}, {-6, 0, 649}}, 0));
  ASSERT_TRUE(fit);
  EXPECT_FALSE(fit->gap_found);
  EXPECT_EQ(fit->gap_scale, 1.01);
  EXPECT_NEAR(fit->zero_mm, 0.137, 1e-9);
}

TEST(Calibration, gives_a_zero_within_half_a_pitch) {
  for (double zero = -2; zero <= 2; zero += 0.05) {
    MaskOptics real;
    real.zero_mm = zero;
    const Result<MaskFit> fit = fit_mask(MaskOptics(), choices_on(real, kHeads, 0));
    ASSERT_TRUE(fit);
    EXPECT_LE(std::abs(fit->zero_mm), 0.5 * real.mask_pitch_mm() + 1e-9);
    EXPECT_NEAR(std::remainder(fit->zero_mm - zero, real.mask_pitch_mm()), 0, 1e-6);
  }
}

TEST(Calibration, names_the_choice_that_contradicts_the_others) {
  std::vector<MaskChoice> choices = choices_on(real_display(), {{0, 0, 650}, {0, 0, 650}, {0, 0, 650}, {0, 0, 650}}, 0);
  choices[2].mask_mm += 0.5 * real_display().mask_pitch_mm();  // chosen with the eyes exchanged
  const Result<MaskFit> fit = fit_mask(MaskOptics(), choices);
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message, HasSubstr("choice 3"));
}

TEST(Calibration, refuses_missing_and_invalid_choices) {
  EXPECT_FALSE(fit_mask(MaskOptics(), {}));
  for (const MaskChoice& bad : {MaskChoice{{0, 0, -5}, 0}, MaskChoice{{0, 0, 650}, std::nan("")},
                                MaskChoice{{std::numeric_limits<double>::infinity(), 0, 650}, 0}}) {
    const std::vector<MaskChoice> choices{{{0, 0, 650}, 0.1}, bad};
    const Result<MaskFit> fit = fit_mask(MaskOptics(), choices);
    ASSERT_FALSE(fit);
    EXPECT_THAT(fit.error().message, HasSubstr("choice 2"));
  }
}

}  // namespace
}  // namespace prismesh::drivers::display
