// What every eye tracker gives, whatever its bytes: where the head is and since when that is known. A tracker is polled from the
// device loop: `poll` never blocks, allocates or logs.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include <Eigen/Core>

#include "drivers/port/byte_port.h"

namespace prismesh::drivers::eye_tracker {

/// One measurement. Millimetres from the screen's centre, x to the right, y up, z toward the viewer.
struct HeadSample {
  std::int64_t measured_ns = 0;  ///< CLOCK_MONOTONIC when the head was there: arrival less the tracker's latency
  Eigen::Vector3d between_eyes_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d toward_right = Eigen::Vector3d::UnitX();  ///< from the left eye to the right one; unit length
  bool doubtful = false;                                    ///< the device marks it so (coast, caution)
};

/// What happened on the line, counted since the port was opened.
struct LineCounts {
  std::uint64_t records = 0;        ///< whole records taken
  std::uint64_t without_head = 0;   ///< of these: the device looks for a head
  std::uint64_t bytes_skipped = 0;  ///< bytes that belong to no record: noise, or before synchronisation
  std::uint64_t resyncs = 0;        ///< times that synchronisation was lost
  std::uint64_t rejected = 0;       ///< records with a head where no viewer can be, or jumping there and back
  std::uint64_t restarts = 0;       ///< times that the talk with a silent device was begun anew
};

class EyeTracker {
 public:
  virtual ~EyeTracker() = default;
  /// `fresh`: the newest sample since the last call. Status `gone`: the port is of no more use; a new tracker needs a new port.
  struct Polled {
    bool fresh = false;
    HeadSample sample;
    port::PortStatus status = port::PortStatus::ok;
  };
  /// Reads what has come and keeps the talk going.
  virtual Polled poll(std::int64_t now_ns) = 0;
  /// The device speaks sense (is synchronised), whether or not it sees a head.
  virtual bool synchronised() const = 0;
  virtual const LineCounts& counts() const = 0;
};

}  // namespace prismesh::drivers::eye_tracker
