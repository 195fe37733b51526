// Simulated trackers as in a station without hardware: over a real pseudo-terminal and real loopback datagrams, in real time. Checks
// positions only, not the machine's speed.
#include "drivers/eye_tracker/configured/simulator.h"

#include <thread>

#include <gtest/gtest.h>

#include "drivers/eye_tracker/configured/tracker.h"
#include "drivers/eye_tracker/plausible.h"
#include "drivers/port/open_port.h"

namespace prismesh::drivers::eye_tracker {
namespace {

using configured::ConfiguredTracker;
using configured::SimulatedTrackerThread;

settings::EyeTrackerSettings simulated(settings::TrackerDriver driver) {
  settings::EyeTrackerSettings settings;
  settings.driver = driver;
  settings.simulated = true;
  settings.motion = "still";
  return settings;
}

/// Polls until `count` samples have arrived. Returns false after ten seconds.
bool receive_samples(EyeTracker& tracker, int count) {
  MonotonicClock clock;
  for (int i = 0; i < 5'000 && count > 0; ++i) {
    const auto polled = tracker.poll(clock.now_ns());
    if (polled.fresh) {
      --count;
      // A sitting head is between half a metre and a metre before the screen.
      EXPECT_TRUE(plausible_head(polled.sample.between_eyes_mm));
      EXPECT_NEAR(polled.sample.between_eyes_mm.z(), 650, 50);
      EXPECT_LE(polled.sample.measured_ns, clock.now_ns());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return count == 0;
}

TEST(SimulatedTracker, a_dynasight_streams_over_a_pseudo_terminal_in_both_dialects_and_polled) {
  MonotonicClock clock;
  for (const auto dialect : {settings::TrackerDialect::dynasight, settings::TrackerDialect::d4d})
    for (const bool polled : {false, true}) {
      auto settings = simulated(settings::TrackerDriver::dynasight);
      settings.dialect = dialect;
      settings.polled = polled;
      const auto device = SimulatedTrackerThread::start(settings, clock);
      ASSERT_TRUE(device) << device.error().text();
      const auto port = port::open_port((*device)->port_path(), settings.baud);
      ASSERT_TRUE(port) << port.error().text();
      ConfiguredTracker configured(settings);
      EXPECT_TRUE(receive_samples(configured.attach(**port), 10));
    }
}

TEST(SimulatedTracker, a_reopened_port_finds_the_same_device) {
  MonotonicClock clock;
  const auto settings = simulated(settings::TrackerDriver::dynasight);
  const auto device = SimulatedTrackerThread::start(settings, clock);
  ASSERT_TRUE(device);
  ConfiguredTracker configured(settings);
  for (int i = 0; i < 3; ++i) {
    const auto port = port::open_port((*device)->port_path(), settings.baud);
    ASSERT_TRUE(port) << port.error().text();
    EXPECT_TRUE(receive_samples(configured.attach(**port), 3));
    configured.detach();
  }
}

TEST(SimulatedTracker, the_port_is_gone_after_the_device_ends) {
  MonotonicClock clock;
  const auto settings = simulated(settings::TrackerDriver::dynasight);
  auto device = SimulatedTrackerThread::start(settings, clock);
  ASSERT_TRUE(device);
  const auto port = port::open_port((*device)->port_path(), settings.baud);
  ASSERT_TRUE(port);
  ConfiguredTracker configured(settings);
  EyeTracker& tracker = configured.attach(**port);
  EXPECT_TRUE(receive_samples(tracker, 3));
  device->reset();
  auto status = port::PortStatus::ok;
  for (int i = 0; i < 2'000 && status == port::PortStatus::ok; ++i) {
    status = tracker.poll(clock.now_ns()).status;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_EQ(status, port::PortStatus::gone);
}

TEST(SimulatedTracker, opentrack_sends_to_loopback) {
  MonotonicClock clock;
  auto port = port::UdpPort::open(0);
  ASSERT_TRUE(port) << port.error().text();
  auto settings = simulated(settings::TrackerDriver::opentrack);
  settings.udp_port = (*port)->udp_port();
  const auto device = SimulatedTrackerThread::start(settings, clock);
  ASSERT_TRUE(device) << device.error().text();
  EXPECT_EQ((*device)->port_path(), "");
  ConfiguredTracker configured(settings);
  EXPECT_TRUE(receive_samples(configured.attach(**port), 10));
}

TEST(SimulatedTracker, refuses_what_it_cannot_simulate_with_a_reason) {
  MonotonicClock clock;
  auto settings = simulated(settings::TrackerDriver::dynasight);
  settings.motion = "swy";
  const auto unknown = SimulatedTrackerThread::start(settings, clock);
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("sway"), std::string::npos) << unknown.error().text();
  settings = simulated(settings::TrackerDriver::none);
  EXPECT_FALSE(SimulatedTrackerThread::start(settings, clock));
}

}  // namespace
}  // namespace prismesh::drivers::eye_tracker
