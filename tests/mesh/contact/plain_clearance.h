// The least distance of two parts, by all pairs of their triangles and the textbook's formulas: shares no code with what it checks.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "mesh/model/model.h"

namespace prismesh::test {

class PlainClearance {
 public:
  using Point = mesh::Vec3;
  using Corners = std::array<Point, 3>;

  /// 0 where they cross.
  static double between(const mesh::Model& model, mesh::PartIndex a, mesh::PartIndex b) {
    double least = std::numeric_limits<double>::infinity();
    const std::vector<Corners> others = triangles_of(model, b);
    Eigen::AlignedBox3d about;
    for (const Corners& other : others)
      for (const Point& point : other) about.extend(point);
    for (const Corners& one : triangles_of(model, a))
      for (const Corners& other : others) {
        if (about.exteriorDistance(one[0]) > least + (one[1] - one[0]).norm() + (one[2] - one[0]).norm()) break;
        if (boxes_apart(one, other) >= least) continue;
        least = std::min(least, of_triangles(one, other));
      }
    return least;
  }

 private:
  static std::vector<Corners> triangles_of(const mesh::Model& model, mesh::PartIndex part) {
    std::vector<Corners> triangles;
    for (std::size_t s = 0; s < model.shell_count(); ++s) {
      if (model.shell_parts[s] != part || model.is_removed(mesh::ShellIndex(s))) continue;
      const mesh::ShellNodes& nodes = model.shell_nodes[s];
      triangles.push_back({model.position(nodes.node[0]), model.position(nodes.node[1]), model.position(nodes.node[2])});
      if (!nodes.is_triangle())
        triangles.push_back({model.position(nodes.node[0]), model.position(nodes.node[2]), model.position(nodes.node[3])});
    }
    return triangles;
  }

  static double boxes_apart(const Corners& a, const Corners& b) {
    Eigen::AlignedBox3d box_a, box_b;
    for (const Point& point : a) box_a.extend(point);
    for (const Point& point : b) box_b.extend(point);
    return box_a.exteriorDistance(box_b);
  }

  static double of_triangles(const Corners& a, const Corners& b) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
      if (pierces(a[i], a[(i + 1) % 3], b) || pierces(b[i], b[(i + 1) % 3], a)) return 0;
      least = std::min({least, from_triangle(a[i], b), from_triangle(b[i], a)});
      for (std::size_t j = 0; j < 3; ++j) least = std::min(least, of_segments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
    }
    return least;
  }

  /// Möller and Trumbore's test.
  static bool pierces(const Point& from, const Point& to, const Corners& t) {
    const Point along = to - from, e1 = t[1] - t[0], e2 = t[2] - t[0], p = along.cross(e2);
    const double det = e1.dot(p);
    if (det == 0) return false;
    const Point s = from - t[0], q = s.cross(e1);
    const double u = s.dot(p) / det, v = along.dot(q) / det, w = e2.dot(q) / det;
    return u >= 0 && v >= 0 && u + v <= 1 && w >= 0 && w <= 1;
  }

  static double from_segment(const Point& p, const Point& a, const Point& b) {
    const double share = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (a + share * (b - a) - p).norm();
  }

  static double from_triangle(const Point& p, const Corners& t) {
    const Point normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    const Point foot = p - normal.dot(p - t[0]) * normal;
    bool inside = true;
    for (std::size_t i = 0; i < 3; ++i) inside = inside && (t[(i + 1) % 3] - t[i]).cross(foot - t[i]).dot(normal) >= 0;
    if (inside) return (p - foot).norm();
    return std::min({from_segment(p, t[0], t[1]), from_segment(p, t[1], t[2]), from_segment(p, t[2], t[0])});
  }

  static double of_segments(const Point& a, const Point& b, const Point& c, const Point& d) {
    double least = std::min({from_segment(a, c, d), from_segment(b, c, d), from_segment(c, a, b), from_segment(d, a, b)});
    const Point across = (b - a).cross(d - c);
    if (const double size2 = across.squaredNorm(); size2 > 0) {
      const double s = (c - a).cross(d - c).dot(across) / size2, t = (c - a).cross(b - a).dot(across) / size2;
      if (s >= 0 && s <= 1 && t >= 0 && t <= 1) least = std::min(least, (a + s * (b - a) - c - t * (d - c)).norm());
    }
    return least;
  }
};

}  // namespace prismesh::test
