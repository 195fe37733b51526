// How far a triangle must be moved along a direction to be clear of another one. Private to mesh/contact.
#pragma once

#include "mesh/contact/triangle_crossing.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::contact {

/// Returns the least length L >= 0 so that `moving`, moved by L or more along `direction` (of length 1), is at least `least` from `fixed`;
/// 0 if it already is, there and beyond. The distance of two convex sets is a convex function of L: Newton's method comes down to its
/// greatest root from beyond, and never falls below it. So triangles whose every point has moved by L or more are clear, too.
double lift_apart(const Triangle& moving, const Triangle& fixed, const Vec3& direction, double least);

}  // namespace prismesh::mesh::contact
