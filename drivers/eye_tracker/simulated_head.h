// The input and the interface of simulated trackers.
#pragma once

#include <cstdint>
#include <functional>

#include <Eigen/Core>

namespace prismesh::drivers::eye_tracker {

/// The true state of the head at a time.
struct SimulatedHead {
  Eigen::Vector3d between_eyes_mm{0, 0, 650};
  Eigen::Vector3d toward_right = Eigen::Vector3d::UnitX();
  bool visible = true;  ///< false: no head is there
};

/// Returns the head at a time in seconds since the simulator's start. Calls may come in any order.
using HeadSource = std::function<SimulatedHead(double seconds)>;

/// The device's side of a tracker; the caller passes the time.
class TrackerSimulator {
 public:
  virtual ~TrackerSimulator() = default;
  /// Executes received commands and sends what is due until `now_ns`. The first call is the start of the simulator's time.
  virtual void run_until(std::int64_t now_ns) = 0;
};

}  // namespace prismesh::drivers::eye_tracker
