#include "kiosk/calibration/wizard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace prismesh::kiosk::calibration {
namespace {

using drivers::display::MaskOptics;
using drivers::display::Profile;
using testing::Contains;
using testing::HasSubstr;

constexpr display::PixelSize kPanel{1280, 1024};

display::Monitor monitor_on_the_desk() {
  display::Monitor monitor;
  monitor.connector = "DP-1";
  monitor.shown = monitor.mode = monitor.native = kPanel;
  monitor.colour = display::LinkColour::full;
  monitor.edid.emplace();
  monitor.edid->identity = {"SHA", "LL-T1820", "0042"};
  monitor.edid->native_width = kPanel.width;
  monitor.edid->width_mm = 359;
  monitor.edid->height_mm = 287;
  return monitor;
}

Profile built_in(const char* name) { return *drivers::display::find_profile(name); }

/// The display's true optics, which the wizard must find.
MaskOptics hidden(const MaskOptics& known) {
  MaskOptics real = known;
  real.zero_mm = -0.171;
  real.gap_scale = 0.972;
  real.pitch_scale = 1.0006;
  return real;
}

void go_to(Wizard& wizard, Step step) {
  for (int i = 0; i < 20 && wizard.step() != step; ++i) ASSERT_TRUE(wizard.next({}));
  ASSERT_EQ(wizard.step(), step);
}

/// Height (in periods of the ramp) at which the left eye sees the band at a point of the panel, for true optics and those that are shown.
double band_height(const MaskOptics& real, const MaskOptics& shown, double u_mm) {
  const Eigen::Vector3d eye(-31.5, 0, 650);
  return window_number(real, eye, 0, u_mm, 0) - window_number(shown, eye, 0, u_mm, 0);
}

/// A viewer who adjusts until the band is level.
void level_the_band(Wizard& wizard) {
  const auto slope = [&] {
    const MaskOptics shown = wizard.page({}).profile.optics;
    MaskOptics real = hidden(built_in("prism-mask").optics);
    real.pixel_pitch_mm = shown.pixel_pitch_mm;
    real.panel_columns = shown.panel_columns;
    MaskOptics upright = shown;
    upright.lean = 0;
    return band_height(real, upright, 170) - band_height(real, upright, -170);
  };
  const double first = slope();
  wizard.adjust(1, false);
  const int direction = std::abs(slope()) < std::abs(first) ? 1 : -1;
  for (int i = 0; i < 2000; ++i) {
    const double before = std::abs(slope());
    wizard.adjust(direction, false);
    if (std::abs(slope()) > before) return wizard.adjust(-direction, false);
  }
}

/// A viewer who sits on the given seat and moves the mask to its true position.
void choose_places(Wizard& wizard, bool tracked, int places = 5) {
  for (int place = 0; place < places; ++place) {
    ASSERT_EQ(wizard.step(), Step::places);
    const double aside[] = {0, -90, 90, 0, 0}, back[] = {0, 0, 0, -100, 110};
    Now now;
    now.eyes_seen = tracked;
    now.between_eyes_mm = {aside[place] + (tracked ? 7 : 0), 0, 650 + back[place] - (tracked ? 12 : 0)};
    MaskOptics real = hidden(wizard.result().optics);
    real.pitch_scale = wizard.result().optics.pitch_scale;
    const double wanted = std::remainder(mask_position_mm(real, now.between_eyes_mm), real.mask_pitch_mm());
    for (int i = 0; i < 400; ++i) {
      const double at = *wizard.page(now).hold_mask_mm;
      if (std::abs(at - wanted) < 0.6 * real.mask_pitch_mm() / 96) break;
      wizard.adjust(at < wanted ? 1 : -1, false);
    }
    now.mask_mm = wizard.page(now).hold_mask_mm;
    const Result<void> chosen = wizard.next(now);
    ASSERT_TRUE(chosen) << chosen.error().text();
  }
}

TEST(CalibrationWizard, makes_a_profile_of_this_monitor_for_a_new_display) {
  Wizard wizard(built_in("prism-mask"), {monitor_on_the_desk(), kPanel, true});
  go_to(wizard, Step::size);
  for (int i = 0; i < 30; ++i) wizard.adjust(1, false);  // 3 mm more than the monitor reports
  const double pitch = wizard.result().optics.pixel_pitch_mm;
  EXPECT_NEAR(pitch, 359.0 / 1280 + 3.0 / 1100, 1e-9);
  go_to(wizard, Step::eye_separation);
  wizard.adjust(-2, false);
  go_to(wizard, Step::pitch);
  level_the_band(wizard);
  go_to(wizard, Step::places);
  choose_places(wizard, true);
  ASSERT_EQ(wizard.step(), Step::crosstalk_left);
  wizard.adjust(4, false);
  ASSERT_TRUE(wizard.next({}));
  wizard.adjust(1, true);
  ASSERT_TRUE(wizard.next({}));
  ASSERT_EQ(wizard.step(), Step::check);
  EXPECT_FALSE(wizard.finished());
  ASSERT_TRUE(wizard.next({}));
  EXPECT_TRUE(wizard.finished());

  const Profile profile = wizard.result();
  EXPECT_EQ(profile.monitor.name, "SHA LL-T1820");
  EXPECT_EQ(profile.monitor.serial, "0042");
  EXPECT_EQ(profile.monitor.pixels, (std::array{1280, 1024}));
  EXPECT_EQ(profile.eye_separation_mm, 62);
  EXPECT_DOUBLE_EQ(profile.crosstalk[0], 0.01);
  EXPECT_DOUBLE_EQ(profile.crosstalk[1], 0.02);
  // The fine step allows an accuracy of a hundredth of a pixel, as travel of the mask.
  EXPECT_NEAR(profile.optics.zero_mm, -0.171, 0.004);
  EXPECT_NEAR(profile.optics.gap_scale, 0.972, 0.01);
  EXPECT_NEAR(profile.optics.pitch_scale, 1.0006, 4e-5);
}

TEST(CalibrationWizard, works_without_a_tracker) {
  Wizard wizard(built_in("prism-mask"), {monitor_on_the_desk(), kPanel, true});
  go_to(wizard, Step::places);
  EXPECT_THAT(wizard.page({}).remarks, Contains(HasSubstr("doesn't see your eyes")));
  choose_places(wizard, false);
  EXPECT_NEAR(wizard.result().optics.zero_mm, -0.171, 0.004);
}

TEST(CalibrationWizard, refuses_a_choice_from_a_wrong_seat) {
  Wizard wizard(built_in("prism-mask"), {monitor_on_the_desk(), kPanel, true});
  go_to(wizard, Step::places);
  Now now;
  now.eyes_seen = true;
  now.between_eyes_mm = {120, 0, 540};
  const Result<void> chosen = wizard.next(now);
  ASSERT_FALSE(chosen);
  EXPECT_EQ(chosen.error().message, "not chosen yet: go there first");
  EXPECT_THAT(wizard.page(now).remarks, Contains("move 120 mm to the left and 110 mm back"));
  EXPECT_TRUE(wizard.choices().empty());
}

TEST(CalibrationWizard, refuses_a_choice_that_contradicts_the_others) {
  Wizard wizard(built_in("prism-mask"), {monitor_on_the_desk(), kPanel, true});
  go_to(wizard, Step::places);
  choose_places(wizard, false, 4);
  wizard.adjust(48, false);  // half a pitch: the position for the other eye's picture
  const Result<void> chosen = wizard.next({});
  ASSERT_FALSE(chosen);
  EXPECT_THAT(chosen.error().message, HasSubstr("contradict"));
  EXPECT_EQ(wizard.step(), Step::places);
  EXPECT_EQ(wizard.choices().size(), 4u);
}

TEST(CalibrationWizard, shifts_the_picture_if_the_mask_is_fixed) {
  Wizard wizard(built_in("lenticular"), {monitor_on_the_desk(), kPanel, false});
  go_to(wizard, Step::places);
  EXPECT_FALSE(wizard.page({}).hold_mask_mm);
  EXPECT_EQ(wizard.page({}).weave_mask_mm, 0);
  wizard.adjust(10, false);
  const double shown = wizard.page({}).profile.optics.zero_mm;
  EXPECT_NE(shown, 0);
  ASSERT_TRUE(wizard.next({}));
  EXPECT_EQ(wizard.step(), Step::crosstalk_left);
  EXPECT_NEAR(wizard.result().optics.zero_mm, shown, 1e-9);
}

TEST(CalibrationWizard, leaves_out_steps_for_what_a_display_does_not_have) {
  const auto steps = [](const char* name) {
    Wizard wizard(built_in(name), {std::nullopt, kPanel, false});
    std::vector<Step> seen;
    while (!wizard.finished() && seen.size() < 20) {
      seen.push_back(wizard.step());
      EXPECT_TRUE(wizard.next({})) << name;
    }
    return seen;
  };
  EXPECT_EQ(steps("row-interlaced"),
            (std::vector{Step::link, Step::size, Step::eye_separation, Step::crosstalk_left, Step::crosstalk_right, Step::check}));
  EXPECT_EQ(steps("anaglyph"), (std::vector{Step::link, Step::size, Step::eye_separation, Step::check}));
  EXPECT_EQ(steps("mono"), (std::vector{Step::link, Step::size, Step::check}));
}

TEST(CalibrationWizard, goes_back_by_a_position_or_a_step) {
  Wizard wizard(built_in("prism-mask"), {monitor_on_the_desk(), kPanel, true});
  wizard.back();
  EXPECT_EQ(wizard.step(), Step::link);
  go_to(wizard, Step::places);
  ASSERT_TRUE(wizard.next({}));
  EXPECT_EQ(wizard.choices().size(), 1u);
  wizard.back();
  EXPECT_TRUE(wizard.choices().empty());
  wizard.back();
  EXPECT_EQ(wizard.step(), Step::pitch);
}

TEST(CalibrationWizard, keeps_values_within_their_limits) {
  Wizard wizard(built_in("prism-mask"), {monitor_on_the_desk(), kPanel, true});
  go_to(wizard, Step::eye_separation);
  wizard.adjust(10000, true);
  EXPECT_EQ(wizard.result().eye_separation_mm, 75);
  wizard.adjust(-10000, true);
  EXPECT_EQ(wizard.result().eye_separation_mm, 50);
  go_to(wizard, Step::places);
  const double pitch = wizard.result().optics.mask_pitch_mm();
  wizard.adjust(96 + 24, false);
  EXPECT_NEAR(*wizard.page({}).hold_mask_mm, 0.25 * pitch, 1e-9) << "a whole pitch farther is the same position";
  wizard.adjust(10000, true);
  EXPECT_LE(std::abs(*wizard.page({}).hold_mask_mm), 0.75 * pitch);
}

TEST(CalibrationWizard, reports_faults_of_the_link_on_its_first_page) {
  display::Monitor monitor = monitor_on_the_desk();
  monitor.colour = display::LinkColour::halved;
  Wizard wizard(built_in("prism-mask"), {monitor, kPanel, true});
  EXPECT_THAT(wizard.page({}).remarks, Contains(HasSubstr("4:2:2")));
}

}  // namespace
}  // namespace prismesh::kiosk::calibration
