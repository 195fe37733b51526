// What simulated trackers look at, and what plays them.
#pragma once

#include <cstdint>
#include <functional>

#include <Eigen/Core>

namespace prismesh::drivers::eye_tracker {

/// The true head at some time.
struct SimulatedHead {
  Eigen::Vector3d between_eyes_mm{0, 0, 650};
  Eigen::Vector3d toward_right = Eigen::Vector3d::UnitX();
  bool visible = true;  ///< false: nobody is there
};

/// The head at a time in seconds since the simulator's start; any order of calls.
using HeadSource = std::function<SimulatedHead(double seconds)>;

/// The device's side of a tracker, driven by whoever owns the time.
class TrackerSimulator {
 public:
  virtual ~TrackerSimulator() = default;
  /// Listens to what came and sends what is due until `now_ns`. The first call starts the simulator's own time.
  virtual void run_until(std::int64_t now_ns) = 0;
};

}  // namespace prismesh::drivers::eye_tracker
