// The distances of eight points from a triangle, computed together in single precision.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <Eigen/Geometry>

#include "mesh/model/model.h"
#include "mesh/spatial/float_box.h"
#include "mesh/spatial/point_triangle.h"

namespace prismesh::mesh::field {

using spatial::Float4;

/// Coordinates of eight points, or eight numbers.
struct Float8 {
  Float4 half[2];
  float operator[](std::size_t i) const { return half[i / 4][i % 4]; }
  void set(std::size_t i, float value) { half[i / 4][i % 4] = value; }
};
struct EightPoints {
  Float8 x, y, z;
};

/// A triangle in the plane of its own axes: the longest side lies on the x axis and begins at the start, the third corner has y >= 0.
struct TriangleFrame {
  Vec3 start, x_axis, y_axis, normal;
  double length = 0;                ///< of the longest side
  double third_x = 0, third_y = 0;  ///< the third corner
  bool flat = false;                ///< without an area: third_y is 0
  std::uint32_t element = 0;

  TriangleFrame(const std::array<Vec3, 3>& corners, std::uint32_t of_element);
};

/// A triangle as it is seen from a place near the points, in single precision. Each side is given by its line's distance from the place and
/// by where the side begins and ends along it. So the numbers that matter are small, and distances have the error of a few roundings of the
/// points' own coordinates and distances, however large the triangle is, and whatever its shape.
struct LocalTriangle {
  struct Side {
    float x, y;        ///< direction; the inside is to the left
    float out;         ///< from the place outward across the line
    float begin, end;  ///< along the line
  };
  std::array<float, 3> x_axis, y_axis, normal;
  float high;  ///< of the place above the plane
  std::array<Side, 3> side;
  float inside;  ///< a point is over the face if it is at most so far out of each side; minus infinity without an area
  std::uint32_t element;

  LocalTriangle(const TriangleFrame& frame, const Vec3& place);
};

inline TriangleFrame::TriangleFrame(const std::array<Vec3, 3>& corners, std::uint32_t of_element) : element(of_element) {
  std::array<Vec3, 3> t = corners;
  const double side01 = (t[1] - t[0]).squaredNorm(), side12 = (t[2] - t[1]).squaredNorm(), side20 = (t[0] - t[2]).squaredNorm();
  if (side12 > side01 && side12 >= side20)
    t = {corners[1], corners[2], corners[0]};
  else if (side20 > side01)
    t = {corners[2], corners[0], corners[1]};
  // from the end nearer to the third corner the axes are the more exact
  if ((t[2] - t[1]).squaredNorm() < (t[2] - t[0]).squaredNorm()) std::swap(t[0], t[1]);
  start = t[0];
  const Vec3 along = t[1] - t[0], to_third = t[2] - t[0];
  length = along.norm();
  x_axis = length > 0 ? Vec3(along / length) : Vec3::UnitX();
  third_x = to_third.dot(x_axis);
  const Vec3 up = to_third - third_x * x_axis;
  third_y = up.norm();
  flat = !(third_y * third_y > spatial::kSliver2 * length * length);
  y_axis = flat ? x_axis.unitOrthogonal() : Vec3(up / third_y);
  if (flat) third_y = 0;
  normal = x_axis.cross(y_axis);
}

inline LocalTriangle::LocalTriangle(const TriangleFrame& frame, const Vec3& place) : element(frame.element) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    x_axis[a] = static_cast<float>(frame.x_axis[axis]);
    y_axis[a] = static_cast<float>(frame.y_axis[axis]);
    normal[a] = static_cast<float>(frame.normal[axis]);
  }
  const Vec3 from_start = place - frame.start;
  const double x = frame.x_axis.dot(from_start), y = frame.y_axis.dot(from_start);
  high = static_cast<float>(frame.normal.dot(from_start));
  inside = frame.flat ? -spatial::kInfiniteFloat : 0.0F;
  const auto set = [&](std::size_t i, double from_x, double from_y, double to_x, double to_y) {
    const double dx = to_x - from_x, dy = to_y - from_y, side_length = std::sqrt(dx * dx + dy * dy);
    const double ux = side_length > 0 ? dx / side_length : 1.0, uy = side_length > 0 ? dy / side_length : 0.0;
    const double begin = ux * (from_x - x) + uy * (from_y - y);
    side[i] = {static_cast<float>(ux), static_cast<float>(uy), static_cast<float>(uy * (x - from_x) - ux * (y - from_y)),
               static_cast<float>(begin), static_cast<float>(begin + side_length)};
  };
  set(0, 0, 0, frame.length, 0);
  set(1, frame.length, 0, frame.third_x, frame.third_y);
  set(2, frame.third_x, frame.third_y, 0, 0);
}

/// The squares of the distances of points, given from the triangle's place.
inline Float8 distances2(const LocalTriangle& t, const EightPoints& points) {
  const auto min = [](const Float4& a, const Float4& b) -> Float4 { return a < b ? a : b; };
  const auto max = [](const Float4& a, const Float4& b) -> Float4 { return a > b ? a : b; };
  Float8 result;
  for (int h = 0; h < 2; ++h) {
    const Float4 &px = points.x.half[h], &py = points.y.half[h], &pz = points.z.half[h];
    const Float4 x = px * t.x_axis[0] + py * t.x_axis[1] + pz * t.x_axis[2];
    const Float4 y = px * t.y_axis[0] + py * t.y_axis[1] + pz * t.y_axis[2];
    const Float4 z = px * t.normal[0] + py * t.normal[1] + pz * t.normal[2] + t.high;
    // of each side, the distance across its line, and how far the place along it is beyond its ends
    const auto out = [&](const LocalTriangle::Side& s) -> Float4 { return x * s.y - y * s.x + s.out; };
    const auto from_side2 = [&](const LocalTriangle::Side& s, const Float4& across) -> Float4 {
      const Float4 along = x * s.x + y * s.y;
      const Float4 beyond = along - min(max(along, Float4{} + s.begin), Float4{} + s.end);
      return across * across + beyond * beyond;
    };
    const Float4 out0 = out(t.side[0]), out1 = out(t.side[1]), out2 = out(t.side[2]);
    const Float4 nearest2 = min(min(from_side2(t.side[0], out0), from_side2(t.side[1], out1)), from_side2(t.side[2], out2));
    const Float4 in_plane2 = max(max(out0, out1), out2) <= Float4{} + t.inside ? Float4{} : nearest2;
    result.half[h] = in_plane2 + z * z;
  }
  return result;
}

}  // namespace prismesh::mesh::field
