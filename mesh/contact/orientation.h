// On which side of a plane or line a point lies, decided exactly.
#pragma once

#include <cstddef>

#include "mesh/model/model.h"

namespace prismesh::mesh::contact {

/// Coordinates up to this size are decided exactly. Differences below 1e-90 may underflow; no deck has them.
inline constexpr double kMaxExactCoordinate = 1e30;

/// Returns a number with the exact sign of ((b - a) x (c - a)) . (d - a): above 0 where d lies on the side from which a, b, c turn
/// counterclockwise, 0 where the four points lie in a plane. The value itself is rounded.
/// In doubles with a bound of the error; where that doesn't decide, exactly, in expansions: sums of doubles that don't overlap.
/// [Shewchuk 1997]; our steps are fewer and slower: one filter, then all terms. Precondition: finite, at most kMaxExactCoordinate.
double orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// The same for three points in the plane that is left without a coordinate: the sign of component `axis` of (b - a) x (c - a).
double orientation_without(std::size_t axis, const Vec3& a, const Vec3& b, const Vec3& c);

/// Whether the points lie on a line, exactly.
bool on_a_line(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace prismesh::mesh::contact
