// From the cap's deflection to a speed: a dead zone about rest, then a curve.
#pragma once

#include <array>

#include "drivers/space_mouse/report.h"

namespace prismesh::drivers::space_mouse {

struct SpaceMouseResponse {
  double dead_zone = 0.06;     ///< share of the full deflection, 0 to 0.9: below it the cap counts as at rest
  double exponent = 2;         ///< 1 to 4: of the rest of the way; 1 is straight
  bool dominant_axis = false;  ///< only the axis that is deflected most
};

/// Each from -1 to 1. Continuous: it begins with 0 at the edge of the dead zone and ends with 1 at full deflection.
struct SpaceMouseMotion {
  std::array<double, 3> shift{};
  std::array<double, 3> turn{};
  bool at_rest() const;
};

SpaceMouseMotion motion_of(const SpaceMouseState& state, const SpaceMouseResponse& response);

}  // namespace prismesh::drivers::space_mouse
