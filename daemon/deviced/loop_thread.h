// Runs the device loop in real time: a thread with SCHED_FIFO where the system grants it, ticks at absolute times, and the timing figures
// on the device page.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "base/clock.h"
#include "base/error.h"
#include "daemon/common/watchdog.h"
#include "daemon/deviced/loop.h"
#include "daemon/deviced/realtime/realtime.h"

namespace prismesh::deviced {

/// Returns when the next tick is due after one that was due at `due_ns` and ended at `ended_ns`. Skips missed periods: after a stall the
/// devices must not receive many ticks at once.
std::int64_t next_due_ns(std::int64_t due_ns, std::int64_t ended_ns);

class LoopThread {
 public:
  /// Starts ticking. `memory_locked` and `simulated` are published as health. Errors: no thread can be created.
  static Result<std::unique_ptr<LoopThread>> start(DeviceLoop& loop, ipc::DevicePage& page, bool memory_locked, bool simulated);
  /// Winds the loop down, which switches the motor's torque off, and ends the thread.
  ~LoopThread();
  LoopThread(const LoopThread&) = delete;
  LoopThread& operator=(const LoopThread&) = delete;

  /// Why SCHED_FIFO was refused and what would help; empty if it was granted.
  const std::string& refused() const { return thread_.refused; }
  /// Beats at each completed tick.
  const daemon::Heartbeat& heartbeat() const { return heartbeat_; }

 private:
  LoopThread(DeviceLoop& loop, ipc::DevicePage& page) : loop_(loop), page_(page) {}
  static void* enter(void* self);
  void run();
  void record_timing(std::int64_t due_ns, std::int64_t began_ns, std::int64_t cpu_ns);

  DeviceLoop& loop_;
  ipc::DevicePage& page_;
  MonotonicClock clock_;
  ipc::DeviceHealth health_;
  std::array<std::int64_t, 256> costs_{};
  bool running_ = false;
  std::atomic<bool> stop_ = false;
  daemon::Heartbeat heartbeat_;
  StartedThread thread_;
};

}  // namespace prismesh::deviced
