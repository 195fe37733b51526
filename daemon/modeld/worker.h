// A thread that runs jobs in order, one at a time.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

#include "daemon/common/watchdog.h"

namespace prismesh::modeld {

class Worker {
 public:
  Worker();
  /// Asks the job under way to stop, waits for its end, and drops the rest.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void run(std::function<void()> job);
  /// Whether the job under way should stop.
  bool stopping() const { return stopping_; }
  /// Beats are expected while a job is under way; jobs give them by `show_progress`.
  const daemon::Heartbeat& heartbeat() const { return heartbeat_; }
  void show_progress() { heartbeat_.beat(); }

 private:
  void serve();

  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void()>> jobs_;
  std::atomic<bool> stopping_ = false;
  daemon::Heartbeat heartbeat_;
  std::thread thread_;
};

}  // namespace prismesh::modeld
