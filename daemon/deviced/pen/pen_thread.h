// Runs the pen's loop in real time: 1 kHz at absolute times, and the timing figures on the pen's page.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "base/clock.h"
#include "daemon/common/watchdog.h"
#include "daemon/deviced/pen/pen_loop.h"
#include "daemon/deviced/realtime/realtime.h"

namespace prismesh::deviced::pen {

inline constexpr std::int64_t kPenPeriodNs = 1'000'000;

/// Returns when the next tick is due. Missed periods are skipped: the pen must not receive many forces at once.
std::int64_t next_pen_tick_ns(std::int64_t due_ns, std::int64_t ended_ns);

/// Times of the last thousand ticks in whole microseconds. Constant time for each.
class TimeTable {
 public:
  void add(std::int64_t ns);
  /// The time that `share` of them don't exceed, rounded up to a microsecond.
  std::int64_t share_ns(double share) const;
  std::uint32_t count() const { return count_; }
  void clear();

 private:
  static constexpr std::size_t kPlaces = 2048;
  std::array<std::uint32_t, kPlaces> places_{};  ///< the last one: longer than all
  std::uint32_t count_ = 0;
};

class PenThread {
 public:
  /// `health` holds what stays the same. Errors: no thread can be created.
  static Result<std::unique_ptr<PenThread>> start(PenLoop& loop, GuardPage& guard, ipc::PenPage& page, const ipc::PenHealth& health);
  /// Sends zero and ends the thread.
  ~PenThread();
  PenThread(const PenThread&) = delete;
  PenThread& operator=(const PenThread&) = delete;

  const std::string& refused() const { return thread_.refused; }
  const daemon::Heartbeat& heartbeat() const { return heartbeat_; }

 private:
  PenThread(PenLoop& loop, GuardPage& guard, ipc::PenPage& page) : loop_(loop), guard_(guard), page_(page) {}
  static void* enter(void* self);
  void run();
  void record_timing(std::int64_t due_ns, std::int64_t began_ns, std::int64_t cpu_ns);

  PenLoop& loop_;
  GuardPage& guard_;
  ipc::PenPage& page_;
  MonotonicClock clock_;
  ipc::PenHealth health_;
  TimeTable cpu_, late_;
  std::atomic<bool> stop_ = false;
  bool running_ = false;
  daemon::Heartbeat heartbeat_;
  StartedThread thread_;
};

}  // namespace prismesh::deviced::pen
