#include "kiosk/tools/pen/touched.h"

#include <algorithm>
#include <utility>

#include "kiosk/toolkit/seen_shell.h"
#include "mesh/spatial/point_triangle.h"

namespace prismesh::kiosk::tools::pen {
namespace {

using ipc::SnapshotArray;
using mesh::NodeIndex;
using mesh::ShellIndex;
using mesh::ShellNodes;

std::array<Vec3, 4> corners_of(const render::ModelSource& model, const ShellNodes& shell) {
  std::array<Vec3, 4> corners;
  for (std::size_t i = 0; i < 4; ++i) corners[i] = model.at<Vec3>(SnapshotArray::positions, shell.node[i].value);
  return corners;
}

std::size_t corner_count(const ShellNodes& shell) { return shell.is_triangle() ? 3 : 4; }

struct NearNode {
  double distance2 = 0;
  std::uint32_t node = 0;
};

std::vector<NearNode> nodes_near(const render::ModelSource& model, const Vec3& at, double reach) {
  std::vector<NearNode> near;
  for (std::size_t c = 0; c < model.chunk_count(SnapshotArray::positions); ++c) {
    const auto positions = model.chunk<Vec3>(SnapshotArray::positions, c);
    for (std::size_t i = 0; i < positions.size(); ++i)
      if (const double distance2 = (positions[i] - at).squaredNorm(); distance2 <= reach * reach)
        near.push_back({distance2, static_cast<std::uint32_t>(c * mesh::kChunkSize + i)});
  }
  return near;
}

}  // namespace

std::optional<ShellIndex> touched_shell(const render::ModelSource& model, std::int32_t element, const Vec3& at, double reach) {
  if (element < 0 || static_cast<std::size_t>(element) >= model.size(SnapshotArray::shell_nodes)) return std::nullopt;
  const ShellIndex index(static_cast<std::uint32_t>(element));
  const auto shell = model.at<ShellNodes>(SnapshotArray::shell_nodes, index.value);
  if (!toolkit::is_whole(model, shell)) return std::nullopt;
  const std::array<Vec3, 4> p = corners_of(model, shell);
  double distance2 = mesh::spatial::closest_on_triangle({p[0], p[1], p[2]}, at).distance2;
  if (!shell.is_triangle()) distance2 = std::min(distance2, mesh::spatial::closest_on_triangle({p[0], p[2], p[3]}, at).distance2);
  return distance2 <= reach * reach ? std::optional(index) : std::nullopt;
}

NodeIndex nearest_corner(const render::ModelSource& model, ShellIndex shell, const Vec3& at) {
  const auto nodes = model.at<ShellNodes>(SnapshotArray::shell_nodes, shell.value);
  const std::array<Vec3, 4> p = corners_of(model, nodes);
  std::size_t best = 0;
  for (std::size_t i = 1; i < corner_count(nodes); ++i)
    if ((p[i] - at).squaredNorm() < (p[best] - at).squaredNorm()) best = i;
  return nodes.node[best];
}

std::vector<std::array<Vec3, 2>> edges_of(const render::ModelSource& model, ShellIndex shell) {
  const auto nodes = model.at<ShellNodes>(SnapshotArray::shell_nodes, shell.value);
  const std::array<Vec3, 4> p = corners_of(model, nodes);
  const std::size_t count = corner_count(nodes);
  std::vector<std::array<Vec3, 2>> edges;
  for (std::size_t i = 0; i < count; ++i) edges.push_back({p[i], p[(i + 1) % count]});
  return edges;
}

std::optional<NodeIndex> nearest_node(const render::ModelSource& model, const Vec3& at, double reach) {
  std::vector<NearNode> near = nodes_near(model, at, reach);
  if (near.empty()) return std::nullopt;
  std::sort(near.begin(), near.end(), [](const NearNode& a, const NearNode& b) { return a.node < b.node; });
  std::optional<NearNode> best;
  for (std::size_t c = 0; c < model.chunk_count(SnapshotArray::shell_nodes); ++c) {
    const auto shells = model.chunk<ShellNodes>(SnapshotArray::shell_nodes, c);
    for (std::size_t s = 0; s < shells.size(); ++s)
      for (const NodeIndex corner : shells[s].node) {
        if (corner.value < near.front().node || corner.value > near.back().node) continue;
        const auto found = std::lower_bound(near.begin(), near.end(), corner.value,
                                            [](const NearNode& each, std::uint32_t node) { return each.node < node; });
        if (found->node != corner.value || (best && best->distance2 <= found->distance2)) continue;
        const auto part = model.at<mesh::PartIndex>(SnapshotArray::shell_parts, c * mesh::kChunkSize + s);
        if (part.value >= model.part_count() || !model.part_hidden(part.value)) best = *found;
      }
  }
  return best ? std::optional(NodeIndex(best->node)) : std::nullopt;
}

}  // namespace prismesh::kiosk::tools::pen
