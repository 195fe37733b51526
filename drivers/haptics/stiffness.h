// The stiffness up to which a device stays passive.
#pragma once

#include <cstdint>

#include "drivers/haptic_pen/pen.h"

namespace prismesh::drivers::haptics {

/// Returns the smaller of two bounds in N/m, and of the maker's figure if there is one:
/// - b / (T / 2 + delay), so that the delay of sampling and holding gives less energy than the device's own damping b takes [Colgate 1997]
/// - 2 f / quantum, so that a step of the position gives less energy than the device's own friction f takes [Abbott 2005]
/// `delay_ns` is the device's delay beside the period T. A device without damping or friction has the bound 0: what isn't known isn't felt.
double max_stiffness_newton_m(const haptic_pen::PenLimits& device, std::int64_t period_ns);

}  // namespace prismesh::drivers::haptics
