// Writes measured numbers for sentences and panels, as people write them.
#pragma once

#include <array>
#include <string>

namespace prismesh {

/// At most `digits` significant digits (1 to 15), without an exponent: "0.0000125", "1234568". Only numbers from 1e12 and below 1e-9 have
/// one: "1.25e-10". Never "-0".
std::string readable(double value, int digits);

/// Three numbers of one kind, separated by spaces: the largest with `digits` significant digits, the others rounded to the same decimal:
/// "1250.5 0 -3.2".
std::string readable(const std::array<double, 3>& values, int digits);

}  // namespace prismesh
