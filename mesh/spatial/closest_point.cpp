#include "mesh/spatial/closest_point.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel_for.h"
#include "mesh/spatial/point_triangle.h"

namespace prismesh::mesh::spatial {

namespace {

constexpr std::uint32_t kLeafTriangles = 4;
constexpr std::size_t kTreesAtOnce = 64;
constexpr std::size_t kTrianglesAtOnce = 16384;

/// The square and a little more, so that a distance is within itself in spite of rounding; -1 for a negative radius.
double square(double radius) { return radius >= 0 ? radius * radius * (1 + 1e-15) : -1.0; }

double distance2_to_box(const Vec3& low, const Vec3& high, const Vec3& point) {
  return (low - point).cwiseMax(point - high).cwiseMax(Vec3::Zero()).squaredNorm();
}

}  // namespace

ShellTree::ShellTree(const Model& model, const ShellSet& shells, const NodeSet& nodes) {
  triangles_.reserve(2 * shells.size() + nodes.size());
  const auto add = [&](const std::array<Vec3, 3>& corners, ShellIndex shell, bool second) {
    // coordinates that aren't finite would leave the sorting order undefined
    for (const Vec3& corner : corners)
      if (!corner.allFinite()) return;
    triangles_.push_back({corners, shell, second});
  };
  for (const ShellIndex index : shells) {
    if (model.is_removed(index)) continue;
    const ShellNodes& shell = model.shell(index);
    const auto half = [&](std::size_t b, std::size_t c, bool second) {
      add({model.position(shell.node[0]), model.position(shell.node[b]), model.position(shell.node[c])}, index, second);
    };
    half(1, 2, false);
    if (!shell.is_triangle()) half(2, 3, true);
  }
  for (const NodeIndex node : nodes)
    if (!model.is_removed(node)) add({model.position(node), model.position(node), model.position(node)}, ShellIndex(), false);
  if (!triangles_.empty()) divide();
}

/// One for each triangle: these are sorted, and the triangles are put into their order at the end.
struct ShellTree::Entry {
  Vec3 middle;
  std::uint32_t triangle;  ///< ascending by shell and half: ties by it make the tree the same wherever it is built
};
struct ShellTree::Range {
  std::uint32_t node, begin, end;
};

namespace {

/// Divides entries into halves at the median along the longest axis. Returns where the second half begins.
template <class Entry>
std::uint32_t halve(std::vector<Entry>& entries, std::uint32_t begin, std::uint32_t end) {
  Vec3 low = entries[begin].middle;
  Vec3 high = low;
  for (std::uint32_t i = begin; i < end; ++i) {
    low = low.cwiseMin(entries[i].middle);
    high = high.cwiseMax(entries[i].middle);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(entries.begin() + begin, entries.begin() + middle, entries.begin() + end, [axis](const Entry& a, const Entry& b) {
    return a.middle[axis] != b.middle[axis] ? a.middle[axis] < b.middle[axis] : a.triangle < b.triangle;
  });
  return middle;
}

}  // namespace

/// Divides ranges of triangles into halves until few triangles are left in each: the first ranges one after the other, the subtrees under
/// them in parallel. The order of the nodes doesn't depend on the threads.
void ShellTree::divide() {
  std::vector<Entry> entries;
  entries.reserve(triangles_.size());
  for (const Triangle& t : triangles_)
    entries.push_back({t.corner[0] / 3 + t.corner[1] / 3 + t.corner[2] / 3, static_cast<std::uint32_t>(entries.size())});
  // divides ranges from the front until `enough` are open or all are leaves
  const auto split = [&entries](std::vector<Node>& nodes, std::vector<Range>& open, std::size_t enough) {
    while (!open.empty() && open.size() < enough) {
      const std::vector<Range> level = std::exchange(open, {});
      for (const Range& range : level) {
        if (range.end - range.begin <= kLeafTriangles) {
          nodes[range.node].first = range.begin;
          nodes[range.node].count = range.end - range.begin;
          continue;
        }
        const std::uint32_t middle = halve(entries, range.begin, range.end);
        const auto left = static_cast<std::uint32_t>(nodes.size());
        nodes[range.node].first = left;
        nodes.resize(nodes.size() + 2);
        open.push_back({left, range.begin, middle});
        open.push_back({left + 1, middle, range.end});
      }
    }
  };
  nodes_.resize(1);
  std::vector<Range> open{{0, 0, static_cast<std::uint32_t>(entries.size())}};
  split(nodes_, open, kTreesAtOnce);
  std::vector<std::vector<Node>> below(open.size());
  parallel_for(open.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      below[i].resize(1);
      std::vector<Range> own{{0, open[i].begin, open[i].end}};
      split(below[i], own, std::numeric_limits<std::size_t>::max());
    }
  });
  for (std::size_t i = 0; i < open.size(); ++i) {
    const auto shift = static_cast<std::uint32_t>(nodes_.size()) - 1;  // the subtree's root takes its parent's entry
    for (Node& node : below[i])
      if (node.count == 0) node.first += shift;
    nodes_[open[i].node] = below[i].front();
    nodes_.insert(nodes_.end(), below[i].begin() + 1, below[i].end());
  }
  std::vector<Triangle> sorted(triangles_.size());
  parallel_for(entries.size(), kTrianglesAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) sorted[i] = triangles_[entries[i].triangle];
  });
  triangles_ = std::move(sorted);
  fit_boxes();
}

/// Children come after their parents: in reverse order each box is made of finished boxes.
void ShellTree::fit_boxes() {
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& node = nodes_[i];
    if (node.count == 0) {
      node.low = nodes_[node.first].low.cwiseMin(nodes_[node.first + 1].low);
      node.high = nodes_[node.first].high.cwiseMax(nodes_[node.first + 1].high);
      continue;
    }
    node.low = node.high = triangles_[node.first].corner[0];
    for (std::uint32_t t = node.first; t < node.first + node.count; ++t)
      for (const Vec3& corner : triangles_[t].corner) {
        node.low = node.low.cwiseMin(corner);
        node.high = node.high.cwiseMax(corner);
      }
  }
}

template <class Visit>
void ShellTree::walk(const Vec3& point, double& radius2, Visit&& visit) const {
  if (nodes_.empty() || !point.allFinite()) return;
  struct Waiting {
    std::uint32_t node;
    double distance2;
  };
  std::array<Waiting, 40> stack;  // the depth is at most 32, since the number of triangles has 32 bits, and each level adds one entry
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

SurfacePoint surface_point(ShellIndex shell, bool second, const OnTriangle& on) {
  SurfacePoint point{shell, on.point, std::sqrt(on.distance2), {}};
  point.share[0] = on.share[0];
  point.share[second ? 2 : 1] = on.share[1];
  point.share[second ? 3 : 2] = on.share[2];
  return point;
}

}  // namespace

std::optional<SurfacePoint> ShellTree::closest(const Vec3& point, double radius) const {
  std::optional<SurfacePoint> best;
  double min_distance2 = square(radius);
  walk(point, min_distance2, [&](const Triangle& triangle) {
    const OnTriangle on = closest_on_triangle(triangle.corner, point);
    const bool nearer = on.distance2 < min_distance2 || (on.distance2 == min_distance2 && (!best || triangle.shell < best->shell));
    if (!nearer) return;
    min_distance2 = on.distance2;
    best = surface_point(triangle.shell, triangle.second, on);
  });
  return best;
}

double ShellTree::distance(const Vec3& point, Vec3& near) const {
  const double from_near2 = (near - point).squaredNorm();
  double min_distance2 = from_near2 * (1 + 1e-12);  // so that the triangle of `near` is tested as well
  bool found = false;
  walk(point, min_distance2, [&](const Triangle& triangle) {
    const OnTriangle on = closest_on_triangle(triangle.corner, point);
    if (!(on.distance2 < min_distance2)) return;
    min_distance2 = on.distance2;
    near = on.point;
    found = true;
  });
  return std::sqrt(found ? min_distance2 : from_near2);
}

std::vector<SurfacePoint> ShellTree::within(const Vec3& point, double radius) const {
  std::vector<SurfacePoint> found;
  double radius2 = square(radius);
  walk(point, radius2, [&](const Triangle& triangle) {
    const OnTriangle on = closest_on_triangle(triangle.corner, point);
    if (on.distance2 <= radius2) found.push_back(surface_point(triangle.shell, triangle.second, on));
  });
  std::sort(found.begin(), found.end(),
            [](const SurfacePoint& a, const SurfacePoint& b) { return a.shell != b.shell ? a.shell < b.shell : a.distance < b.distance; });
  found.erase(std::unique(found.begin(), found.end(), [](const SurfacePoint& a, const SurfacePoint& b) { return a.shell == b.shell; }),
              found.end());
  return found;
}

}  // namespace prismesh::mesh::spatial
