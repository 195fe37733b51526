// Codec for opentrack's "UDP over network" output: 48 bytes, six little-endian doubles x, y, z in centimetres, then yaw, pitch, roll in
// degrees.
//
// The signs are those of its webcam tracker ("neuralnet") with a camera that doesn't mirror, and no axis inverted or remapped: x points to
// the viewer's left, y up, z away from the screen. Yaw is positive when the head turns to its right, pitch when it looks up, roll when it
// leans to its left. The order is yaw, then pitch, then roll. docs/devices/eye-tracker.md says how to set opentrack up.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include <Eigen/Core>

namespace prismesh::drivers::eye_tracker::opentrack {

inline constexpr std::size_t kDatagramBytes = 48;

struct Pose {
  Eigen::Vector3d position_cm = Eigen::Vector3d::Zero();  ///< in opentrack's axes
  double yaw_degrees = 0;
  double pitch_degrees = 0;
  double roll_degrees = 0;
  bool operator==(const Pose&) const = default;
};

/// Returns nothing if the length is wrong, a number isn't finite, or an angle is beyond a full turn.
std::optional<Pose> decode(std::span<const std::byte> datagram);
std::array<std::byte, kDatagramBytes> encode(const Pose& pose);

/// Returns the position in screen coordinates: millimetres, x right, y up, z toward the viewer.
Eigen::Vector3d screen_position_mm(const Pose& pose);
/// Returns the unit vector from the left eye to the right one, in screen coordinates.
Eigen::Vector3d toward_right(const Pose& pose);

/// Returns the pose for a position and a direction between the eyes, with zero pitch. `toward_right` points to the right (x > 0).
Pose pose_for(const Eigen::Vector3d& position_mm, const Eigen::Vector3d& toward_right);

}  // namespace prismesh::drivers::eye_tracker::opentrack
