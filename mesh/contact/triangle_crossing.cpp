#include "mesh/contact/triangle_crossing.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "mesh/contact/orientation.h"

namespace prismesh::mesh::contact {

namespace {

bool straddles(const Sides& sides) {
  return *std::min_element(sides.begin(), sides.end()) < 0 && *std::max_element(sides.begin(), sides.end()) > 0;
}

/// The corners in their order, first the one that is alone on its side: the others are on the other side or in the plane.
std::array<std::size_t, 3> alone_first(const Sides& sides) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double one = sides[i], next = sides[(i + 1) % 3], last = sides[(i + 2) % 3];
    if ((one > 0 && next <= 0 && last <= 0) || (one < 0 && next >= 0 && last >= 0)) return {i, (i + 1) % 3, (i + 2) % 3};
  }
  return {0, 1, 2};
}

bool is_before(const Vec3& a, const Vec3& b) { return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z()); }

/// Where a side meets the other triangle's plane: the same bits for both triangles at the side.
Vec3 meeting_point(const Triangle& t, const Sides& sides, std::size_t i, std::size_t j) {
  if (is_before(t[j], t[i])) std::swap(i, j);
  const double share = std::clamp(sides[i] / (sides[i] - sides[j]), 0.0, 1.0);
  if (share == 1) return t[j];
  return t[i] + share * (t[j] - t[i]);
}

/// The axis along which the triangle is seen largest.
std::size_t best_axis(const Triangle& t) {
  std::size_t best = 0;
  double max_area = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (const double area = std::abs(orientation_without(axis, t[0], t[1], t[2])); area > max_area) max_area = area, best = axis;
  return best;
}

/// Whether two points in one plane with the axis lie on opposite sides of it.
bool opposite(const Vec3& from, const Vec3& to, const Vec3& a, const Vec3& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double of_a = orientation_without(axis, from, to, a);
    if (of_a != 0) return (of_a > 0) != (orientation_without(axis, from, to, b) > 0);
  }
  return false;
}

/// Whether `point` is strictly inside the angle that goes from `begin` counterclockwise to `end`.
bool inside_angle(const Vec3& from, const Vec3& to, const Vec3& begin, const Vec3& end, const Vec3& point) {
  const double whole = orientation(from, to, begin, end);
  const double first = orientation(from, to, begin, point), second = orientation(from, to, point, end);
  if (whole > 0) return first > 0 && second > 0;
  if (whole < 0) {
    if (first > 0 || second > 0) return true;
    return (first == 0 && opposite(from, to, begin, point)) || (second == 0 && opposite(from, to, end, point));
  }
  return opposite(from, to, begin, end) && first > 0;
}

}  // namespace

Sides sides_of(const Triangle& other, const Triangle& triangle) {
  Sides sides{};
  for (std::size_t i = 0; i < 3; ++i) sides[i] = orientation(other[0], other[1], other[2], triangle[i]);
  return sides;
}

std::optional<CurveSegment> crossing_of(const Triangle& a, const Sides& sides_a, const Triangle& b, const Sides& sides_b) {
  if (!straddles(sides_a) || !straddles(sides_b)) return std::nullopt;
  auto [first, second, third] = alone_first(sides_a);
  auto [one, two, three] = alone_first(sides_b);
  // With both corners that are alone above the other's plane, a's segment on the planes' line runs from its second to its third corner, and
  // b's from its third to its second. A swap turns that triangle's normal, and so the side on which the other one's corner is.
  if (sides_b[one] < 0) std::swap(second, third);
  if (sides_a[first] < 0) std::swap(two, three);
  const auto precedes = [&, first = first, one = one](std::size_t of_a, std::size_t of_b) {
    return orientation(a[first], a[of_a], b[one], b[of_b]);
  };
  if (!(precedes(second, two) < 0 && precedes(third, three) > 0)) return std::nullopt;
  const auto end_a = [&, first = first](std::size_t corner) { return meeting_point(a, sides_a, first, corner); };
  const auto end_b = [&, one = one](std::size_t corner) { return meeting_point(b, sides_b, one, corner); };
  return CurveSegment{precedes(second, three) < 0 ? end_b(three) : end_a(second), precedes(third, two) < 0 ? end_a(third) : end_b(two)};
}

std::optional<CurveSegment> inside_part(const Vec3& from, const Vec3& to, const Triangle& triangle) {
  const std::size_t axis = best_axis(triangle);
  const double turn = orientation_without(axis, triangle[0], triangle[1], triangle[2]) > 0 ? 1 : -1;
  bool left = false, right = false;
  double begin = 0, end = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double side = orientation_without(axis, from, to, triangle[i]);
    left |= side > 0, right |= side < 0;
    const double at_from = turn * orientation_without(axis, triangle[i], triangle[(i + 1) % 3], from);
    const double at_to = turn * orientation_without(axis, triangle[i], triangle[(i + 1) % 3], to);
    if (at_from <= 0 && at_to <= 0) return std::nullopt;
    if (at_from < 0) begin = std::max(begin, at_from / (at_from - at_to));
    if (at_to < 0) end = std::min(end, at_from / (at_from - at_to));
  }
  if (!left || !right) return std::nullopt;
  return CurveSegment{begin == 0 ? from : Vec3(from + begin * (to - from)), end == 1 ? to : Vec3(from + end * (to - from))};
}

std::optional<CurveSegment> shared_part(const CurveSegment& a, const CurveSegment& b) {
  if (!on_a_line(a.from, a.to, b.from) || !on_a_line(a.from, a.to, b.to)) return std::nullopt;
  const auto ordered = [](const CurveSegment& s) { return is_before(s.to, s.from) ? CurveSegment{s.to, s.from} : s; };
  const CurveSegment one = ordered(a), other = ordered(b);
  const CurveSegment shared{is_before(one.from, other.from) ? other.from : one.from, is_before(one.to, other.to) ? one.to : other.to};
  if (!is_before(shared.from, shared.to)) return std::nullopt;
  return shared;
}

bool lies_in(const Vec3& point, const Triangle& t) {
  if (orientation(t[0], t[1], t[2], point) != 0) return false;
  const std::size_t axis = best_axis(t);
  bool left = false, right = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const double side = orientation_without(axis, t[i], t[(i + 1) % 3], point);
    left |= side > 0, right |= side < 0;
  }
  return !left || !right;
}

bool passes_through(const Vec3& from, const Vec3& to, const Triangle& t) {
  const double begin = orientation(t[0], t[1], t[2], from), end = orientation(t[0], t[1], t[2], to);
  if (!((begin < 0 && end > 0) || (begin > 0 && end < 0))) return false;
  bool left = false, right = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const double side = orientation(from, to, t[i], t[(i + 1) % 3]);
    left |= side > 0, right |= side < 0;
  }
  return !left || !right;
}

bool alternate(const Vec3& from, const Vec3& to, const HalfPlanes& a, const HalfPlanes& b) {
  const auto in = [&](std::size_t begin, const Vec3& point) { return inside_angle(from, to, a[begin], a[1 - begin], point); };
  return (in(0, b[0]) && in(1, b[1])) || (in(1, b[0]) && in(0, b[1]));
}

}  // namespace prismesh::mesh::contact
