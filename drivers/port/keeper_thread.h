// Runs the thread that opens and closes the devices' ports, outside the real-time loop.
#pragma once

#include <functional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "base/clock.h"
#include "drivers/port/file_watch.h"
#include "drivers/port/port_keeper.h"

namespace prismesh::drivers::port {

/// The calls of a keeper that the thread needs, for any type of port. `work` and `retry_now` are as in BasicKeeper; `on_give_back` may only
/// be called before the real-time side starts.
struct KeeperWork {
  std::function<std::int64_t()> work;
  std::function<void()> retry_now;
  std::function<void(void (*)(void*), void*)> on_give_back;
  std::string path;
};

template <class Port>
KeeperWork work_of(BasicKeeper<Port>& keeper) {
  return {[&keeper] { return keeper.work(); }, [&keeper] { keeper.retry_now(); },
          [&keeper](void (*call)(void*), void* with) { keeper.on_give_back(call, with); }, keeper.path()};
}

/// Runs keepers on a thread of its own until destroyed: when their `work` is due, when a port is given back, and when a device's file
/// appears or changes (inotify on its folder, or on the nearest existing folder above). Create it before the real-time loop starts and
/// destroy it after the loop has ended; the keepers must outlive both. `clock` must be the keepers' clock and advance by itself
/// (CLOCK_MONOTONIC).
class KeeperThread {
 public:
  KeeperThread(Clock& clock, std::vector<KeeperWork> keepers);
  ~KeeperThread();
  KeeperThread(const KeeperThread&) = delete;
  KeeperThread& operator=(const KeeperThread&) = delete;

 private:
  void run(const std::stop_token& stop);
  void wait_until(std::int64_t due_ns);
  void wake() const;

  Clock& clock_;
  std::vector<KeeperWork> keepers_;
  FileWatch watch_;
  int event_ = -1;  // an eventfd: writing to it never blocks, so the real-time side may write
  std::jthread thread_;
};

}  // namespace prismesh::drivers::port
