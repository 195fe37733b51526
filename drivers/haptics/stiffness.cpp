#include "drivers/haptics/stiffness.h"

#include <algorithm>
#include <cmath>

namespace prismesh::drivers::haptics {

double max_stiffness_newton_m(const haptic_pen::PenLimits& device, std::int64_t period_ns) {
  const double seconds = (static_cast<double>(period_ns) / 2 + static_cast<double>(device.delay_ns)) * 1e-9;
  if (!(seconds > 0) || !(device.damping_newton_s_m > 0) || !(device.friction_newton > 0)) return 0;
  double bound = device.damping_newton_s_m / seconds;
  if (device.quantum_mm > 0) bound = std::min(bound, 2 * device.friction_newton / (device.quantum_mm * 1e-3));
  if (device.max_stiffness_newton_m > 0) bound = std::min(bound, device.max_stiffness_newton_m);
  return std::isfinite(bound) ? bound : 0;
}

}  // namespace prismesh::drivers::haptics
