// How a station's settings and profile configure its devices and its loop.
#include "daemon/deviced/station.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

namespace prismesh::deviced {
namespace {

namespace fs = std::filesystem;

StationPlan plan_with_both() {
  StationPlan plan;
  plan.settings.eye_tracker.driver = drivers::settings::TrackerDriver::dynasight;
  plan.settings.prism_servo.driver = drivers::settings::ServoDriver::dynamixel;
  plan.profile.mask_moves = true;
  return plan;
}

TEST(StationPlan, passes_the_limits_of_servo_and_display_to_the_loop) {
  StationPlan plan = plan_with_both();
  plan.settings.prism_servo.travel_mm = 1.25;
  plan.settings.prism_servo.speed_mm_s = 3;
  plan.settings.eye_tracker.noise_mm = 2.5;
  plan.servo.travel_mm = 1.25;
  plan.servo.id = 7;
  plan.profile.optics.zero_mm = 0.3;
  const LoopSettings loop = loop_settings(plan);
  EXPECT_EQ(loop.limits.travel_mm, 1.25) << "no goal lies beyond it";
  EXPECT_EQ(loop.limits.speed_mm_s, 3);
  EXPECT_EQ(loop.tracker.noise_mm, 2.5);
  EXPECT_EQ(loop.servo.travel_mm, 1.25);
  EXPECT_EQ(loop.servo.id, 7);
  EXPECT_EQ(loop.optics.zero_mm, 0.3);
}

TEST(StationPlan, waits_longer_for_the_eyes_of_a_slow_tracker) {
  const auto lost_after_ms = [](double latency_ms) {
    StationPlan plan = plan_with_both();
    plan.settings.eye_tracker.latency_ms = latency_ms;
    return static_cast<double>(loop_settings(plan).limits.eyes_lost_ns) * 1e-6;
  };
  EXPECT_EQ(lost_after_ms(0), 100);
  EXPECT_EQ(lost_after_ms(20), 100);
  EXPECT_EQ(lost_after_ms(50), 130) << "five records of a 60 Hz tracker";
  EXPECT_EQ(lost_after_ms(150), 230);
}

TEST(StationPlan, the_measured_eye_separation_overrides_the_trackers) {
  StationPlan plan = plan_with_both();
  plan.settings.eye_tracker.eye_separation_mm = 61;
  EXPECT_EQ(loop_settings(plan).eye_separation_mm, 61);
  plan.profile.eye_separation_mm = 58;
  EXPECT_EQ(loop_settings(plan).eye_separation_mm, 58);
}

TEST(StationPlan, has_the_devices_that_are_configured_and_used) {
  StationPlan plan = plan_with_both();
  EXPECT_TRUE(plan.has_tracker() && plan.has_servo());
  plan.profile.mask_moves = false;
  EXPECT_TRUE(plan.has_tracker());
  EXPECT_FALSE(plan.has_servo()) << "there is nothing to be moved";
  plan.profile.mask_moves = true;
  plan.settings.prism_servo.driver = drivers::settings::ServoDriver::none;
  EXPECT_FALSE(plan.has_servo());
  plan.settings.eye_tracker.driver = drivers::settings::TrackerDriver::none;
  EXPECT_FALSE(plan.has_tracker());
}

TEST(StationPlan, another_tracker_servo_or_moving_mask_needs_another_station) {
  const StationPlan plan = plan_with_both();
  StationPlan other = plan;
  other.profile.optics.zero_mm = 0.3;
  other.profile.name = "other";
  EXPECT_TRUE(plan.same_devices(other)) << "it continues, with another display";
  other = plan;
  other.settings.eye_tracker.latency_ms = 35;
  EXPECT_FALSE(plan.same_devices(other));
  other = plan;
  other.settings.prism_servo.travel_mm = 1;
  EXPECT_FALSE(plan.same_devices(other));
  other = plan;
  other.profile.mask_moves = false;
  EXPECT_FALSE(plan.same_devices(other));
}

class PlanFiles : public ::testing::Test {
 protected:
  PlanFiles() {
    std::string name = (fs::temp_directory_path() / "prismesh-plan-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~PlanFiles() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Result<StationPlan> read(const std::string& text) const {
    std::ofstream(folder_ / "prismesh.toml") << text;
    return read_plan(folder_ / "prismesh.toml");
  }
  fs::path folder_;
};

TEST_F(PlanFiles, read_the_servos_settings) {
  const Result<StationPlan> plan =
      read("[display]\nprofile = 'prism-mask'\n[prism_servo]\ndriver = 'dynamixel'\nsimulated = true\nid = 7\ntravel_mm = 1.5\n");
  ASSERT_TRUE(plan) << plan.error().text();
  EXPECT_TRUE(plan->has_servo());
  EXPECT_EQ(plan->profile.name, "prism-mask");
  EXPECT_EQ(plan->servo.id, 7);
  EXPECT_EQ(plan->servo.travel_mm, 1.5);
}

TEST_F(PlanFiles, are_refused_with_an_impossible_travel_only_if_a_servo_is_used) {
  const std::string servo = "[prism_servo]\ndriver = 'dynamixel'\nsimulated = true\ntravel_mm = 3\n";
  const Result<StationPlan> plan = read("[display]\nprofile = 'prism-mask'\n" + servo);
  ASSERT_FALSE(plan);
  EXPECT_NE(plan.error().text().find("encoder's turn"), std::string::npos) << plan.error().text();
  EXPECT_TRUE(read("[display]\nprofile = 'mono'\n" + servo)) << "left alone there";
  EXPECT_FALSE(read("[display]\nprofile = 'absent.toml'\n"));
}

}  // namespace
}  // namespace prismesh::deviced
