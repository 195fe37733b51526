#include "base/tasks.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace prismesh {

namespace {

/// How the threads of some tasks tell the waiting one what happened.
class TaskSignals {
 public:
  explicit TaskSignals(std::size_t threads) : running_(threads) {}

  void wake() {
    {
      const std::scoped_lock lock(mutex_);
      is_woken_ = true;
    }
    changed_.notify_one();
  }
  void thread_ended() {
    {
      const std::scoped_lock lock(mutex_);
      --running_;
    }
    changed_.notify_one();
  }
  /// Calls `watch` after wakes, until all threads have ended.
  void wait(const std::function<void()>& watch) {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [&] { return is_woken_ || running_ == 0; });
      if (!is_woken_) return;
      is_woken_ = false;
      lock.unlock();
      watch();
      lock.lock();
    }
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t running_;
  bool is_woken_ = false;
};

}  // namespace

void run_tasks(std::size_t count, std::size_t max_threads,
               const std::function<void(std::size_t task, const std::function<void()>& wake)>& task, const std::function<void()>& watch) {
  if (max_threads == 0) max_threads = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t threads = std::min(count, max_threads);
  if (threads <= 1) {
    for (std::size_t i = 0; i < count; ++i) task(i, watch);
    return;
  }
  std::vector<std::exception_ptr> thrown(count);
  std::atomic<std::size_t> next{0};
  TaskSignals signals(threads);
  {
    const std::function<void()> wake = [&] { signals.wake(); };
    std::vector<std::jthread> running;
    for (std::size_t thread = 0; thread < threads; ++thread)
      running.emplace_back([&] {
        for (std::size_t i = next++; i < count; i = next++) try {
            task(i, wake);
          } catch (...) {
            thrown[i] = std::current_exception();
          }
        signals.thread_ended();
      });
    signals.wait(watch);
  }
  for (const std::exception_ptr& exception : thrown)
    if (exception) std::rethrow_exception(exception);
}

}  // namespace prismesh
