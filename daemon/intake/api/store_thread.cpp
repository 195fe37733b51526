#include "daemon/intake/api/store_thread.h"

#include <utility>

namespace prismesh::intake {

StoreThread::StoreThread(Store store) : store_(std::move(store)), thread_([this] { serve(); }) {}

void StoreThread::end() {
  std::deque<std::function<void(Store&)>> dropped;
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    dropped.swap(jobs_);
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void StoreThread::run(std::function<void(Store&)> job) {
  {
    const std::lock_guard lock(mutex_);
    if (ends_) return;
    jobs_.push_back(std::move(job));
  }
  wake_.notify_one();
}

void StoreThread::serve() {
  for (;;) {
    std::function<void(Store&)> job;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return ends_ || !jobs_.empty(); });
      if (ends_) return;
      job = std::move(jobs_.front());
      jobs_.pop_front();
    }
    job(store_);
  }
}

}  // namespace prismesh::intake
