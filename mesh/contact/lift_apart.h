// How far a triangle must be moved along a direction to be clear of another one. Private to mesh/contact.
#pragma once

#include <array>
#include <optional>

#include "mesh/contact/triangle_crossing.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::contact {

/// Returns the least length L >= 0 so that `moving`, moved by L or more along `direction` (of length 1), is at least `least` from `fixed`;
/// 0 if it already is, there and beyond. The distance of two convex sets is a convex function of L: Newton's method comes down to its
/// greatest root from beyond, and never falls below it. So triangles whose every point has moved by L or more are clear, too.
double lift_apart(const Triangle& moving, const Triangle& fixed, const Vec3& direction, double least);

/// The same where only some corners of `moving` go and the others stay: the least length of these. Nothing if they can't clear it. It is
/// the greatest ratio, over the points of both triangles, of what a point misses and the share of its weights at corners that go:
/// Dinkelbach's method comes up to it [Dinkelbach 1967].
std::optional<double> lift_corners_apart(const Triangle& moving, const std::array<bool, 3>& goes, const Triangle& fixed,
                                         const Vec3& direction, double least);

}  // namespace prismesh::mesh::contact
