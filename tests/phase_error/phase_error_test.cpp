// From the head to the light, in virtual time: the distance between the picture's windows and the positions that the eyes see through the
// mask.
#include <cstdio>

#include <gtest/gtest.h>

#include "drivers/eye_tracker/head_motion.h"
#include "tests/phase_error/sweeps.h"

namespace prismesh::phase_error {
namespace {

using drivers::eye_tracker::HeadMotion;
using drivers::eye_tracker::MotionKind;

VirtualStationSettings sweeping(const Sweep& sweep, bool predicts = true, const std::string& profile = "prism-mask") {
  VirtualStationSettings settings;
  settings.head = to_and_fro(sweep);
  settings.predicts = predicts;
  settings.profile = on_panel(profile);
  return settings;
}

void print(const char* what, const Figures& figures) {
  std::printf(
      "%s: windows moved p50 %.3f, p99 %.3f px; at the screen's middle p50 %.3f, p99 %.3f px; over the panel p99 %.3f px; head p99 %.1f "
      "mm\n",
      what, quantile(figures.moved, 0.5), quantile(figures.moved, 0.99), quantile(figures.middle, 0.5), quantile(figures.middle, 0.99),
      quantile(figures.panel, 0.99), quantile(figures.head_mm, 0.99));
}

TEST(PhaseError, stays_within_a_seventh_of_a_pixel_at_250_mm_s) {
  const Figures with = figures_of(sweeping({}), 3), without = figures_of(sweeping({}, false), 1);
  print("250 mm/s, predicted", with);
  print("250 mm/s, as measured", without);
  EXPECT_EQ(with.stereo_share(), 1);
  // The requirement for the effect of the head's motion, and for everything seen at the screen's middle.
  EXPECT_LE(quantile(with.moved, 0.99), 0.15);
  EXPECT_LE(quantile(with.middle, 0.99), 0.15);
  // The achieved figures, with a margin.
  EXPECT_LE(quantile(with.moved, 0.99), 0.11);
  EXPECT_LE(quantile(with.middle, 0.99), 0.11);
  EXPECT_GE(quantile(without.middle, 0.99), 2 * quantile(with.middle, 0.99));
}

TEST(PhaseError, is_small_for_fixed_columns_too) {
  const Figures with = figures_of(sweeping({}, true, "prism-mask-columns"), 1),
                without = figures_of(sweeping({}, false, "prism-mask-columns"), 1);
  print("fixed columns, 250 mm/s, predicted", with);
  print("fixed columns, 250 mm/s, as measured", without);
  EXPECT_LE(quantile(with.middle, 0.99), 0.15);
  EXPECT_GE(quantile(without.middle, 0.99), 2 * quantile(with.middle, 0.99));
}

TEST(PhaseError, grows_slowly_up_to_500_mm_s) {
  const Figures slow = figures_of(sweeping({.peak_mm_s = 100}), 1), fast = figures_of(sweeping({.peak_mm_s = 500}), 1);
  print("100 mm/s", slow);
  print("500 mm/s", fast);
  EXPECT_LE(quantile(slow.moved, 0.99), 0.10);
  EXPECT_LE(quantile(fast.moved, 0.99), 0.16);
  EXPECT_LE(quantile(fast.middle, 0.99), 0.16);
  EXPECT_EQ(fast.stereo_share(), 1);
}

TEST(PhaseError, is_small_for_a_turning_head) {
  VirtualStationSettings settings;
  const HeadMotion motion(MotionKind::turn, 3);
  settings.head = [motion](double seconds) {
    drivers::eye_tracker::SimulatedHead head;
    head.between_eyes_mm = motion.between_eyes_mm(seconds);
    return head;
  };
  const Figures turning = figures_of(settings, 1);
  print("turns at 412 mm/s", turning);
  EXPECT_LE(quantile(turning.moved, 0.99), 0.15);
}

TEST(PhaseError, is_small_for_a_still_head) {
  const Figures still = figures_of(sweeping({.peak_mm_s = 0}), 1);
  print("still", still);
  EXPECT_LE(quantile(still.moved, 0.99), 0.05);
  EXPECT_LE(quantile(still.middle, 0.99), 0.03);
}

// The mask's travel is too short, so it moves back by half periods; the eyes change places on the panel, and the picture is mono meanwhile.
TEST(PhaseError, moves_back_are_never_visible_in_stereo) {
  const Figures wide = figures_of(sweeping({.peak_mm_s = 250, .reach_mm = 380, .distance_mm = 500}), 1, 40);
  print("380 mm to either side, 500 mm away", wide);
  std::printf("in stereo for %.1f %% of the time\n", 100 * wide.stereo_share());
  EXPECT_LT(wide.stereo_share(), 1);
  EXPECT_GT(wide.stereo_share(), 0.65);
  EXPECT_LE(quantile(wide.moved, 0.99), 0.15);
  EXPECT_LE(quantile(wide.moved, 1), 0.3);
}

TEST(PhaseError, the_same_seed_gives_the_same_figures) {
  const Figures one = figures_of(sweeping({}), 1, 4), same = figures_of(sweeping({}), 1, 4);
  EXPECT_EQ(one.moved, same.moved);
  EXPECT_EQ(one.panel, same.panel);
}

}  // namespace
}  // namespace prismesh::phase_error
