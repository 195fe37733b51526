// Reports the progress of opening a deck, and stops the work when told to.
#pragma once

#include <atomic>
#include <thread>

#include "base/progress.h"

namespace prismesh::mesh::deck {

/// Reports from the thread that made it only: `tell` may be called from any thread. Remembers that the receiver wants to stop.
class Watch {
 public:
  explicit Watch(const Progress& progress) : progress_(progress), thread_(std::this_thread::get_id()) {}
  void tell(double fraction) {
    if (progress_ && std::this_thread::get_id() == thread_ && !progress_(fraction)) stopped_ = true;
  }
  bool stopped() const { return stopped_; }

 private:
  const Progress& progress_;
  std::thread::id thread_;
  std::atomic<bool> stopped_ = false;
};

// The progress at the end of each phase of opening, about its share of the time.
inline constexpr double kWalked = 0.2;
inline constexpr double kRead = 0.6;
inline constexpr double kAssembled = 0.75;

}  // namespace prismesh::mesh::deck
