// Whether two triangles cross, and along which segment. Decided exactly; the segment's ends are rounded.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "mesh/model/model.h"

namespace prismesh::mesh::contact {

using Triangle = std::array<Vec3, 3>;

struct CurveSegment {
  Vec3 from, to;

  double length() const { return (to - from).norm(); }
};

/// For each corner of a triangle a number above 0, 0, or below 0: it lies above, in, or below the plane of another one.
using Sides = std::array<double, 3>;

/// The sides on which the corners of `triangle` lie, exactly.
Sides sides_of(const Triangle& other, const Triangle& triangle);

/// Returns the segment along which the insides of both triangles cross: each has corners on both sides of the other's plane, and the two
/// share more than a point of the planes' line. Touching, a side in the other's plane, and overlap in one plane don't count.
/// By the order of the ends of both triangles' segments on that line, which is a sign of four corners each: [Guigue 2003].
/// `sides_a`: sides_of(b, a); `sides_b`: sides_of(a, b). Precondition: neither has its corners on a line.
std::optional<CurveSegment> crossing_of(const Triangle& a, const Sides& sides_a, const Triangle& b, const Sides& sides_b);

/// Returns the part of a segment in a triangle's plane that passes through the triangle's inside; nothing where they share none of it.
/// Precondition: both ends lie exactly in the plane, the triangle's corners not on a line.
std::optional<CurveSegment> inside_part(const Vec3& from, const Vec3& to, const Triangle& triangle);

/// Returns what two segments on one line share, if it is more than a point. Segments that aren't on one line share nothing.
std::optional<CurveSegment> shared_part(const CurveSegment& a, const CurveSegment& b);

/// Whether a point lies in a triangle, its sides included, exactly. Precondition: the corners aren't on a line.
bool lies_in(const Vec3& point, const Triangle& triangle);

/// Whether a segment passes through a triangle, its sides included: its ends are on both sides of the plane. Same precondition.
bool passes_through(const Vec3& from, const Vec3& to, const Triangle& triangle);

/// Two half planes from an axis, each by a point of it.
using HalfPlanes = std::array<Vec3, 2>;
/// Whether two sheets that meet along an axis pass through each other there: going round the axis, half planes of one sheet and of the
/// other alternate. Half planes that fall together don't. Precondition: no point lies on the axis.
bool alternate(const Vec3& from, const Vec3& to, const HalfPlanes& a, const HalfPlanes& b);

}  // namespace prismesh::mesh::contact
