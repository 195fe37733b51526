// Notices a device loop that hangs. The loop can't say so itself, and what it drives is stopped by the devices' own watchdogs; the
// process has to end, so that it is started anew.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <thread>

namespace prismesh::deviced {

struct WatchdogTimes {
  std::chrono::milliseconds look{250};
  /// So many looks in a row without a tick: stuck. Looks, not a time, so that a process that was stopped or a machine that slept isn't
  /// taken for a hang.
  int looks = 6;
};

/// Counts looks in a row that saw no tick.
class StillLooks {
 public:
  StillLooks(std::uint64_t ticks, int looks) : last_(ticks), looks_(looks) {}
  /// Takes a look. True when the ticks have stood still for all of the looks, once for each time that they stand still.
  bool stuck(std::uint64_t ticks) {
    still_ = ticks == last_ ? still_ + 1 : 0;
    last_ = ticks;
    return still_ == looks_;
  }

 private:
  std::uint64_t last_;
  int looks_;
  int still_ = 0;
};

class Watchdog {
 public:
  /// `ticks` counts while all is well; called from a thread of the watchdog's own, as is `stuck`, once.
  Watchdog(std::function<std::uint64_t()> ticks, std::function<void()> stuck, const WatchdogTimes& times = {});

 private:
  std::jthread thread_;
};

}  // namespace prismesh::deviced
