#include "drivers/haptic_pen/falcon/kinematics.h"

#include <cmath>
#include <numbers>

#include <Eigen/LU>

namespace prismesh::drivers::haptic_pen::falcon {
namespace {

constexpr double kThigh = 0.060, kShin = 0.1025;
constexpr double kJoint = 2 * 0.01125;  ///< from knee to shin, and from shin to grip
constexpr double kGripU = 0.01443, kGripV = -0.025;
constexpr double kBaseU = 0.0400, kBaseV = -0.02309;
constexpr double kRadPerCount = 2 * std::numbers::pi * 0.01425 / (320 * 4 * 0.110);
constexpr double kAngleAtZero = 35 * std::numbers::pi / 180;
/// Directions of the arms: top, right, left, all turned by 15 degrees.
constexpr std::array<double, 3> kDirections{std::numbers::pi * 7 / 12, -std::numbers::pi / 12, -std::numbers::pi * 3 / 4};

constexpr int kMaxSteps = 20;
constexpr double kFarEnough = 1e-10;
/// Least sine between shin and the plane in which it swings; and least determinant of the scaled gradients.
constexpr double kLeastSine = 0.05, kLeastDeterminant = 0.02;

/// An arm: its knee turns in the plane (u, w); the shin, a parallelogram, ends at the grip.
struct Arm {
  Eigen::Vector3d at;    ///< the grip's joint: u away from the axis, v across, w along the axis
  double shin = 0;       ///< length of the shin's projection into the plane, joints included; not positive: out of reach
  double shin_rise = 0;  ///< what `shin` is without the joints
};

Arm arm_at(const Eigen::Vector3d& position, std::size_t which) {
  const double c = std::cos(kDirections[which]), s = std::sin(kDirections[which]);
  Arm arm;
  arm.at = {c * position.x() + s * position.y() - kBaseU + kGripU, -s * position.x() + c * position.y() - kBaseV + kGripV, position.z()};
  const double rest = kShin * kShin - arm.at.y() * arm.at.y();
  if (rest <= kShin * kShin * kLeastSine * kLeastSine) return arm;
  arm.shin_rise = std::sqrt(rest);
  arm.shin = arm.shin_rise + kJoint;
  return arm;
}

std::optional<GripPlace> search_place(const Eigen::Vector3d& angles, const Eigen::Vector3d& near) {
  GripPlace place;
  place.position = near;
  for (int step = 0; step < kMaxSteps; ++step) {
    // Newton's method on: the knee is one shin from the grip's joint, for all arms.
    Eigen::Matrix3d gradients;
    Eigen::Vector3d misfits, by_angle;
    for (std::size_t which = 0; which < 3; ++which) {
      const auto row = static_cast<Eigen::Index>(which);
      const Arm arm = arm_at(place.position, which);
      if (!(arm.shin > 0)) return std::nullopt;
      const double c = std::cos(angles[row]), s = std::sin(angles[row]);
      const double du = arm.at.x() - kThigh * c, dw = arm.at.z() - kThigh * s;
      const double distance = std::hypot(du, dw);
      if (!(distance > 0)) return std::nullopt;
      misfits[row] = distance - arm.shin;
      // In the arm's own directions, then in ours.
      const Eigen::Vector3d own{du / distance, arm.at.y() / arm.shin_rise, dw / distance};
      const double dc = std::cos(kDirections[which]), ds = std::sin(kDirections[which]);
      gradients.row(row) << dc * own.x() - ds * own.y(), ds * own.x() + dc * own.y(), own.z();
      by_angle[row] = kThigh * (du * s - dw * c) / distance;
    }
    const double determinant = gradients.determinant();
    if (!(std::abs(determinant) > kLeastDeterminant)) return std::nullopt;
    const Eigen::Matrix3d inverse = gradients.inverse();
    place.position -= inverse * misfits;
    if (!place.position.allFinite()) return std::nullopt;
    if (misfits.norm() > kFarEnough) continue;
    place.jacobian = -inverse * by_angle.asDiagonal();
    // The other place for these angles has another knee.
    const auto back = inverse_kinematics(place.position);
    if (!back || (*back - angles).norm() > 1e-6) return std::nullopt;
    return place;
  }
  return std::nullopt;
}

}  // namespace

double angle_of_count(double count) { return kAngleAtZero + count * kRadPerCount; }
double count_of_angle(double angle) { return (angle - kAngleAtZero) / kRadPerCount; }

std::optional<Eigen::Vector3d> inverse_kinematics(const Eigen::Vector3d& position) {
  Eigen::Vector3d angles;
  for (std::size_t which = 0; which < 3; ++which) {
    const Arm arm = arm_at(position, which);
    const double u = arm.at.x(), w = arm.at.z(), reach = std::hypot(u, w);
    if (!(arm.shin > 0) || !(reach > 0)) return std::nullopt;
    // The knee is where a circle about the base meets one about the grip's joint: the outer of both places.
    const double cosine = (reach * reach + kThigh * kThigh - arm.shin * arm.shin) / (2 * kThigh * reach);
    if (!(std::abs(cosine) <= 1)) return std::nullopt;
    angles[static_cast<Eigen::Index>(which)] = std::atan2(w, u) - std::acos(cosine);
  }
  return angles;
}

std::optional<GripPlace> forward_kinematics(const Eigen::Vector3d& angles, const Eigen::Vector3d& near) {
  if (!angles.allFinite()) return std::nullopt;
  // A way across the whole workspace may lead out of reach; from the middle none does.
  const auto found = search_place(angles, near);
  return found || near == kMiddle ? found : search_place(angles, kMiddle);
}

Eigen::Vector3d torques(const GripPlace& place, const Eigen::Vector3d& force) { return place.jacobian.transpose() * force; }

}  // namespace prismesh::drivers::haptic_pen::falcon
