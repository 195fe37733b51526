// The safety of the haptic loop: turns the parts of a force into the force that may be sent, or zero. Pure: time is passed in; no ports, no
// allocation, no log.
//
// Order: finite check, faded sum of the parts, slew limit on rises, clamp of the vector's length, energy tank, motor limits. Every stage
// after the sum only shortens the vector or limits its rise, so a later stage never undoes an earlier one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "drivers/haptics/limits.h"

namespace prismesh::drivers::haptics {

enum class SafetyPhase : std::uint32_t {
  disarmed,  ///< zero force until the user arms
  armed,
  latched,  ///< zero force after a fault, until the user arms again
};

enum class SafetyFault : std::uint32_t {
  none,
  not_finite,  ///< NaN or infinity in pose or force
  jump,        ///< two poses too far apart
  too_fast,    ///< the pen moves faster than allowed
  io_error,    ///< the line to the device
  lost_reply,  ///< a request was never answered
  no_pose,     ///< no newer pose for too long
  pose_time,   ///< a pose from the future, or older than the one before
  late_tick,   ///< the loop stood still
  clock,       ///< time went back
  died_armed,  ///< the program ended while armed
};

/// What outlives the program: the caller stores it whenever a tick changes it, and gives it back at the next start.
struct SafetyRecord {
  SafetyPhase phase = SafetyPhase::disarmed;
  SafetyFault fault = SafetyFault::none;
  std::int64_t since_ns = 0;
  bool operator==(const SafetyRecord&) const = default;
};

/// One of the forces that are summed.
struct ForcePart {
  Eigen::Vector3d newton = Eigen::Vector3d::Zero();
  std::int64_t from_ns = 0;  ///< when its data was true; it fades with age. 0: it doesn't age
  bool damping = false;      ///< opposes the pen's motion: the only kind that a late tick keeps
};

struct SafetyInput {
  std::int64_t now_ns = 0;
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();  ///< the newest pose, also if it isn't new
  std::int64_t measured_ns = 0;                           ///< its time; the same as before: not new. 0: never
  bool ready = false;                                     ///< the device accepts forces
  bool io_error = false;
  std::uint32_t lost_replies = 0;    ///< since the last tick
  std::span<const ForcePart> parts;  ///< damping included
  bool rearm = false;                ///< the user arms: counts where it was false in the tick before
};

struct SafetyOutput {
  Eigen::Vector3d newton = Eigen::Vector3d::Zero();
  std::int64_t valid_until_ns = 0;  ///< the holder of the line sends zero after this
  SafetyRecord record;
  bool record_changed = false;  ///< store it
  bool damping_only = false;    ///< a late tick, or an old pose
  bool tank_limited = false;    ///< the energy tank has shortened the force
  bool rearm_refused = false;   ///< the pen touches something, isn't ready, or there is a fault
  double speed_mm_s = 0;
  double tank_joule = 0;  ///< what may be put into the hand at present
};

class Safety {
 public:
  /// Starts disarmed; latched if the record says so, or says that the program ended while it was armed.
  explicit Safety(const HapticLimits& limits, const Eigen::Vector3d& max_axis_newton, const SafetyRecord& stored = {});
  SafetyOutput step(const SafetyInput& input);
  const SafetyRecord& record() const { return record_; }

 private:
  struct Pose {
    std::int64_t measured_ns = 0;
    Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
  };

  SafetyFault find_fault(const SafetyInput& input, std::int64_t passed_ns);
  SafetyFault take_pose(const SafetyInput& input);
  void account(const Eigen::Vector3d& moved_mm);
  double speed_mm_s() const;
  double max_way_mm(std::int64_t until_ns) const;
  Eigen::Vector3d faded_sum(const SafetyInput& input, bool damping_only) const;
  Eigen::Vector3d limit_rise(const Eigen::Vector3d& newton, std::int64_t passed_ns) const;
  double max_length(std::int64_t now_ns) const;
  double tank_length(std::int64_t valid_until_ns) const;
  void try_to_arm(const SafetyInput& input, SafetyOutput& output);
  void enter(SafetyPhase phase, SafetyFault fault, std::int64_t now_ns);

  HapticLimits limits_;
  Eigen::Vector3d max_axis_newton_;
  SafetyRecord record_;
  bool record_changed_ = false;
  bool started_ = false;
  bool lapsed_ = false;       ///< the last command has ended before this tick
  bool rearm_before_ = true;  ///< so that a button that is held at the start doesn't arm
  std::int64_t last_ns_ = 0;
  Eigen::Vector3d sent_newton_ = Eigen::Vector3d::Zero();
  /// Of the forces that were sent since the newest pose: the work that a motion takes is that of the worst of them.
  std::array<Eigen::Vector3d, 16> since_pose_{};
  std::size_t since_pose_count_ = 0;
  std::array<Pose, 32> poses_{};  ///< a ring
  std::size_t pose_count_ = 0, newest_pose_ = 0;
  double allowance_joule_ = 0;  ///< burst, refilled steadily
  double credit_joule_ = 0;     ///< of the hand's own work
};

}  // namespace prismesh::drivers::haptics
