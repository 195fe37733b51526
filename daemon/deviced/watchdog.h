// Detects a device loop that hangs. The devices stop by their own watchdogs; the process must end, so that its supervisor restarts it.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <thread>

namespace prismesh::deviced {

struct WatchdogTimes {
  std::chrono::milliseconds period{250};
  /// The loop hangs after so many checks in a row without a tick. Counts checks instead of time, so that a stopped process or a machine
  /// that slept isn't taken for a hang.
  int max_checks = 6;
};

/// Counts checks in a row without a new tick.
class StallCounter {
 public:
  StallCounter(std::uint64_t ticks, int max_checks) : last_(ticks), max_checks_(max_checks) {}
  /// Checks the number of ticks. Returns true once in each stall: at the `max_checks`-th check in a row without a new tick.
  bool stalled(std::uint64_t ticks) {
    without_tick_ = ticks == last_ ? without_tick_ + 1 : 0;
    last_ = ticks;
    return without_tick_ == max_checks_;
  }

 private:
  std::uint64_t last_;
  int max_checks_;
  int without_tick_ = 0;
};

class Watchdog {
 public:
  /// `ticks` returns the number of ticks so far. `stuck` is called once when the loop hangs. Both are called from the watchdog's thread.
  Watchdog(std::function<std::uint64_t()> ticks, std::function<void()> stuck, const WatchdogTimes& times = {});

 private:
  std::jthread thread_;
};

}  // namespace prismesh::deviced
