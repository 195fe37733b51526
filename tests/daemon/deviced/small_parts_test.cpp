// The ring between loop and main thread, the loop's thread, and the device status.
#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "base/ring.h"
#include "daemon/deviced/device_status.h"
#include "daemon/deviced/loop_thread.h"

namespace prismesh::deviced {
namespace {

using drivers::prism_servo::MaskPhase;
using drivers::prism_servo::ServoPhase;
using drivers::prism_servo::ServoTrouble;
using drivers::settings::TrackerDriver;
using ipc::EyesPhase;
using namespace std::chrono_literals;

TEST(Ring, returns_values_in_order_and_refuses_when_full) {
  Ring<int, 4> ring;
  EXPECT_FALSE(ring.pop());
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(ring.push(i));
  EXPECT_FALSE(ring.push(4));
  EXPECT_EQ(ring.pop(), 0);
  EXPECT_TRUE(ring.push(4));
  for (int i = 1; i <= 4; ++i) EXPECT_EQ(ring.pop(), i);
  EXPECT_FALSE(ring.pop());
}

TEST(Ring, transfers_everything_from_one_thread_to_another) {
  struct Pair {
    std::uint64_t a = 0, b = 0;
  };
  constexpr std::uint64_t kCount = 200'000;
  Ring<Pair, 64> ring;
  std::jthread writer([&ring] {
    for (std::uint64_t i = 0; i < kCount;)
      if (ring.push({i, ~i})) ++i;
  });
  for (std::uint64_t i = 0; i < kCount;) {
    const std::optional<Pair> pair = ring.pop();
    if (!pair) continue;
    ASSERT_EQ(pair->a, i);
    ASSERT_EQ(pair->b, ~i);
    ++i;
  }
}

TEST(LoopThread, skips_missed_ticks) {
  constexpr std::int64_t kDue = 1'000'000'000'000, kShort = kTickPeriodNs / 10;
  EXPECT_EQ(next_due_ns(kDue, kDue), kDue + kTickPeriodNs);
  EXPECT_EQ(next_due_ns(kDue, kDue + kShort), kDue + kTickPeriodNs);
  EXPECT_EQ(next_due_ns(kDue, kDue - kShort), kDue + kTickPeriodNs) << "a clock that is read on another processor";
  EXPECT_EQ(next_due_ns(kDue, kDue + kTickPeriodNs + kShort), kDue + kTickPeriodNs) << "a little late: at once, and then in step again";
  // A stall of one second: one tick at once, and none of the other 249.
  const std::int64_t ended = kDue + 250 * kTickPeriodNs + kShort;
  EXPECT_EQ(next_due_ns(kDue, ended), kDue + 250 * kTickPeriodNs);
  EXPECT_EQ(next_due_ns(next_due_ns(kDue, ended), ended), kDue + 251 * kTickPeriodNs) << "in step with the time before";
}

TEST(LoopThread, ticks_and_publishes_its_timing) {
  ipc::DevicePage page = ipc::DevicePage::create().value();
  const ipc::DevicePageReader reader = ipc::DevicePageReader::map(page.descriptor()).value();
  DeviceLoop loop({}, {}, page);
  std::int64_t ticked_ns = 0;
  {
    const auto thread = LoopThread::start(loop, page, false, true).value();
    while (reader.health().value_or(ipc::DeviceHealth{}).ticks < 256) std::this_thread::sleep_for(1ms);
    EXPECT_GE(thread->heartbeat().count(), 2 * 255U) << "two a beat";
    const ipc::DeviceHealth health = reader.health().value();
    ticked_ns = health.heartbeat_ns;
    EXPECT_GE(health.ticks, 256u);
    EXPECT_GT(ticked_ns, 0);
    EXPECT_EQ(health.pid, ::getpid());
    EXPECT_GT(health.tick_cpu_ns, 0) << "a median of 256 ticks";
    EXPECT_TRUE(health.simulated);
    EXPECT_FALSE(health.memory_locked);
    EXPECT_EQ(health.realtime, thread->refused().empty());
  }
  // A servo that answers late still has the time to receive the torque-off command.
  EXPECT_GE(reader.prism()->time_ns, ticked_ns + 24 * kTickPeriodNs) << "it winds down for 25 ticks";
}

TEST(DeviceStatus, says_what_to_do_about_a_tracker) {
  drivers::settings::EyeTrackerSettings settings;
  settings.driver = TrackerDriver::dynasight;
  settings.port = "/dev/serial/by-id/tracker";
  drivers::port::KeeperReport port;
  port.reason = Error{settings.port, 0, "nothing is plugged in there"};
  ipc::DeviceInfo info = tracker_info(settings, {EyesPhase::absent, 0}, port);
  EXPECT_EQ(info.role, "eye tracker");
  EXPECT_EQ(info.kind, "dynasight");
  EXPECT_EQ(info.where, settings.port);
  EXPECT_EQ(info.state, "absent");
  EXPECT_EQ(info.trouble, "/dev/serial/by-id/tracker: nothing is plugged in there");

  info = tracker_info(settings, {EyesPhase::silent, kMaxFirstSilenceNs / 2}, {});
  EXPECT_EQ(info.trouble, "") << "it has only just been opened";
  info = tracker_info(settings, {EyesPhase::silent, 2 * kMaxFirstSilenceNs}, {});
  EXPECT_NE(info.trouble.find("19200 baud"), std::string::npos) << info.trouble;
  info = tracker_info(settings, {EyesPhase::searching, 2 * kMaxFirstSilenceNs}, {});
  EXPECT_EQ(info.state, "searching");
  EXPECT_EQ(info.trouble, "") << "no viewer: no fault";

  settings.driver = TrackerDriver::opentrack;
  settings.simulated = true;
  info = tracker_info(settings, {EyesPhase::silent, 2 * kMaxFirstSilenceNs}, {});
  EXPECT_EQ(info.where, "127.0.0.1:4242");
  EXPECT_TRUE(info.simulated);
  EXPECT_NE(info.trouble.find("start opentrack"), std::string::npos) << info.trouble;
}

TEST(DeviceStatus, says_what_to_do_about_a_servo) {
  drivers::settings::PrismServoSettings settings;
  settings.port = "/dev/ttyUSB1";
  ServoStatus status;
  drivers::port::KeeperReport port;
  port.reason = Error{settings.port, 0, "no permission"};
  EXPECT_EQ(servo_info(settings, status, port).trouble, "/dev/ttyUSB1: no permission");

  status.open = true;
  status.mask = MaskPhase::following;
  status.tick.phase = ServoPhase::ready;
  ipc::DeviceInfo info = servo_info(settings, status, {});
  EXPECT_EQ(info.state, "following");
  EXPECT_EQ(info.trouble, "");

  status.mask = MaskPhase::stuck;
  EXPECT_NE(servo_info(settings, status, {}).trouble.find("--rearm"), std::string::npos);

  status.mask = MaskPhase::alarm;
  status.tick.phase = ServoPhase::alarm;
  status.tick.alarm_bits = 0x20;
  EXPECT_EQ(servo_info(settings, status, {}).trouble,
            "the prism servo has switched its motor off (overload): look for what blocks or heats it, and at its supply, then say so with "
            "`prismesh devices --rearm`");

  status.mask = MaskPhase::absent;
  status.tick = {};
  status.tick.trouble = ServoTrouble::no_answer;
  EXPECT_NE(servo_info(settings, status, {}).trouble, "");
}

TEST(DeviceStatus, every_phase_has_a_name) {
  for (int phase = 0; phase <= static_cast<int>(EyesPhase::tracking); ++phase) EXPECT_NE(name(static_cast<EyesPhase>(phase)), "unknown");
  for (int phase = 0; phase <= static_cast<int>(MaskPhase::alarm); ++phase) EXPECT_NE(name(static_cast<MaskPhase>(phase)), "unknown");
}

}  // namespace
}  // namespace prismesh::deviced
