// One thread for work that takes time: jobs in order, one after the other.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

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

 private:
  void serve();

  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void()>> jobs_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace prismesh::modeld
