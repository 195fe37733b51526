// Ends a daemon that hangs, so that its supervisor restarts it. Acknowledged edits are on disk. A daemon hangs when its loop serves no
// client, or when the work under way shows no progress.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace prismesh::daemon {

/// Heartbeats of one thread. May be read from any thread.
class Heartbeat {
 public:
  /// Between `begin` and `end` the thread must call `beat` regularly.
  void begin() { count_.fetch_add(1, std::memory_order_relaxed); }
  void beat() { count_.fetch_add(2, std::memory_order_relaxed); }
  void end() { count_.fetch_add(1, std::memory_order_relaxed); }

  std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> count_ = 0;  ///< odd: beats are expected
};

/// Counts the periods for which a heartbeat has been missing. Counts periods instead of time, so that a stopped process or a machine that
/// slept isn't taken for a hang.
class HeartbeatMonitor {
 public:
  /// `fault` says what it means when the heartbeat is missing for `max_periods`.
  HeartbeatMonitor(std::string fault, const Heartbeat& heartbeat, int max_periods)
      : fault_(std::move(fault)), heartbeat_(heartbeat), max_periods_(max_periods) {}

  /// Called once a period. Returns true when the heartbeat has been missing for `max_periods` or more.
  bool is_hung();
  const std::string& fault() const { return fault_; }

 private:
  std::string fault_;
  const Heartbeat& heartbeat_;
  int max_periods_;
  int missing_ = 0;
  std::uint64_t last_ = 0;
};

/// Checks heartbeats once a period, in a thread of its own.
class Watchdog {
 public:
  /// `on_hang` is called once, in the watchdog's thread, with the monitor's fault.
  Watchdog(std::vector<HeartbeatMonitor> watched, std::chrono::milliseconds period, std::function<void(const std::string& fault)> on_hang);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

 private:
  void watch();

  std::vector<HeartbeatMonitor> watched_;
  std::chrono::milliseconds period_;
  std::function<void(const std::string&)> on_hang_;
  std::mutex mutex_;
  std::condition_variable ending_;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace prismesh::daemon
