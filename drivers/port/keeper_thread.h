// The thread beside the real-time loop that opens and closes its devices' ports.
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

/// What the thread needs of a keeper, whichever port it keeps. `work` and `hurry` are as in BasicKeeper; `on_give_back` may be called
/// before the real-time side starts only.
struct KeeperWork {
  std::function<std::int64_t()> work;
  std::function<void()> hurry;
  std::function<void(void (*)(void*), void*)> on_give_back;
  std::string path;
};

template <class Port>
KeeperWork work_of(BasicKeeper<Port>& keeper) {
  return {[&keeper] { return keeper.work(); }, [&keeper] { keeper.hurry(); },
          [&keeper](void (*call)(void*), void* with) { keeper.on_give_back(call, with); }, keeper.path()};
}

/// Drives keepers on a thread of its own until it's destroyed: at their times, at once when a port comes back, and at once when a device's
/// file appears or changes (inotify on its folder, or on the nearest folder above that exists). Start it before the real-time loop and
/// destroy it after the loop has ended; the keepers outlive both. `clock` is the keepers' own and runs by itself (CLOCK_MONOTONIC).
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
  int event_ = -1;  // an eventfd: writing to it never blocks, so the real-time side may
  std::jthread thread_;
};

}  // namespace prismesh::drivers::port
