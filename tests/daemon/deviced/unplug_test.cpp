// Each device is unplugged a thousand times in virtual time (ten thousand in `./station soak`), at any byte of either direction. Each time
// the page says at once that nothing is to be relied on, the other device goes on, and within two seconds of the cable's return all is as
// before. PRISMESH_UNPLUGS sets how often.
#include <algorithm>
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

#include "tests/daemon/deviced/loop_rig.h"

namespace prismesh::deviced {
namespace {

using drivers::port::Direction;
using drivers::prism_servo::MaskPhase;
using ipc::EyesPhase;

int unplugs() {
  if (const char* wanted = std::getenv("PRISMESH_UNPLUGS"); wanted != nullptr && std::atoi(wanted) > 0) return std::atoi(wanted);
#ifdef PRISMESH_THREAD_SANITIZER
  return 200;
#else
  return 1000;
#endif
}

/// A picture must be mono this long after the last measurement: what the kiosk's blending starts from.
constexpr std::int64_t kMonoMs = 250;
constexpr std::int64_t kBackMs = 2000;
/// How long the bytes until the unplug may take.
constexpr std::int64_t kTurnMs = 1500;

class Unplug : public ::testing::Test {
 protected:
  Unplug() : rig_(options()) {
    // The picture can't tell more than the page does: what it relies on must never be old.
    rig_.after_tick = [this] {
      if (rig_.tracking()) oldest_eyes_ms_ = std::max(oldest_eyes_ms_, rig_.eyes_age_ms());
      if (!rig_.mask().stereo_allowed) return;
      oldest_mask_ms_ = std::max(oldest_mask_ms_, static_cast<double>(rig_.clock.now_ns() - rig_.mask().measured_ns) * 1e-6);
      mask_followed_unseen_ms_ = std::max(mask_followed_unseen_ms_, rig_.eyes_age_ms());
    };
  }
  static RigOptions options() {
    RigOptions options;
    // Nobody who sits still wanders to the end of the mask's travel, so nothing but the cables disturbs.
    options.head = [](double seconds) {
      drivers::eye_tracker::SimulatedHead head;
      head.between_eyes_mm = {15 * std::sin(2 * 3.14159265 * seconds / 4), 5, 650};
      return head;
    };
    return options;
  }

  std::size_t random(std::size_t below) { return std::uniform_int_distribution<std::size_t>(0, below - 1)(random_); }

  /// Pulls a cable after some bytes of one direction, or after a while if they don't flow.
  void pull(drivers::port::MemoryLine& line, std::size_t most_bytes) {
    line.unplug_after(random(2) == 0 ? Direction::to_host : Direction::to_device, random(most_bytes));
    if (rig_.run_until([&] { return !line.plugged_in(); }, kTurnMs) < 0) line.unplug();
  }

  LoopRig rig_;
  std::mt19937_64 random_{20040602};
  double oldest_eyes_ms_ = 0, oldest_mask_ms_ = 0, mask_followed_unseen_ms_ = 0;
  std::int64_t slowest_ms_ = 0;
};

TEST_F(Unplug, the_tracker) {
  rig_.start();
  const auto servo_before = rig_.servo.counts();
  for (int i = 0; i < unplugs(); ++i) {
    // Commands flow at the start of the talk only; records all the time.
    pull(rig_.tracker_line, 80);
    rig_.tick();
    ASSERT_EQ(rig_.eyes().phase, EyesPhase::absent) << "unplug " << i;
    rig_.run_for_ms(static_cast<std::int64_t>(random(400)));
    ASSERT_NE(rig_.eyes().phase, EyesPhase::tracking);
    if (random(10) == 0)
      rig_.tracker_line.plug_in();  // nobody tells: found by trying again
    else
      rig_.plug_in_tracker();
    const std::int64_t back = rig_.run_until([&] { return rig_.tracking() && rig_.following(); }, 10'000);
    ASSERT_GE(back, 0) << "unplug " << i << ": " << rig_.state();
    ASSERT_LE(back, kBackMs) << "unplug " << i;
    slowest_ms_ = std::max(slowest_ms_, back);
    rig_.events();
  }
  EXPECT_EQ(rig_.servo.counts().watchdog_trips, servo_before.watchdog_trips) << "the servo was disturbed";
  EXPECT_EQ(rig_.servo.counts().bad_packets, servo_before.bad_packets);
  EXPECT_LE(oldest_eyes_ms_, 104) << "tracking is said of what is at most eyes_lost_ns old";
  EXPECT_LE(mask_followed_unseen_ms_, static_cast<double>(kMonoMs)) << "stereo was allowed without eyes";
  RecordProperty("slowest_return_ms", static_cast<int>(slowest_ms_));
  std::printf("%d unplugs of the tracker; slowest return %d ms; eyes at most %.0f ms old while tracking\n", unplugs(),
              static_cast<int>(slowest_ms_), oldest_eyes_ms_);
}

TEST_F(Unplug, the_servo) {
  rig_.start();
  const std::uint64_t resyncs = rig_.eyes().resyncs, lost = rig_.eyes().times_lost;
  for (int i = 0; i < unplugs(); ++i) {
    pull(rig_.servo_line, 600);
    rig_.tick();
    rig_.tick();
    ASSERT_EQ(rig_.mask().phase, MaskPhase::absent) << "unplug " << i;
    ASSERT_FALSE(rig_.mask().stereo_allowed);
    rig_.run_for_ms(static_cast<std::int64_t>(random(400)));
    ASSERT_FALSE(rig_.mask().stereo_allowed);
    ASSERT_TRUE(rig_.tracking()) << "unplug " << i << ": the tracker was disturbed";
    if (random(10) == 0)
      rig_.servo_line.plug_in();
    else
      rig_.plug_in_servo();
    const std::int64_t back = rig_.run_until([&] { return rig_.following(); }, 10'000);
    ASSERT_GE(back, 0) << "unplug " << i << ": " << rig_.state();
    ASSERT_LE(back, kBackMs) << "unplug " << i;
    slowest_ms_ = std::max(slowest_ms_, back);
    rig_.events();
  }
  EXPECT_EQ(rig_.eyes().resyncs, resyncs);
  EXPECT_EQ(rig_.eyes().times_lost, lost);
  EXPECT_LE(oldest_mask_ms_, static_cast<double>(kMonoMs));
  RecordProperty("slowest_return_ms", static_cast<int>(slowest_ms_));
  std::printf("%d unplugs of the servo; slowest return %d ms; mask at most %.0f ms old while stereo was allowed\n", unplugs(),
              static_cast<int>(slowest_ms_), oldest_mask_ms_);
}

}  // namespace
}  // namespace prismesh::deviced
