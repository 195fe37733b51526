#include "mesh/spatial/unfold.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace prismesh::mesh::spatial {

namespace {

constexpr int kMaxUnfoldedShells = 20;  ///< then the corner is given up: distance reaches it over its own sides only

struct FlatPoint {
  double x = 0;
  double y = 0;
};
double dot(const FlatPoint& a, const FlatPoint& b) { return a.x * b.x + a.y * b.y; }
FlatPoint minus(const FlatPoint& a, const FlatPoint& b) { return {a.x - b.x, a.y - b.y}; }
double distance(const FlatPoint& a, const FlatPoint& b) {
  const FlatPoint d = minus(a, b);
  return std::sqrt(dot(d, d));
}

struct FlatNode {
  std::uint32_t node = 0;
  FlatPoint at;
};

/// Unfolds a node on the far side of the edge from `p` to `q`, seen from the corner, which is at the origin. Returns its position.
FlatPoint unfold_node(const Patch& patch, const FlatNode& p, const FlatNode& q, std::uint32_t node) {
  const Vec3& position = patch.positions[node];
  const double to_p2 = (position - patch.positions[p.node]).squaredNorm();
  const double to_q2 = (position - patch.positions[q.node]).squaredNorm();
  const FlatPoint along = minus(q.at, p.at);
  const double base2 = dot(along, along);
  if (!(base2 > 0)) return p.at;
  const double s = 0.5 * (1 + (to_p2 - to_q2) / base2);
  const double height = std::sqrt(std::max(0.0, to_p2 / base2 - s * s));
  FlatPoint across{-along.y, along.x};
  if (dot(across, p.at) < 0) across = {-across.x, -across.y};  // away from the corner
  return {p.at.x + s * along.x + height * across.x, p.at.y + s * along.y + height * across.y};
}

/// The first shell at the edge other than `but`.
std::optional<std::uint32_t> shell_beyond(const Patch& patch, std::uint32_t but, std::uint32_t a, std::uint32_t b) {
  for (std::uint32_t k = patch.node_first[a]; k < patch.node_first[a + 1]; ++k) {
    const std::uint32_t shell = patch.node_shells[k];
    if (shell == but) continue;
    const auto& corner = patch.shells[shell];
    const int count = corner_count(corner);
    if (count < 3) continue;
    for (int i = 0; i < count; ++i) {
      const std::uint32_t from = corner[i];
      const std::uint32_t to = corner[(i + 1) % count];
      if ((from == a && to == b) || (from == b && to == a)) return shell;
    }
  }
  return std::nullopt;
}

/// Unfolds the shell's other corners, in order from the neighbour of `p` to the neighbour of `q`; returns how many.
int far_corners(const Patch& patch, std::uint32_t shell, const FlatNode& p, const FlatNode& q, std::array<FlatNode, 2>& out) {
  const auto& corner = patch.shells[shell];
  const int count = corner_count(corner);
  const int at = static_cast<int>(std::find(corner.begin(), corner.begin() + count, p.node) - corner.begin());
  const int step = corner[(at + 1) % count] == q.node ? count - 1 : 1;
  for (int i = 0; i + 2 < count; ++i) {
    const std::uint32_t node = corner[(at + step * (i + 1)) % count];
    out[i] = {node, unfold_node(patch, p, q, node)};
  }
  return count - 2;
}

/// Finds a node in front of the corner at the origin between `a` and `b`: at less than a right angle from both.
std::optional<FlatNode> node_in_front(const Patch& patch, std::uint32_t shell, const FlatNode& a, const FlatNode& b) {
  FlatNode p = a;
  FlatNode q = b;
  for (int step = 0; step < kMaxUnfoldedShells; ++step) {
    const auto beyond = shell_beyond(patch, shell, p.node, q.node);
    if (!beyond) return std::nullopt;
    shell = *beyond;
    std::array<FlatNode, 2> far;
    const int count = far_corners(patch, shell, p, q, far);
    for (int i = 0; i < count; ++i) {
      const bool near_a = dot(far[i].at, b.at) <= 0;
      const bool near_b = dot(far[i].at, a.at) <= 0;
      if (!near_a && !near_b) return far[i];
      if (near_a) p = far[i];
      if (near_b) {
        q = far[i];
        break;
      }
    }
  }
  return std::nullopt;
}

/// Unfolds the mesh in front of the corner `c` between the corners a and b of a local shell, if `c` is obtuse.
void unfold_corner(Patch& patch, std::uint32_t shell, std::uint32_t c, std::uint32_t a, std::uint32_t b) {
  const Vec3 to_a = patch.positions[a] - patch.positions[c];
  const Vec3 to_b = patch.positions[b] - patch.positions[c];
  const double cosine = to_a.dot(to_b);
  const double a2 = to_a.squaredNorm();
  const double b2 = to_b.squaredNorm();
  if (cosine >= -1e-9 * (a2 + b2) || !(a2 > 0)) return;
  const double side_a = std::sqrt(a2);
  const FlatNode flat_a{a, {side_a, 0}};
  const FlatNode flat_b{b, {cosine / side_a, std::sqrt(std::max(0.0, b2 - cosine * cosine / a2))}};
  const auto front = node_in_front(patch, shell, flat_a, flat_b);
  if (!front || front->node == c) return;
  const double to_front = distance(front->at, {});
  patch.unfolded.push_back({{a, front->node}, c, distance(flat_a.at, front->at), {side_a, to_front}});
  patch.unfolded.push_back({{front->node, b}, c, distance(front->at, flat_b.at), {to_front, std::sqrt(b2)}});
}

void fill_csr(Patch& patch) {
  patch.unfolded_first.assign(patch.nodes.size() + 2, 0);
  for (const UnfoldedTriangle& triangle : patch.unfolded)
    for (const std::uint32_t node : triangle.support) ++patch.unfolded_first[node + 2];
  for (std::size_t i = 2; i < patch.unfolded_first.size(); ++i) patch.unfolded_first[i] += patch.unfolded_first[i - 1];
  patch.unfolded_of.resize(2 * patch.unfolded.size());
  for (std::uint32_t t = 0; t < patch.unfolded.size(); ++t)
    for (const std::uint32_t node : patch.unfolded[t].support) patch.unfolded_of[patch.unfolded_first[node + 1]++] = t;
  patch.unfolded_first.pop_back();
}

}  // namespace

void unfold_obtuse_corners(Patch& patch) {
  for (std::uint32_t shell = 0; shell < patch.shells.size(); ++shell) {
    const std::array<std::uint32_t, 4> corner = patch.shells[shell];
    const int count = corner_count(corner);
    if (count < 3) continue;
    for (int i = 0; i < count; ++i) {
      const std::uint32_t next = corner[(i + 1) % count];
      const std::uint32_t opposite = corner[(i + 2) % count];
      const std::uint32_t previous = corner[(i + count - 1) % count];
      unfold_corner(patch, shell, corner[i], next, opposite);
      if (count == 4) unfold_corner(patch, shell, corner[i], opposite, previous);
    }
  }
  fill_csr(patch);
}

}  // namespace prismesh::mesh::spatial
