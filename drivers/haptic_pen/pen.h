// The interface of haptic pens: pose and buttons in, force out, and what the device can do. The haptic loop calls it once per tick; no call
// blocks, allocates or logs.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace prismesh::drivers::haptic_pen {

/// A measurement. Millimetres from the middle of the device's workspace, x to the right, y up, z toward the user.
struct PenPose {
  std::int64_t measured_ns = 0;  ///< CLOCK_MONOTONIC; 0: never
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
  bool has_orientation = false;  ///< devices of three degrees of freedom have none
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

enum class PenPhase : std::uint8_t {
  absent,      ///< no device
  setting_up,  ///< starts, or waits for firmware
  homing,      ///< the user has to move it to its stops
  ready,       ///< poses are valid and forces are accepted
};

/// Why there is no valid answer.
enum class PenTrouble : std::uint8_t {
  none,
  no_answer,
  io_error,   ///< unplugged, or the line refuses reads or writes: a new connection needs a new pen
  bad_reply,  ///< an answer that can't be decoded
  refused,    ///< the device refuses its set-up
};

/// What arrived since the last call.
struct PenReading {
  PenPhase phase = PenPhase::absent;
  PenTrouble trouble = PenTrouble::none;
  bool fresh = false;              ///< `pose` is new
  std::uint32_t replies = 0;       ///< answers in this call: 2 and more are merged, and the newest pose counts
  std::uint32_t lost_replies = 0;  ///< requests of which the device can't answer any more
  PenPose pose;
  std::uint32_t buttons = 0;  ///< a bit each
};

/// A force, and until when it may be applied: whoever holds the line sends zero afterwards if no newer command has come.
struct PenCommand {
  Eigen::Vector3d newton = Eigen::Vector3d::Zero();
  std::int64_t valid_until_ns = 0;
  Eigen::Vector3d newton_metre = Eigen::Vector3d::Zero();  ///< a torque; devices of three degrees out ignore it
};

/// What the device can do; its maker's figures, or measured.
struct PenLimits {
  double max_newton = 0;                                      ///< length of the force
  Eigen::Vector3d max_axis_newton = Eigen::Vector3d::Zero();  ///< in each direction
  double max_stiffness_newton_m = 0;                          ///< the maker's figure
  double damping_newton_s_m = 0;                              ///< its own viscous damping
  double friction_newton = 0;                                 ///< its own Coulomb friction
  double quantum_mm = 0;                                      ///< resolution of the position
  std::int64_t delay_ns = 0;  ///< from the measured position to the force that answers it, without the period
  Eigen::Vector3d workspace_min_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d workspace_max_mm = Eigen::Vector3d::Zero();
  int degrees_in = 3;           ///< 3: the place; 6: the orientation too, where a grip that measures it is there
  int degrees_out = 3;          ///< 3: a force; 6: a torque too
  double max_newton_metre = 0;  ///< length of the torque
};

class HapticPen {
 public:
  virtual ~HapticPen() = default;
  /// Reads the answers that have arrived.
  virtual PenReading read(std::int64_t now_ns) = 0;
  /// Sends a force and asks for the next pose. A refusal is reported by the next `read`.
  virtual void send(std::int64_t now_ns, const PenCommand& command) = 0;
  virtual const PenLimits& limits() const = 0;

  // Called by the thread that opened the line, too.
  /// The line can't be used again.
  virtual bool gone() const = 0;
  /// The line takes nothing any more, though it isn't gone: whoever guards it has to send the zero. For the loop's thread.
  virtual bool is_stuck(std::int64_t /*now_ns*/) { return false; }
  /// What the user has to know or to do until the device is ready; empty: it is ready.
  virtual std::string advice() const { return {}; }
  /// Time from the newest answered force to the pose that answers it; 0: none yet. For the loop's thread.
  virtual std::int64_t round_trip_ns() const { return 0; }
};

}  // namespace prismesh::drivers::haptic_pen
