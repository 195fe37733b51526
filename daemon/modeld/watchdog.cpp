#include "daemon/modeld/watchdog.h"

#include <utility>

namespace prismesh::modeld {

bool Silence::beat() {
  const std::uint64_t count = pulse_.count();
  const bool silent = count % 2 == 1 && count == last_;
  last_ = count;
  silent_ = silent ? silent_ + 1 : 0;
  return silent_ >= max_beats_;
}

Watchdog::Watchdog(std::vector<Silence> watched, std::chrono::milliseconds beat, std::function<void(const std::string&)> on_hang)
    : watched_(std::move(watched)), beat_(beat), on_hang_(std::move(on_hang)), thread_([this] { watch(); }) {}

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
  while (!ending_.wait_for(lock, beat_, [this] { return ended_; }))
    for (Silence& each : watched_)
      if (each.beat()) return on_hang_(each.what());
}

}  // namespace prismesh::modeld
