// Unplugs each device a thousand times in virtual time (ten thousand in `./station soak`), at any byte of either direction. Each time the
// page reports the loss at once, the other device continues, and everything works again within two seconds of plugging in. PRISMESH_UNPLUGS
// sets the number.
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

/// The picture must be mono so long after the last measurement; the kiosk's blending depends on it.
constexpr std::int64_t kMonoMs = 250;
constexpr std::int64_t kBackMs = 2000;
/// Max. time for the bytes until the unplug.
constexpr std::int64_t kTurnMs = 1500;

class Unplug : public ::testing::Test {
 protected:
  Unplug() : rig_(options()) {
    // The picture uses only the page, so the page's data must never be old.
    rig_.after_tick = [this] {
      if (rig_.tracking()) max_eyes_age_ms_ = std::max(max_eyes_age_ms_, rig_.eyes_age_ms());
      if (!rig_.mask().stereo_allowed) return;
      oldest_mask_ms_ = std::max(oldest_mask_ms_, static_cast<double>(rig_.clock.now_ns() - rig_.mask().measured_ns) * 1e-6);
      mask_followed_unseen_ms_ = std::max(mask_followed_unseen_ms_, rig_.eyes_age_ms());
    };
  }
  static RigOptions options() {
    RigOptions options;
    // A sitting viewer doesn't reach the end of the mask's travel, so that only unplugs interrupt stereo.
    options.head = [](double seconds) {
      drivers::eye_tracker::SimulatedHead head;
      head.between_eyes_mm = {15 * std::sin(2 * 3.14159265 * seconds / 4), 5, 650};
      return head;
    };
    return options;
  }

  std::size_t random(std::size_t below) { return std::uniform_int_distribution<std::size_t>(0, below - 1)(random_); }

  /// Unplugs a cable after some bytes of one direction, or after a while if none are transferred.
  void pull(drivers::port::MemoryLine& line, std::size_t max_bytes) {
    line.unplug_after(random(2) == 0 ? Direction::to_host : Direction::to_device, random(max_bytes));
    if (rig_.run_until([&] { return !line.plugged_in(); }, kTurnMs) < 0) line.unplug();
  }

  LoopRig rig_;
  std::mt19937_64 random_{20040602};
  double max_eyes_age_ms_ = 0, oldest_mask_ms_ = 0, mask_followed_unseen_ms_ = 0;
  std::int64_t max_return_ms_ = 0;
};

TEST_F(Unplug, the_tracker) {
  rig_.start();
  const auto servo_before = rig_.servo.counts();
  for (int i = 0; i < unplugs(); ++i) {
    // Commands are sent only at the start of the dialogue, records at all times.
    pull(rig_.tracker_line, 80);
    rig_.tick();
    ASSERT_EQ(rig_.eyes().phase, EyesPhase::absent) << "unplug " << i;
    rig_.run_for_ms(static_cast<std::int64_t>(random(400)));
    ASSERT_NE(rig_.eyes().phase, EyesPhase::tracking);
    if (random(10) == 0)
      rig_.tracker_line.plug_in();  // without a notification: found by the keeper's next attempt
    else
      rig_.plug_in_tracker();
    const std::int64_t back = rig_.run_until([&] { return rig_.tracking() && rig_.following(); }, 10'000);
    ASSERT_GE(back, 0) << "unplug " << i << ": " << rig_.state();
    ASSERT_LE(back, kBackMs) << "unplug " << i;
    max_return_ms_ = std::max(max_return_ms_, back);
    rig_.events();
  }
  EXPECT_EQ(rig_.servo.counts().watchdog_trips, servo_before.watchdog_trips) << "the servo was disturbed";
  EXPECT_EQ(rig_.servo.counts().bad_packets, servo_before.bad_packets);
  EXPECT_LE(max_eyes_age_ms_, 104) << "tracking is only reported for data up to eyes_lost_ns old";
  EXPECT_LE(mask_followed_unseen_ms_, static_cast<double>(kMonoMs)) << "stereo was allowed without eyes";
  RecordProperty("slowest_return_ms", static_cast<int>(max_return_ms_));
  std::printf("%d unplugs of the tracker; slowest return %d ms; eyes at most %.0f ms old while tracking\n", unplugs(),
              static_cast<int>(max_return_ms_), max_eyes_age_ms_);
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
    max_return_ms_ = std::max(max_return_ms_, back);
    rig_.events();
  }
  EXPECT_EQ(rig_.eyes().resyncs, resyncs);
  EXPECT_EQ(rig_.eyes().times_lost, lost);
  EXPECT_LE(oldest_mask_ms_, static_cast<double>(kMonoMs));
  RecordProperty("slowest_return_ms", static_cast<int>(max_return_ms_));
  std::printf("%d unplugs of the servo; slowest return %d ms; mask at most %.0f ms old while stereo was allowed\n", unplugs(),
              static_cast<int>(max_return_ms_), oldest_mask_ms_);
}

}  // namespace
}  // namespace prismesh::deviced
