#include "daemon/common/watchdog.h"

#include <utility>

namespace prismesh::daemon {

bool HeartbeatMonitor::is_hung() {
  const std::uint64_t count = heartbeat_.count();
  const bool missing = count % 2 == 1 && count == last_;
  last_ = count;
  missing_ = missing ? missing_ + 1 : 0;
  return missing_ >= max_periods_;
}

Watchdog::Watchdog(std::vector<HeartbeatMonitor> watched, std::chrono::milliseconds period, std::function<void(const std::string&)> on_hang)
    : watched_(std::move(watched)), period_(period), on_hang_(std::move(on_hang)), thread_([this] { watch(); }) {}

Watchdog::~Watchdog() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  ending_.notify_one();
  thread_.join();
}

void Watchdog::watch() {
  std::unique_lock lock(mutex_);
  while (!ending_.wait_for(lock, period_, [this] { return ended_; }))
    for (HeartbeatMonitor& each : watched_)
      if (each.is_hung()) return on_hang_(each.fault());
}

}  // namespace prismesh::daemon
