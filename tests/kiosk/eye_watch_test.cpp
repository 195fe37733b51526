// When pictures are given depth, and what the daemon is told of them: with a simulated clock and a simulated page of the daemon.
#include "kiosk/eye_watch.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/kiosk/listening_daemon.h"

namespace prismesh::kiosk {
namespace {

using drivers::prism_servo::MaskPhase;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr std::int64_t kEyeWatchMs = 1'000'000, kPeriodMs = 20, kPanelMs = 10;

/// A viewer before a prism mask: the tracker sees the eyes and the mask follows them as long as the test says so.
class EyeWatchTest : public ListeningDaemonTest {
 protected:
  EyeWatchTest() : watch_({}, *link_, clock_, notices::Trace(nullptr)) {
    clock_.advance_ns(10'000 * kEyeWatchMs);
    watch_.set_timing({kPeriodMs * kEyeWatchMs, kPanelMs * kEyeWatchMs});
    publish();
    EXPECT_TRUE(turn_until([&] { return link_->connected(); }));
  }

  /// The daemon's page as of now.
  void publish() {
    ipc::EyesState eyes;
    if (seen_) measured_ns_ = clock_.now_ns() - 20 * kEyeWatchMs;
    eyes.time_ns = clock_.now_ns();
    eyes.measured_ns = measured_ns_;
    eyes.between_eyes_mm = {0, 0, 650};
    eyes.phase = eyes_phase_;
    daemon_->page().set_eyes(eyes);
    ipc::PrismState mask;
    mask.time_ns = mask.measured_ns = clock_.now_ns();
    mask.phase = mask_phase_;
    mask.stereo_allowed = mask_phase_ == MaskPhase::following;
    daemon_->page().set_prism(mask);
  }
  void pass_ms(std::int64_t ms) {
    clock_.advance_ns(ms * kEyeWatchMs);
    publish();
  }
  bool look() {
    publish();
    return watch_.look();
  }
  /// One refresh, at which a picture that has to change is drawn, in 5 ms.
  void refresh() {
    const bool draw = look();
    pass_ms(5);
    if (draw) watch_.drawn(std::nullopt);
    pass_ms(kPeriodMs - 5);
  }
  void refresh_until(double depth_share) {
    refresh();
    for (int i = 0; i < 200 && watch_.seen().depth_share != depth_share; ++i) refresh();
    ASSERT_EQ(watch_.seen().depth_share, depth_share);
  }
  /// What the daemon has been told up to now, in order.
  std::vector<std::string> told() {
    link_->reload();  // the last word
    EXPECT_TRUE(turn_until([&] {
      const std::vector<std::string> said = daemon_->told();
      return std::count(said.begin(), said.end(), "reload") > asked_;
    }));
    ++asked_;
    std::vector<std::string> said = daemon_->told();
    std::erase(said, "reload");
    return said;
  }

  ManualClock clock_;
  EyeWatch watch_;
  bool seen_ = true;
  ipc::EyesPhase eyes_phase_ = ipc::EyesPhase::tracking;
  MaskPhase mask_phase_ = MaskPhase::following;
  std::int64_t measured_ns_ = 0;
  std::ptrdiff_t asked_ = 0;
};

TEST_F(EyeWatchTest, a_display_that_refuses_depth_is_given_none_however_well_the_eyes_are_seen) {
  watch_.refuse_depth("The screen isn't at its native resolution.");
  for (int i = 0; i < 60; ++i) {
    refresh();
    ASSERT_EQ(watch_.seen().depth_share, 0) << "refresh " << i;
  }
  EXPECT_THAT(told(), ElementsAre("shows mono"));
  ASSERT_TRUE(watch_.facts());
  EXPECT_EQ(watch_.facts()->condition, toolkit::EyesFacts::Condition::trouble);
  EXPECT_EQ(watch_.facts()->advice, "The screen isn't at its native resolution.");
  EXPECT_FALSE(watch_.facts()->in_depth);
}

TEST_F(EyeWatchTest, depth_ends_with_the_next_picture_when_the_display_refuses_it) {
  refresh_until(1);
  watch_.refuse_depth("The screen isn't at its native resolution.");
  EXPECT_TRUE(look()) << "has to be drawn again";
  EXPECT_EQ(watch_.seen().depth_share, 0);
}

TEST_F(EyeWatchTest, depth_rises_as_ever_when_the_display_refuses_it_no_more) {
  watch_.refuse_depth("The screen isn't at its native resolution.");
  for (int i = 0; i < 60; ++i) refresh();
  watch_.refuse_depth("");
  const auto rise_ms = static_cast<double>(stereo::FollowLimits{}.rise_ns) / kEyeWatchMs;
  for (double before = 0; before < 1; before = watch_.seen().depth_share) {
    refresh();
    ASSERT_GT(watch_.seen().depth_share, before);
    ASSERT_LE(watch_.seen().depth_share - before, kPeriodMs / rise_ms + 1e-9);
  }
}

TEST_F(EyeWatchTest, glasses_have_their_full_depth_again_when_the_display_refuses_it_no_more) {
  stereo::FollowOptions glasses;
  glasses.mono_without_eyes = glasses.movable_mask = false;
  watch_.set_options(glasses);
  watch_.refuse_depth("The screen isn't at its native resolution.");
  refresh();
  EXPECT_EQ(watch_.seen().depth_share, 0);
  watch_.refuse_depth("");
  refresh();
  EXPECT_EQ(watch_.seen().depth_share, 1);
}

TEST_F(EyeWatchTest, the_daemon_hears_of_depth_before_it_is_drawn) {
  mask_phase_ = MaskPhase::homing;
  for (int i = 0; i < 10; ++i) refresh();
  EXPECT_THAT(told(), ElementsAre("shows mono"));
  mask_phase_ = MaskPhase::following;
  look();
  ASSERT_GT(watch_.seen().depth_share, 0);
  EXPECT_THAT(told(), ElementsAre("shows mono", "shows depth"));
}

TEST_F(EyeWatchTest, the_daemon_hears_of_mono_when_the_picture_is_seen_and_not_when_it_is_drawn) {
  refresh_until(1);
  const std::size_t before = told().size();
  seen_ = false;
  // Up to the picture that is drawn in mono first.
  for (int i = 0; i < 60; ++i) {
    const bool draw = look();
    pass_ms(5);
    if (draw) watch_.drawn(std::nullopt);
    if (watch_.seen().depth_share == 0) break;
    pass_ms(kPeriodMs - 5);
  }
  ASSERT_EQ(watch_.seen().depth_share, 0);
  // Handed over now: half a period until a refresh, half a period of scan-out to the middle, and the panel.
  const std::int64_t lit_ms = kPeriodMs / 2 + kPeriodMs / 2 + kPanelMs;
  for (std::int64_t ms = 0; ms < lit_ms; ++ms) {
    look();
    ASSERT_THAT(told(), SizeIs(before)) << "depth is on the display still, " << lit_ms - ms << " ms of it";
    pass_ms(1);
  }
  look();
  EXPECT_EQ(told().back(), "shows mono");
  EXPECT_THAT(told(), SizeIs(before + 1));
}

TEST_F(EyeWatchTest, a_picture_in_mono_is_told_once_and_each_time_after_depth) {
  mask_phase_ = MaskPhase::homing;
  for (int i = 0; i < 10; ++i) refresh();
  for (int round = 0; round < 2; ++round) {
    mask_phase_ = MaskPhase::following;
    refresh_until(1);
    mask_phase_ = MaskPhase::homing;
    refresh_until(0);
    for (int i = 0; i < 10; ++i) refresh();
  }
  EXPECT_THAT(told(), ElementsAre("shows mono", "shows depth", "shows mono", "shows depth", "shows mono"));
}

TEST_F(EyeWatchTest, depth_that_comes_back_before_mono_was_seen_stays_told) {
  refresh_until(1);
  mask_phase_ = MaskPhase::frozen;
  for (int i = 0; i < 60 && watch_.seen().depth_share > 0; ++i) refresh();
  ASSERT_EQ(watch_.seen().depth_share, 0);
  mask_phase_ = MaskPhase::following;
  for (int i = 0; i < 5; ++i) refresh();
  ASSERT_GT(watch_.seen().depth_share, 0);
  EXPECT_EQ(told().back(), "shows depth");
}

TEST_F(EyeWatchTest, mono_is_told_when_its_first_picture_is_seen_however_many_follow) {
  mask_phase_ = MaskPhase::homing;
  for (int i = 0; i < 3; ++i) {  // each is lit 30 ms later
    look();
    watch_.drawn(std::nullopt);
    pass_ms(16);
  }
  EXPECT_THAT(told(), ElementsAre("shows mono"));
}

TEST_F(EyeWatchTest, a_picture_for_a_file_counts_from_when_a_display_would_have_lit_it) {
  mask_phase_ = MaskPhase::homing;
  look();
  const std::int64_t lit_ns = watch_.lit_ns();
  ASSERT_GT(lit_ns, clock_.now_ns() + 2 * kEyeWatchMs);
  watch_.taken();
  clock_.advance_ns(lit_ns - clock_.now_ns() - kEyeWatchMs);
  look();
  EXPECT_THAT(told(), IsEmpty());
  pass_ms(1);
  look();
  EXPECT_THAT(told(), ElementsAre("shows mono"));
}

TEST_F(EyeWatchTest, a_refresh_that_the_display_tells_fixes_when_pictures_light_up) {
  for (int i = 0; i < 3; ++i) {
    look();
    pass_ms(5);
    watch_.drawn(clock_.now_ns() - 2 * kEyeWatchMs);
  }
  const std::int64_t refreshed = clock_.now_ns() - 2 * kEyeWatchMs;
  look();
  // Drawn 5 ms from now, 7 ms after that refresh, it waits for the next; then half a period of scan-out, and the panel.
  EXPECT_EQ(watch_.lit_ns(), refreshed + (kPeriodMs + kPeriodMs / 2 + kPanelMs) * kEyeWatchMs);
}

TEST_F(EyeWatchTest, what_the_panel_says_is_drawn_though_the_eyes_see_the_same) {
  seen_ = false;
  eyes_phase_ = ipc::EyesPhase::searching;
  mask_phase_ = MaskPhase::parked;
  for (int i = 0; i < 5; ++i) refresh();
  EXPECT_FALSE(look());
  eyes_phase_ = ipc::EyesPhase::silent;
  EXPECT_TRUE(look());
}

TEST_F(EyeWatchTest, the_panel_gives_the_devices_own_words) {
  ipc::DeviceInfo tracker, servo;
  tracker.role = "eye tracker";
  tracker.trouble = "/dev/ttyUSB0: nothing is plugged in there";
  servo.role = "prism servo";
  servo.trouble = "no servo with id 1 answers";
  servo.simulated = true;
  daemon_->have({tracker, servo});
  link_->reload();
  ASSERT_TRUE(turn_until([&] { return link_->devices().size() == 2; }));
  mask_phase_ = MaskPhase::absent;
  look();
  EXPECT_EQ(watch_.facts()->advice, servo.trouble);
  EXPECT_EQ(watch_.facts()->mask, "motor doesn't answer");
  EXPECT_TRUE(watch_.facts()->simulated);
  eyes_phase_ = ipc::EyesPhase::absent;
  look();
  EXPECT_EQ(watch_.facts()->advice, tracker.trouble);
  EXPECT_EQ(watch_.facts()->mask, "motor doesn't answer");
}

TEST_F(EyeWatchTest, nothing_is_said_of_a_mask_that_does_not_move) {
  stereo::FollowOptions still;
  still.movable_mask = false;
  watch_.set_options(still);
  mask_phase_ = MaskPhase::absent;
  refresh_until(1);
  refresh();
  EXPECT_EQ(watch_.facts()->mask, "");
  EXPECT_EQ(watch_.facts()->condition, toolkit::EyesFacts::Condition::good);
}

TEST_F(EyeWatchTest, a_mask_that_moves_is_watched_even_for_fixed_eyes) {
  stereo::FollowOptions fixed;
  fixed.follow = false;
  watch_.set_options(fixed);
  EXPECT_TRUE(watch_.watches());
  stop_daemon();
  EXPECT_FALSE(watch_.watches());
}

TEST_F(EyeWatchTest, without_the_daemon_the_picture_loses_its_depth) {
  refresh_until(1);
  stop_daemon();
  for (int i = 0; i < 20; ++i) {
    watch_.look();
    clock_.advance_ns(kPeriodMs * kEyeWatchMs);
  }
  EXPECT_EQ(watch_.seen().depth_share, 0);
  EXPECT_EQ(watch_.facts()->eyes, "no device daemon");
}

TEST_F(EyeWatchTest, the_panel_says_why_there_is_no_depth) {
  refresh_until(1);
  EXPECT_EQ(watch_.facts()->condition, toolkit::EyesFacts::Condition::good);
  EXPECT_EQ(watch_.facts()->mask, "following");
  EXPECT_TRUE(watch_.facts()->in_depth);
  mask_phase_ = MaskPhase::stuck;
  refresh_until(0);
  refresh();
  EXPECT_EQ(watch_.facts()->condition, toolkit::EyesFacts::Condition::trouble);
  EXPECT_EQ(watch_.facts()->eyes, "following you");
  EXPECT_EQ(watch_.facts()->mask, "stuck");
  EXPECT_NE(watch_.facts()->advice, "");
  EXPECT_FALSE(watch_.facts()->in_depth);
  eyes_phase_ = ipc::EyesPhase::absent;
  refresh();
  EXPECT_EQ(watch_.facts()->eyes, "tracker unplugged") << "the eyes come first";
  EXPECT_EQ(watch_.facts()->advice, "Plug the eye tracker in.");
}

TEST_F(EyeWatchTest, fixed_eyes_are_drawn_once_and_the_daemon_may_move_the_mask) {
  stereo::FollowOptions fixed;
  fixed.follow = fixed.movable_mask = false;
  watch_.set_options(fixed);
  EXPECT_TRUE(look());
  EXPECT_FALSE(watch_.facts());
  EXPECT_FALSE(watch_.watches());
  watch_.drawn(std::nullopt);
  EXPECT_THAT(told(), IsEmpty());
  pass_ms(100);
  EXPECT_FALSE(look()) << "nothing has changed";
  EXPECT_THAT(told(), ElementsAre("shows mono")) << "a display that follows no eyes needs no mask that does";
}

}  // namespace
}  // namespace prismesh::kiosk
