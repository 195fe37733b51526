#include "mesh/connections/check_welds.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>

#include "base/parallel_for.h"
#include "mesh/connections/find_joined_sheets.h"
#include "mesh/connections/nodes_on_sheets.h"
#include "mesh/connections/sheet_reach.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::connections {

namespace {

bool is_line(ElementClass element_class) { return element_class == ElementClass::beam || element_class == ElementClass::discrete; }

double distance_to_segment(const Vec3& point, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0 ? std::clamp((point - a).dot(along) / length2, 0.0, 1.0) : 0;
  return (point - (a + share * along)).norm();
}

/// The nearest free edge of shells of these parts within the distance.
std::optional<double> free_edge_within(const Model& model, const spatial::BoxTree& tree, const Vec3& point, double distance,
                                       const std::vector<PartIndex>& parts) {
  std::optional<double> nearest;
  tree.near_box(point, point, distance, [&](ShellIndex shell, const spatial::FloatBox&) {
    if (!std::binary_search(parts.begin(), parts.end(), model.shell_parts[shell.value])) return true;
    const ShellNodes& nodes = model.shell(shell);
    for (int k = 0; k < nodes.corners(); ++k) {
      const NodeIndex a = nodes.node[static_cast<std::size_t>(k)], b = nodes.node[static_cast<std::size_t>((k + 1) % nodes.corners())];
      const EdgeIndex edge = model.adjacency->find_edge(a, b);
      if (!edge.valid() || model.adjacency->shells_of(edge).size() != 1) continue;
      const double found = distance_to_segment(point, model.position(a), model.position(b));
      if (found < distance && (!nearest || found < *nearest)) nearest = found;
    }
    return true;
  });
  return nearest;
}

/// The nearest two welds of the same sheets, by a sweep along x.
void find_neighbours(std::vector<CheckedWeld>& welds, double pitch) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t w = 0; w < welds.size(); ++w)
    if (welds[w].joined && welds[w].at.allFinite()) order.push_back(w);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::tuple(welds[a].at.x(), a) < std::tuple(welds[b].at.x(), b); });
  const auto note = [&](std::uint32_t of, std::uint32_t other, double distance) {
    CheckedWeld& weld = welds[of];
    if (weld.neighbour && weld.neighbour_distance <= distance) return;
    weld.neighbour = other;
    weld.neighbour_distance = distance;
  };
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size() && welds[order[j]].at.x() - welds[order[i]].at.x() < pitch; ++j) {
      const CheckedWeld &a = welds[order[i]], &b = welds[order[j]];
      const double distance = (a.at - b.at).norm();
      if (!(distance < pitch) || a.sheets != b.sheets) continue;
      note(order[i], order[j], distance);
      note(order[j], order[i], distance);
    }
}

}  // namespace

std::vector<CheckedWeld> check_welds(const Model& model, const spatial::BoxTree& tree, std::span<const ElementUse> uses,
                                     const WeldCheckOptions& options) {
  const std::vector<NodeOnSheet> placed = find_weld_nodes(model, uses);
  const auto is_placed = [&](NodeIndex node) {
    const auto at =
        std::lower_bound(placed.begin(), placed.end(), node, [](const NodeOnSheet& each, NodeIndex wanted) { return each.node < wanted; });
    return at != placed.end() && at->node == node;
  };
  const std::vector<Joint> joints = possible_joints(model, {});
  const auto joined = joined_by_each(model, joints, {});
  std::vector<CheckedWeld> welds;
  std::vector<std::uint32_t> joint_of;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const Joint& joint = joints[j];
    const bool may_be = joint.element_class != ElementClass::other && std::all_of(joint.ends.begin(), joint.ends.end(), is_placed);
    if (joined[j].empty() && !may_be) continue;
    CheckedWeld weld;
    weld.element_class = *joint.element_class;
    weld.element = static_cast<std::uint32_t>(joint.of);
    for (const NodeIndex node : joint.ends) weld.at += model.position(node) / static_cast<double>(joint.ends.size());
    weld.joined = !joined[j].empty();
    for (const auto& [a, b] : joined[j])
      for (const ShellIndex shell : {a, b}) weld.sheets.push_back(model.shell_parts[shell.value]);
    std::sort(weld.sheets.begin(), weld.sheets.end());
    weld.sheets.erase(std::unique(weld.sheets.begin(), weld.sheets.end()), weld.sheets.end());
    welds.push_back(std::move(weld));
    joint_of.push_back(static_cast<std::uint32_t>(j));
  }
  parallel_for(welds.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t w = begin; w < end; ++w) {
      CheckedWeld& weld = welds[w];
      if (!weld.joined || is_line(weld.element_class))
        for (const NodeIndex node : joints[joint_of[w]].ends) {
          if (!model.adjacency->shells_of(node).empty()) continue;
          const auto on = tree.closest(model.position(node));
          if (on && on->distance <= sheet_reach(model, on->shell, Attachment::placed)) continue;
          const double by = on ? on->distance : std::numeric_limits<double>::infinity();
          if (weld.loose_by && *weld.loose_by >= by) continue;
          weld.loose_by = by;
          weld.loose_end = node;
        }
      if (weld.joined && options.min_edge_distance > 0 && weld.at.allFinite())
        weld.edge_distance = free_edge_within(model, tree, weld.at, options.min_edge_distance, weld.sheets);
    }
  });
  if (options.min_pitch > 0) find_neighbours(welds, options.min_pitch);
  return welds;
}

}  // namespace prismesh::mesh::connections
