#include "daemon/common/watchdog.h"

#include <future>

#include <gtest/gtest.h>

namespace prismesh::daemon {
namespace {

using namespace std::chrono_literals;

TEST(Watchdog, a_hang_is_found_after_max_periods_without_a_beat) {
  Heartbeat heartbeat;
  HeartbeatMonitor monitor("it", heartbeat, 3);
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(monitor.is_hung()) << "no beats are expected";
  heartbeat.begin();
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(monitor.is_hung());
  EXPECT_TRUE(monitor.is_hung());
}

TEST(Watchdog, each_beat_restarts_the_count) {
  Heartbeat heartbeat;
  HeartbeatMonitor monitor("it", heartbeat, 3);
  heartbeat.begin();
  for (int i = 0; i < 30; ++i) {
    EXPECT_FALSE(monitor.is_hung()) << i;
    if (i % 3 == 0) heartbeat.beat();
  }
  heartbeat.end();
  for (int i = 0; i < 30; ++i) EXPECT_FALSE(monitor.is_hung()) << "it is over";
  // Work that begins and ends between two periods isn't a hang.
  for (int i = 0; i < 30; ++i) {
    heartbeat.begin();
    EXPECT_FALSE(monitor.is_hung());
    heartbeat.end();
  }
}

TEST(Watchdog, reports_once_which_heartbeat_is_missing) {
  Heartbeat lively, hung;
  std::promise<std::string> told;
  std::vector<HeartbeatMonitor> watched;
  watched.emplace_back("lively", lively, 1);
  watched.emplace_back("hung", hung, 2);
  hung.begin();
  const Watchdog watchdog(std::move(watched), 1ms, [&](const std::string& fault) { told.set_value(fault); });
  EXPECT_EQ(told.get_future().get(), "hung");
}

}  // namespace
}  // namespace prismesh::daemon
