#include "mesh/spatial/cut_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/Geometry>

#include "base/deterministic_math.h"
#include "mesh/model/adjacency.h"
#include "mesh/spatial/unfold.h"

namespace prismesh::mesh::spatial {

namespace {

constexpr std::uint32_t kOutside = 0xffffffffu;

/// Model node -> local number: a table where the nodes lie close together in the model, else a search.
class LocalNumbers {
 public:
  explicit LocalNumbers(const NodeSet& nodes) : nodes_(nodes) {
    if (nodes.empty()) return;
    first_ = nodes.front().value;
    const std::size_t span = nodes.back().value - first_ + std::size_t{1};
    if (span > 64 * nodes.size() + 4096) return;
    table_.assign(span, kOutside);
    for (std::size_t i = 0; i < nodes.size(); ++i) table_[nodes[i].value - first_] = static_cast<std::uint32_t>(i);
  }

  std::uint32_t of(NodeIndex node) const {
    if (!table_.empty()) {
      const std::uint32_t place = node.value - first_;  // wraps to a large number below the first
      return place < table_.size() ? table_[place] : kOutside;
    }
    const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), node);
    return found != nodes_.end() && *found == node ? static_cast<std::uint32_t>(found - nodes_.begin()) : kOutside;
  }

 private:
  const NodeSet& nodes_;
  std::vector<std::uint32_t> table_;
  std::uint32_t first_ = 0;
};

struct LocalCorners {
  std::array<std::uint32_t, 4> corner{};  ///< distinct, in the shell's order, the last repeated
  int count = 0;
  bool whole = true;  ///< no corner lies outside
};

LocalCorners local_corners(const LocalNumbers& numbers, const ShellNodes& shell) {
  LocalCorners local;
  for (int i = 0; i < shell.corners(); ++i) {
    const std::uint32_t number = numbers.of(shell.node[i]);
    if (number == kOutside)
      local.whole = false;
    else if (std::find(local.corner.begin(), local.corner.begin() + local.count, number) == local.corner.begin() + local.count)
      local.corner[local.count++] = number;
  }
  for (int i = local.count; i > 0 && i < 4; ++i) local.corner[i] = local.corner[local.count - 1];
  return local;
}

void fill_positions(const Model& model, Patch& patch) {
  patch.positions.reserve(patch.nodes.size());
  for (const NodeIndex node : patch.nodes) patch.positions.push_back(model.position(node));
}

void fill_node_shells(Patch& patch) {
  patch.node_first.assign(patch.nodes.size() + 2, 0);
  const auto each_corner = [&](const auto& body) {
    for (std::size_t s = 0; s < patch.shells.size(); ++s)
      for (int i = 0; i < corner_count(patch.shells[s]); ++i) body(patch.shells[s][i], static_cast<std::uint32_t>(s));
  };
  each_corner([&](std::uint32_t node, std::uint32_t) { ++patch.node_first[node + 2]; });
  for (std::size_t i = 2; i < patch.node_first.size(); ++i) patch.node_first[i] += patch.node_first[i - 1];
  patch.node_shells.resize(patch.node_first.back());
  each_corner([&](std::uint32_t node, std::uint32_t shell) { patch.node_shells[patch.node_first[node + 1]++] = shell; });
  patch.node_first.pop_back();
}

void fill_lengths(Patch& patch) {
  static constexpr std::array<std::array<int, 2>, 6> kPairs{{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}, {1, 3}}};
  patch.lengths.reserve(patch.shells.size());
  for (const auto& corner : patch.shells) {
    std::array<double, 6> lengths;
    for (std::size_t i = 0; i < kPairs.size(); ++i)
      lengths[i] = (patch.positions[corner[kPairs[i][0]]] - patch.positions[corner[kPairs[i][1]]]).norm();
    patch.lengths.push_back(lengths);
  }
}

/// Marks the ends of the patch's free edges and of lines where a shortest path may turn. (A shortest path also turns at sharp saddle points
/// inside a sheet. That is neglected; the error is local to one node.)
std::vector<std::uint8_t> boundary_nodes(const Patch& patch) {
  std::vector<std::uint8_t> boundary(patch.nodes.size(), 0);
  std::vector<std::pair<std::uint32_t, int>> neighbours;
  for (std::uint32_t node = 0; node < patch.nodes.size(); ++node) {
    neighbours.clear();
    for (std::uint32_t k = patch.node_first[node]; k < patch.node_first[node + 1]; ++k) {
      const auto& corner = patch.shells[patch.node_shells[k]];
      const int count = corner_count(corner);
      if (count < 3) boundary[node] = 1;
      const int at = static_cast<int>(std::find(corner.begin(), corner.begin() + count, node) - corner.begin());
      for (const std::uint32_t other : {corner[(at + 1) % count], corner[(at + count - 1) % count]}) {
        const auto known = std::find_if(neighbours.begin(), neighbours.end(), [&](const auto& n) { return n.first == other; });
        if (known == neighbours.end())
          neighbours.emplace_back(other, 1);
        else
          ++known->second;
      }
    }
    for (const auto& [other, uses] : neighbours) boundary[node] |= uses == 1 ? 1 : 0;
  }
  return boundary;
}

void fill_bends(Patch& patch) {
  constexpr double kReflex =
      kPi * (1 + 0.5 / 180);  // with half a degree of tolerance: nodes of a straight boundary may be slightly out of line
  patch.bends = boundary_nodes(patch);
  for (std::uint32_t node = 0; node < patch.nodes.size(); ++node) {
    if (patch.bends[node] == 0) continue;
    bool on_line = false;
    double angle = 0;
    for (std::uint32_t k = patch.node_first[node]; k < patch.node_first[node + 1]; ++k) {
      const auto& corner = patch.shells[patch.node_shells[k]];
      on_line = on_line || corner_count(corner) < 3;
      angle += corner_angle(patch, patch.node_shells[k], node);
    }
    patch.bends[node] = on_line || angle > kReflex ? 1 : 0;
  }
}

void complete(const Model& model, Patch& patch) {
  fill_positions(model, patch);
  fill_node_shells(patch);
  fill_lengths(patch);
  fill_bends(patch);
  unfold_obtuse_corners(patch);
}

}  // namespace

double corner_angle(const Patch& patch, std::uint32_t shell, std::uint32_t node) {
  const auto& corner = patch.shells[shell];
  const int count = corner_count(corner);
  if (count < 3) return 0;
  const int at = static_cast<int>(std::find(corner.begin(), corner.begin() + count, node) - corner.begin());
  const Vec3 next = patch.positions[corner[(at + 1) % count]] - patch.positions[node];
  const Vec3 previous = patch.positions[corner[(at + count - 1) % count]] - patch.positions[node];
  return deterministic_atan2(next.cross(previous).norm(), next.dot(previous));
}

Patch cut_patch(const Model& model, const ShellSet& shells) {
  Patch patch;
  std::vector<NodeIndex>& nodes = patch.nodes;
  nodes.reserve(4 * shells.size());
  for (const ShellIndex shell : shells)
    for (int i = 0; i < model.shell(shell).corners(); ++i) nodes.push_back(model.shell(shell).node[i]);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const LocalNumbers numbers(nodes);
  patch.shells.reserve(shells.size());
  for (const ShellIndex shell : shells) patch.shells.push_back(local_corners(numbers, model.shell(shell)).corner);
  patch.shell_of = shells;
  complete(model, patch);
  return patch;
}

Patch cut_patch_between(const Model& model, const NodeSet& nodes) {
  Patch patch;
  patch.nodes = nodes;
  patch.rim.assign(nodes.size(), 0);
  const LocalNumbers numbers(nodes);
  patch.shells.reserve(nodes.size() + nodes.size() / 8);
  patch.shell_of.reserve(nodes.size() + nodes.size() / 8);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const ShellIndex shell : model.adjacency->shells_of(nodes[i])) {
      const LocalCorners local = local_corners(numbers, model.shell(shell));
      if (!local.whole) patch.rim[i] = 1;
      // each shell once: from the lowest of its nodes
      if (local.count < 2 || *std::min_element(local.corner.begin(), local.corner.end()) != i) continue;
      patch.shells.push_back(local.corner);
      patch.shell_of.push_back(shell);
    }
  complete(model, patch);
  return patch;
}

}  // namespace prismesh::mesh::spatial
