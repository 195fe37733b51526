#include <algorithm>
#include <array>
#include <cmath>

#include "base/deterministic_math.h"
#include "mesh/shape/weights.h"

namespace prismesh::mesh::shape {

namespace {

constexpr std::array<std::string_view, 8> kNames{"constant", "linear", "smooth", "sharp", "root", "sphere", "inverse_square", "gaussian"};

/// A Gaussian with three standard deviations between origin and border, shifted and scaled so that it is exactly 0 at the border.
double gaussian(double d) {
  constexpr double kExponentAtBorder = -4.5;
  const double from_origin = 1 - d;
  const double at_border = deterministic_exp(kExponentAtBorder);
  return (deterministic_exp(kExponentAtBorder * from_origin * from_origin) - at_border) / (1 - at_border);
}

}  // namespace

std::string_view name(Profile profile) { return kNames[static_cast<std::size_t>(profile)]; }

std::optional<Profile> profile_from(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<Profile>(found - kNames.begin());
}

double evaluate(const Falloff& falloff, double d) {
  d = d > 0 ? std::min(d, 1.0) : 0.0;  // NaN counts as the border
  if (falloff.flat > 0 && d > 0) d = falloff.flat < 1 ? std::min(1.0, d / (1 - falloff.flat)) : 1.0;
  switch (falloff.profile) {
    case Profile::constant: return 1;
    case Profile::linear: return d;
    case Profile::smooth: return d * d * (3 - 2 * d);
    case Profile::sharp: return d * d;
    case Profile::root: return std::sqrt(d);
    case Profile::sphere: return std::sqrt(d * (2 - d));
    case Profile::inverse_square: return d * (2 - d);
    case Profile::gaussian: return gaussian(d);
  }
  return d;
}

}  // namespace prismesh::mesh::shape
