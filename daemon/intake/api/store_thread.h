// The thread that the store belongs to: jobs run in order, one at a time, so that slow disks hold no connection up.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

#include "daemon/intake/store/store.h"

namespace prismesh::intake {

class StoreThread {
 public:
  explicit StoreThread(Store store);
  ~StoreThread() { end(); }
  StoreThread(const StoreThread&) = delete;
  StoreThread& operator=(const StoreThread&) = delete;

  /// Waits for the job under way and drops the rest; later jobs are dropped too.
  void end();
  /// May be called from any thread.
  void run(std::function<void(Store&)> job);

 private:
  void serve();

  Store store_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void(Store&)>> jobs_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace prismesh::intake
