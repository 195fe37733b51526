#include "drivers/haptic_pen/device_limits.h"

#include <algorithm>
#include <cmath>

namespace prismesh::drivers::haptic_pen {
namespace {

Eigen::Vector3d no_longer_than(const Eigen::Vector3d& vector, double max_length) {
  if (!vector.allFinite()) return Eigen::Vector3d::Zero();
  const double length = vector.stableNorm();
  return length > max_length ? Eigen::Vector3d(vector * (max_length / length)) : vector;
}

}  // namespace

const DeviceFigures* figures_of(std::string_view driver) {
  const auto* found =
      std::find_if(kDeviceFigures.begin(), kDeviceFigures.end(), [&](const DeviceFigures& one) { return one.driver == driver; });
  return found == kDeviceFigures.end() ? nullptr : found;
}

PenLimits limits_of(const DeviceFigures& figures, double own_damping_newton_s_m, double own_friction_newton, std::int64_t delay_ns) {
  PenLimits limits;
  limits.max_newton = figures.max_newton;
  limits.max_axis_newton.setConstant(figures.max_newton);
  limits.max_stiffness_newton_m = figures.max_stiffness_newton_m;
  limits.damping_newton_s_m = own_damping_newton_s_m;
  limits.friction_newton = own_friction_newton;
  limits.quantum_mm = figures.quantum_mm;
  limits.delay_ns = delay_ns;
  limits.workspace_max_mm = 0.5 * Eigen::Map<const Eigen::Vector3d>(figures.workspace_mm.data());
  limits.workspace_min_mm = -limits.workspace_max_mm;
  limits.degrees_in = figures.degrees_in;
  limits.degrees_out = figures.degrees_out;
  return limits;
}

PenCommand within(const PenCommand& command, const PenLimits& limits) {
  PenCommand bounded = command;
  bounded.newton = no_longer_than(command.newton, limits.max_newton);
  bounded.newton_metre =
      limits.degrees_out == 6 ? no_longer_than(command.newton_metre, limits.max_newton_metre) : Eigen::Vector3d(Eigen::Vector3d::Zero());
  return bounded;
}

}  // namespace prismesh::drivers::haptic_pen
