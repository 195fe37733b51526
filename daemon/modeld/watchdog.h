// Ends a daemon that hangs, so that whoever keeps it starts it anew; nothing acknowledged is lost by that. A daemon hangs when its loop
// serves no client any more, or the work under way, which journals edits, shows no progress.
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

namespace prismesh::modeld {

/// Signs of life of one thread. From any thread.
class Pulse {
 public:
  /// From `begin` to `end` there must be a sign now and then.
  void begin() { count_.fetch_add(1, std::memory_order_relaxed); }
  void sign() { count_.fetch_add(2, std::memory_order_relaxed); }
  void end() { count_.fetch_add(1, std::memory_order_relaxed); }

  std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> count_ = 0;  ///< odd: signs are expected
};

/// Counts the beats for which a pulse has been silent. Beats instead of time: a process that was stopped, or a machine that slept, isn't
/// hung.
class Silence {
 public:
  Silence(std::string what, const Pulse& pulse, int max_beats) : what_(std::move(what)), pulse_(pulse), max_beats_(max_beats) {}

  /// A beat has passed. True: there were no signs for as many as there may be.
  bool beat();
  const std::string& what() const { return what_; }

 private:
  std::string what_;
  const Pulse& pulse_;
  int max_beats_;
  int silent_ = 0;
  std::uint64_t last_ = 0;
};

/// A thread of its own that looks at pulses once a beat.
class Watchdog {
 public:
  /// `on_hang` is called once, in the watchdog's thread, with what is silent.
  Watchdog(std::vector<Silence> watched, std::chrono::milliseconds beat, std::function<void(const std::string& what)> on_hang);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

 private:
  void watch();

  std::vector<Silence> watched_;
  std::chrono::milliseconds beat_;
  std::function<void(const std::string&)> on_hang_;
  std::mutex mutex_;
  std::condition_variable ending_;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace prismesh::modeld
