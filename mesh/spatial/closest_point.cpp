#include "mesh/spatial/closest_point.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace prismesh::mesh::spatial {

namespace {

constexpr std::uint32_t kLeafTriangles = 4;

struct OnTriangle {
  Vec3 point;
  std::array<double, 3> share;
};

/// Ericson, "Real-Time Collision Detection", 5.1.5: by the regions of corners, sides and face. Degenerate triangles end in a side.
OnTriangle closest_on(const std::array<Vec3, 3>& t, const Vec3& p) {
  const Vec3 ab = t[1] - t[0];
  const Vec3 ac = t[2] - t[0];
  const auto on_side = [&](int i, int j) {
    const Vec3 along = t[j] - t[i];
    const double length2 = along.squaredNorm();
    const double s = length2 > 0 ? std::clamp((p - t[i]).dot(along) / length2, 0.0, 1.0) : 0.0;
    OnTriangle on{t[i] + s * along, {}};
    on.share[static_cast<std::size_t>(i)] = 1 - s;
    on.share[static_cast<std::size_t>(j)] = s;
    return on;
  };
  const Vec3 normal = ab.cross(ac);
  const double area2 = normal.squaredNorm();
  if (area2 > 0) {
    const Vec3 ap = p - t[0];
    const double v = ap.cross(ac).dot(normal) / area2;
    const double w = ab.cross(ap).dot(normal) / area2;
    if (v >= 0 && w >= 0 && v + w <= 1) return {t[0] + v * ab + w * ac, {1 - v - w, v, w}};
  }
  OnTriangle best = on_side(0, 1);
  for (const auto& [i, j] : {std::pair(1, 2), std::pair(2, 0)}) {
    const OnTriangle other = on_side(i, j);
    if ((other.point - p).squaredNorm() < (best.point - p).squaredNorm()) best = other;
  }
  return best;
}

double distance2_to_box(const Vec3& low, const Vec3& high, const Vec3& point) {
  return (low - point).cwiseMax(point - high).cwiseMax(Vec3::Zero()).squaredNorm();
}

}  // namespace

ShellTree::ShellTree(const Model& model, const ShellSet& shells) {
  triangles_.reserve(2 * shells.size());
  for (const ShellIndex index : shells) {
    if (model.is_removed(index)) continue;
    const ShellNodes& shell = model.shell(index);
    const auto at = [&](std::size_t corner) { return model.position(shell.node[corner]); };
    triangles_.push_back({{at(0), at(1), at(2)}, index, false});
    if (!shell.is_triangle()) triangles_.push_back({{at(0), at(2), at(3)}, index, true});
  }
  if (triangles_.empty()) return;

  const auto middle_of = [](const Triangle& t, int axis) { return t.corner[0][axis] + t.corner[1][axis] + t.corner[2][axis]; };
  struct Range {
    std::uint32_t node, begin, end;
  };
  nodes_.reserve(triangles_.size());
  nodes_.emplace_back();
  std::vector<Range> open{{0, 0, static_cast<std::uint32_t>(triangles_.size())}};
  while (!open.empty()) {
    const Range range = open.back();
    open.pop_back();
    Vec3 low = triangles_[range.begin].corner[0];
    Vec3 high = low;
    for (std::uint32_t i = range.begin; i < range.end; ++i)
      for (const Vec3& corner : triangles_[i].corner) {
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
      }
    nodes_[range.node].low = low;
    nodes_[range.node].high = high;
    if (range.end - range.begin <= kLeafTriangles) {
      nodes_[range.node].first = range.begin;
      nodes_[range.node].count = range.end - range.begin;
      continue;
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    const std::uint32_t middle = range.begin + (range.end - range.begin) / 2;
    // ties by shell and half, so that the tree is the same wherever it is built
    std::nth_element(triangles_.begin() + range.begin, triangles_.begin() + middle, triangles_.begin() + range.end,
                     [&](const Triangle& a, const Triangle& b) {
                       const double at_a = middle_of(a, axis), at_b = middle_of(b, axis);
                       return at_a != at_b ? at_a < at_b : std::pair(a.shell, a.second) < std::pair(b.shell, b.second);
                     });
    const auto left = static_cast<std::uint32_t>(nodes_.size());
    nodes_[range.node].first = left;
    nodes_.emplace_back();
    nodes_.emplace_back();
    open.push_back({left, range.begin, middle});
    open.push_back({left + 1, middle, range.end});
  }
}

template <class Visit>
void ShellTree::walk(const Vec3& point, double& radius2, Visit&& visit) const {
  if (nodes_.empty()) return;
  struct Waiting {
    std::uint32_t node;
    double distance2;
  };
  std::array<Waiting, 96> stack;  // the tree is balanced: two a level
  std::size_t waiting = 0;
  stack[waiting++] = {0, distance2_to_box(nodes_[0].low, nodes_[0].high, point)};
  while (waiting > 0) {
    const Waiting next = stack[--waiting];
    if (!(next.distance2 <= radius2)) continue;
    const Node& node = nodes_[next.node];
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) visit(triangles_[i]);
      continue;
    }
    Waiting near{node.first, distance2_to_box(nodes_[node.first].low, nodes_[node.first].high, point)};
    Waiting far{node.first + 1, distance2_to_box(nodes_[node.first + 1].low, nodes_[node.first + 1].high, point)};
    if (far.distance2 < near.distance2) std::swap(near, far);
    stack[waiting++] = far;
    stack[waiting++] = near;
  }
}

namespace {

SurfacePoint surface_point(ShellIndex shell, bool second, const OnTriangle& on, double distance2) {
  SurfacePoint point{shell, on.point, std::sqrt(distance2), {}};
  point.share[0] = on.share[0];
  point.share[second ? 2 : 1] = on.share[1];
  point.share[second ? 3 : 2] = on.share[2];
  return point;
}

}  // namespace

std::optional<SurfacePoint> ShellTree::closest(const Vec3& point, double radius) const {
  std::optional<SurfacePoint> best;
  double least2 = radius * radius;
  walk(point, least2, [&](const Triangle& triangle) {
    const OnTriangle on = closest_on(triangle.corner, point);
    const double distance2 = (on.point - point).squaredNorm();
    const bool nearer = best ? distance2 < least2 || (distance2 == least2 && triangle.shell < best->shell) : distance2 <= least2;
    if (!nearer) return;
    least2 = distance2;
    best = surface_point(triangle.shell, triangle.second, on, distance2);
  });
  return best;
}

std::vector<SurfacePoint> ShellTree::within(const Vec3& point, double radius) const {
  std::vector<SurfacePoint> found;
  double radius2 = radius * radius;
  walk(point, radius2, [&](const Triangle& triangle) {
    const OnTriangle on = closest_on(triangle.corner, point);
    const double distance2 = (on.point - point).squaredNorm();
    if (distance2 <= radius2) found.push_back(surface_point(triangle.shell, triangle.second, on, distance2));
  });
  std::sort(found.begin(), found.end(),
            [](const SurfacePoint& a, const SurfacePoint& b) { return a.shell != b.shell ? a.shell < b.shell : a.distance < b.distance; });
  found.erase(std::unique(found.begin(), found.end(), [](const SurfacePoint& a, const SurfacePoint& b) { return a.shell == b.shell; }),
              found.end());
  return found;
}

}  // namespace prismesh::mesh::spatial
