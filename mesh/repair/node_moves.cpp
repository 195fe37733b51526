#include "mesh/repair/node_moves.h"

#include <algorithm>

#include "mesh/repair/local_size.h"
#include "mesh/repair/patch_geometry.h"
#include "mesh/repair/placement.h"

namespace prismesh::mesh::repair {

Refusal mark_neighbourhood_changed(const RepairContext& context, LocalShell shell) {
  Patch& patch = context.patch;
  std::vector<LocalNode> nodes;
  for (const LocalNode corner : patch.shell(shell).corners)
    for (const LocalShell near : patch.node(corner).shells)
      for (const LocalNode node : patch.shell(near).corners) nodes.push_back(node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  for (const LocalNode node : nodes) patch.move(node, patch.position(node), patch.node(node).is_off_surface);
  return std::nullopt;
}

Refusal lift_node(const RepairContext& context, LocalNode node, double distance) {
  const PatchNode& n = context.patch.node(node);
  if (!n.is_whole || n.freedom != relax::Freedom::surface || !n.lines.empty() || (n.rules & kStays) != 0) return "the node can't be moved";
  Vec3 normal = Vec3::Zero();
  for (const LocalShell shell : n.shells) {
    const Vec3 own = area_normal(context.patch, context.patch.shell(shell).corners);
    normal += normal.dot(own) < 0 ? Vec3(-own) : own;
  }
  const double length = normal.norm();
  if (!(length > 0)) return "the node can't be moved";
  const auto place = context.surface.project(n.position, target_size_at(context, node), Vec3(normal / length));
  if (!place) return "the node isn't near the surface";
  const Vec3 lifted = place->point + distance * (normal / length);
  if (!within_limit(context, node, lifted)) return "a node would go farther than it may";
  context.patch.move(node, lifted, true);
  return std::nullopt;
}

}  // namespace prismesh::mesh::repair
