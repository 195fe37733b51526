// One thread for work that takes time: jobs in order, one after the other.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

#include "daemon/modeld/watchdog.h"

namespace prismesh::modeld {

class Worker {
 public:
  Worker();
  /// Asks the job under way to stop, lets it end, and drops the rest.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void run(std::function<void()> job);
  /// Whether long jobs should stop now.
  bool stopping() const { return stopping_; }
  /// Signs are expected while a job is under way; jobs give them by `show_progress`.
  const Pulse& pulse() const { return pulse_; }
  void show_progress() { pulse_.sign(); }

 private:
  void serve();

  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void()>> jobs_;
  std::atomic<bool> stopping_ = false;
  Pulse pulse_;
  std::thread thread_;
};

}  // namespace prismesh::modeld
