#include "daemon/deviced/watchdog.h"

#include <condition_variable>
#include <mutex>
#include <utility>

namespace prismesh::deviced {

namespace {

void watch(const std::stop_token& stop, const std::function<std::uint64_t()>& ticks, const std::function<void()>& stuck,
           const WatchdogTimes& times) {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  StallCounter counter(ticks(), times.max_checks);
  while (!stop.stop_requested()) {
    wake.wait_for(lock, stop, times.period, [] { return false; });
    if (stop.stop_requested()) return;
    if (counter.stalled(ticks())) return stuck();
  }
}

}  // namespace

Watchdog::Watchdog(std::function<std::uint64_t()> ticks, std::function<void()> stuck, const WatchdogTimes& times)
    : thread_(
          [ticks = std::move(ticks), stuck = std::move(stuck), times](const std::stop_token& stop) { watch(stop, ticks, stuck, times); }) {}

}  // namespace prismesh::deviced
