// The simulated trackers as a station without hardware has them: over a real pseudo-terminal and real loopback datagrams, in real time.
// What is asserted are places, never how fast the machine was.
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

/// Polls until `count` samples came; false after ten seconds.
bool hear(EyeTracker& tracker, int count) {
  MonotonicClock clock;
  for (int i = 0; i < 5'000 && count > 0; ++i) {
    const auto polled = tracker.poll(clock.now_ns());
    if (polled.fresh) {
      --count;
      // A head that sits still does so half a metre to a metre before the screen.
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
      EXPECT_TRUE(hear(configured.attach(**port), 10));
    }
}

TEST(SimulatedTracker, a_port_that_is_opened_again_finds_the_device_still_there) {
  MonotonicClock clock;
  const auto settings = simulated(settings::TrackerDriver::dynasight);
  const auto device = SimulatedTrackerThread::start(settings, clock);
  ASSERT_TRUE(device);
  ConfiguredTracker configured(settings);
  for (int i = 0; i < 3; ++i) {
    const auto port = port::open_port((*device)->port_path(), settings.baud);
    ASSERT_TRUE(port) << port.error().text();
    EXPECT_TRUE(hear(configured.attach(**port), 3));
    configured.detach();
  }
}

TEST(SimulatedTracker, when_the_device_ends_its_port_is_gone) {
  MonotonicClock clock;
  const auto settings = simulated(settings::TrackerDriver::dynasight);
  auto device = SimulatedTrackerThread::start(settings, clock);
  ASSERT_TRUE(device);
  const auto port = port::open_port((*device)->port_path(), settings.baud);
  ASSERT_TRUE(port);
  ConfiguredTracker configured(settings);
  EyeTracker& tracker = configured.attach(**port);
  EXPECT_TRUE(hear(tracker, 3));
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
  EXPECT_TRUE(hear(configured.attach(**port), 10));
}

TEST(SimulatedTracker, what_cannot_be_played_is_refused_with_a_reason) {
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
