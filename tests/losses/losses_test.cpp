// Ten thousand losses of each device, of the head and of the daemon itself, from the devices' bytes to the light of the picture, in virtual
// time: depth is gone from the display 250 ms after the last good measurement, and back within two seconds of the device.
#include <algorithm>
#include <memory>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "tests/daemon/deviced/loop_rig.h"
#include "tests/losses/kiosk_in_time.h"

namespace prismesh::test {
namespace {

using deviced::kMs;
using deviced::LoopRig;

constexpr int kLosses = 10'000;
constexpr std::int64_t kMonoNs = 250 * kMs, kBackNs = 2'000 * kMs;

/// Daemon and kiosk on one clock.
class StationInTime {
 public:
  StationInTime() {
    rig_.after_tick = [this] { kiosk_turn(); };
  }

  LoopRig& rig() { return rig_; }
  KioskInTime& kiosk() { return kiosk_; }
  std::int64_t now() { return rig_.clock.now_ns(); }
  bool depth_comes(std::int64_t within_ns) {
    for (const std::int64_t start = now(); now() - start < within_ns; rig_.tick())
      if (kiosk_.in_depth()) return true;
    return false;
  }
  void run_ms(std::int64_t ms) { rig_.run_for_ms(ms); }
  /// The daemon is dead: devices and kiosk go on. `connected`: the kiosk hasn't noticed at the socket yet, and its page stands still.
  void run_without_daemon(std::int64_t ms, bool connected) {
    const kiosk::stereo::DeviceReading last{rig_.reader.eyes(), rig_.reader.prism()};
    for (std::int64_t i = 0; i < ms; i += 4) {
      rig_.clock.advance_ns(4 * kMs);
      rig_.tracker.run_until(now());
      rig_.servo.step(now());
      kiosk_.turn(connected ? last : kiosk::stereo::DeviceReading{}, now());
    }
  }
  std::int64_t measured_ns() const { return rig_.eyes().measured_ns; }
  std::int64_t mask_measured_ns() const { return rig_.mask().measured_ns; }

 private:
  void kiosk_turn() {
    kiosk_.turn({rig_.reader.eyes(), rig_.reader.prism()}, now());
    const bool mono = kiosk_.seen_mono(now());
    if (mono != told_mono_) rig_.loop.send(deviced::SetPictureMono{told_mono_ = mono});
  }

  LoopRig rig_;
  KioskInTime kiosk_{7 * kMs};
  bool told_mono_ = true;
};

/// What happened at the worst.
struct Worst {
  std::int64_t mono_ns = 0;
  std::int64_t back_ns = 0;
};

class LossesTest : public ::testing::Test {
 protected:
  /// Loses something at random moments: `lose` takes it away and returns when it was last known to be good, `give_back` undoes it.
  template <class Lose, class GiveBack>
  void lose_often(const Lose& lose, const GiveBack& give_back) {
    ASSERT_TRUE(station_.depth_comes(10'000 * kMs)) << station_.rig().state();
    for (int i = 0; i < kLosses; ++i) {
      station_.kiosk().draw_ns = (1 + static_cast<std::int64_t>(random_() % 30)) * kMs;
      station_.run_ms(static_cast<std::int64_t>(random_() % 120));
      const std::int64_t good = lose();
      station_.run_ms(320);
      ASSERT_TRUE(station_.kiosk().mono()) << "loss " << i << ": " << station_.rig().state();
      worst_.mono_ns = std::max(worst_.mono_ns, station_.kiosk().depth_until_ns(station_.now()) - good);
      ASSERT_LE(worst_.mono_ns, kMonoNs) << "loss " << i;
      give_back();
      const std::int64_t given = station_.now();
      ASSERT_TRUE(station_.depth_comes(kBackNs)) << "loss " << i << ": " << station_.rig().state();
      worst_.back_ns = std::max(worst_.back_ns, station_.now() - given);
    }
    report();
  }
  void report() {
    const std::string text = "mono at most " + std::to_string(worst_.mono_ns / kMs) +
                             " ms after the last good measurement, depth back at most " + std::to_string(worst_.back_ns / kMs) +
                             " ms after the device";
    RecordProperty("worst", text);
    std::printf("%d losses: %s\n", kLosses, text.c_str());
  }

  StationInTime station_;
  std::mt19937 random_{17};
  Worst worst_;
};

TEST_F(LossesTest, of_the_eye_tracker) {
  lose_often(
      [&] {
        station_.rig().tracker_line.unplug();
        station_.run_ms(4);
        return station_.measured_ns();
      },
      [&] { station_.rig().plug_in_tracker(); });
}

TEST_F(LossesTest, of_the_prism_servo) {
  lose_often(
      [&] {
        station_.rig().servo_line.unplug();
        return station_.mask_measured_ns();
      },
      [&] { station_.rig().plug_in_servo(); });
}

TEST_F(LossesTest, of_the_trackers_power) {
  lose_often(
      [&] {
        station_.rig().tracker.set_power(false);
        return station_.now();
      },
      [&] { station_.rig().tracker.set_power(true); });
}

TEST_F(LossesTest, of_the_daemon) {
  ASSERT_TRUE(station_.depth_comes(10'000 * kMs)) << station_.rig().state();
  for (int i = 0; i < kLosses; ++i) {
    station_.kiosk().draw_ns = (1 + static_cast<std::int64_t>(random_() % 30)) * kMs;
    station_.run_ms(static_cast<std::int64_t>(random_() % 120));
    const std::int64_t good = station_.measured_ns();
    station_.run_without_daemon(320, random_() % 2 == 0);
    ASSERT_TRUE(station_.kiosk().mono()) << i;
    worst_.mono_ns = std::max(worst_.mono_ns, station_.kiosk().depth_until_ns(station_.now()) - good);
    ASSERT_LE(worst_.mono_ns, kMonoNs) << i;
    const std::int64_t given = station_.now();
    ASSERT_TRUE(station_.depth_comes(kBackNs)) << i << ": " << station_.rig().state();
    worst_.back_ns = std::max(worst_.back_ns, station_.now() - given);
  }
  report();
}

}  // namespace
}  // namespace prismesh::test
