// The interface of all eye trackers: reports the head's position and its time. The device loop polls a tracker; `poll` doesn't block,
// allocate or log.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include <Eigen/Core>

#include "drivers/port/byte_port.h"

namespace prismesh::drivers::eye_tracker {

/// One measurement. Millimetres from the screen's centre, x to the right, y up, z toward the viewer.
struct HeadSample {
  std::int64_t measured_ns = 0;  ///< CLOCK_MONOTONIC of the head's position: arrival minus the tracker's latency
  Eigen::Vector3d between_eyes_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d toward_right = Eigen::Vector3d::UnitX();  ///< unit vector from the left eye to the right one
  bool doubtful = false;                                    ///< the device marks it as uncertain (coast, caution)
};

/// Counts of events on the line since the port was opened.
struct LineCounts {
  std::uint64_t records = 0;        ///< complete records
  std::uint64_t without_head = 0;   ///< of these: records without a head (the device is searching)
  std::uint64_t bytes_skipped = 0;  ///< bytes outside records: noise, or before synchronisation
  std::uint64_t resyncs = 0;        ///< losses of synchronisation
  std::uint64_t rejected = 0;       ///< records with a head at an impossible position, or with a single jump
  std::uint64_t restarts = 0;       ///< restarts of the dialogue with a silent device
};

class EyeTracker {
 public:
  virtual ~EyeTracker() = default;
  /// `fresh`: `sample` is new since the last call. Status `gone`: the port can't be used again; a new port needs a new tracker.
  struct Polled {
    bool fresh = false;
    HeadSample sample;
    port::PortStatus status = port::PortStatus::ok;
  };
  /// Reads the received bytes and continues the dialogue.
  virtual Polled poll(std::int64_t now_ns) = 0;
  /// Returns whether the device's records are being decoded, with or without a head.
  virtual bool synchronised() const = 0;
  virtual const LineCounts& counts() const = 0;
};

}  // namespace prismesh::drivers::eye_tracker
