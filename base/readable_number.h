// Measured numbers in sentences and on panels, as people write them.
#pragma once

#include <array>
#include <string>

namespace prismesh {

/// At most `digits` significant digits (1 to 15) and no power of ten: "0.0000125", "1234568". Only from 1e12 on and below 1e-9 one:
/// "1.25e-10". Never "-0".
std::string readable(double value, int digits);

/// Three numbers of one kind, divided by spaces: the largest with so many digits, the others to the same decimal. What is nothing beside
/// the largest is 0: "1250.5 0 -3.2".
std::string readable(const std::array<double, 3>& values, int digits);

}  // namespace prismesh
