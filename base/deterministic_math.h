// Transcendental functions that give the same bits on every processor. The C library's choose between variants with and
// without fused multiply-add at run time, so their last bit may differ from one machine to the next; whatever moves a node
// or decides what is selected uses these. Errors are a few units in the last place.
#pragma once

namespace prismesh {

/// e^x; 0 below -745, infinity above 709.78.
double deterministic_exp(double x);

/// Sine and cosine of an angle in degrees; exact at multiples of 90. Precondition: |degrees| < 1e9.
double deterministic_sin_degrees(double degrees);
double deterministic_cos_degrees(double degrees);

/// Angle of the vector (x, y) in radians, -pi..pi; 0 for the zero vector.
double deterministic_atan2(double y, double x);

/// Arc cosine in radians; arguments beyond -1..1 count as the nearer end.
double deterministic_acos(double x);

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kDegreesPerRadian = 180.0 / kPi;

}  // namespace prismesh
