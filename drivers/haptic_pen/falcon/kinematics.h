// Where the Falcon's grip is for given angles of its three arms, and which torques of the arms make a force there. A delta mechanism
// [Stamper 1997]; the lengths are those of libnifalcon (FalconGeometry.h, BSD). In metres and radians, x right, y up, z from the body
// toward the user. Allocates nothing.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

namespace prismesh::drivers::haptic_pen::falcon {

/// An arm's angle for its encoder's count, once it is homed: 1,280 counts a turn of the motor, whose shaft of 14.25 mm drives a wheel of
/// 110 mm; 35 degrees at 0.
double angle_of_count(double count);
double count_of_angle(double angle);

/// The middle of the workspace: 110 mm from the body, as libnifalcon's examples have it.
inline const Eigen::Vector3d kMiddle{0, 0, 0.110};

/// The angles at which the grip is at a position; nothing if it is out of reach.
std::optional<Eigen::Vector3d> inverse_kinematics(const Eigen::Vector3d& position);

struct GripPlace {
  Eigen::Vector3d position = kMiddle;
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();  ///< d position / d angles
};

/// The place for given angles. Searches from `near`, the last place, then from the middle: the mechanism has a second one, which it can't
/// get to. Nothing if no place fits (angles that the mechanism can't have), or near a singular pose.
std::optional<GripPlace> forward_kinematics(const Eigen::Vector3d& angles, const Eigen::Vector3d& near = kMiddle);

/// Torques of the arms (N m) that make a force (N) at the grip, by the transposed Jacobian.
Eigen::Vector3d torques(const GripPlace& place, const Eigen::Vector3d& force);

}  // namespace prismesh::drivers::haptic_pen::falcon
