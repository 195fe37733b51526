#include "drivers/space_mouse/response.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace prismesh::drivers::space_mouse {
namespace {

double curve(int deflection, const SpaceMouseResponse& response) {
  const double share = std::min(1.0, std::abs(deflection) / static_cast<double>(kFullDeflection));
  const double dead = std::clamp(response.dead_zone, 0.0, 0.9);
  if (share <= dead) return 0;
  const double speed = std::pow((share - dead) / (1 - dead), std::clamp(response.exponent, 1.0, 4.0));
  return std::copysign(speed, deflection);
}

}  // namespace

bool SpaceMouseMotion::at_rest() const {
  const auto zero = [](double part) { return part == 0; };
  return std::all_of(shift.begin(), shift.end(), zero) && std::all_of(turn.begin(), turn.end(), zero);
}

SpaceMouseMotion motion_of(const SpaceMouseState& state, const SpaceMouseResponse& response) {
  int most = 0;
  for (const auto* axes : {&state.shift, &state.turn})
    for (const int each : *axes) most = std::max(most, std::abs(each));
  bool taken = false;
  const auto part = [&](int deflection) {
    if (response.dominant_axis && (taken || std::abs(deflection) != most)) return 0.0;
    taken = true;
    return curve(deflection, response);
  };
  SpaceMouseMotion motion;
  std::transform(state.shift.begin(), state.shift.end(), motion.shift.begin(), part);
  std::transform(state.turn.begin(), state.turn.end(), motion.turn.begin(), part);
  return motion;
}

}  // namespace prismesh::drivers::space_mouse
