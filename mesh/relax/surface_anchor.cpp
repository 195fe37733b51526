#include "mesh/relax/surface_anchor.h"

#include <optional>

#include "mesh/model/adjacency.h"
#include "mesh/relax/sheet_fits.h"

namespace prismesh::mesh::relax {

namespace {

constexpr double kOnSurface = 0.25;  ///< of the size: a node that is farther from the surface is not on it
constexpr double kReach = 8;         ///< sizes that a node may be away from its position on the reference
constexpr double kOnFeature = 1e-3;  ///< of the size: a node that is nearer to a line or corner is on it
constexpr double kNoFeature = 1e-2;  ///< of the size: a node that is farther from every line is on none

/// A node, and whether the reference's node of the same index is the same node and not far off. That is so within a document, but not for a
/// patch cut out of it, which has node indices of its own.
struct NodeOnReference {
  const Model& model;
  const ReferenceSurface& surface;
  NodeIndex node;
  Vec3 point;
  double size;
  bool is_known;

  NodeOnReference(const Model& in, const ReferenceSurface& on, NodeIndex which)
      : model(in), surface(on), node(which), point(in.position(which)), size(mean_edge(in, which)) {
    const Model& reference = on.model();
    const double reach = kReach * size;
    is_known = node.value < reference.node_count() && node.value < in.node_ids.size() &&
               in.node_ids[node.value] == reference.node_ids[node.value] && !reference.is_removed(node) &&
               (reference.position(node) - point).squaredNorm() <= reach * reach && !reference.adjacency->shells_of(node).empty();
  }
};

/// The nearest point on the feature lines at the reference's node.
std::optional<OnLine> line_at(const NodeOnReference& at) {
  std::optional<OnLine> best;
  for (const NodeIndex other : at.surface.lines_at(at.node)) {
    const OnLine line = at.surface.follow_line(at.node, other, at.point);
    if (!best || line.distance < best->distance) best = line;
  }
  return best;
}

bool is_on_line(const NodeOnReference& at) {
  const std::optional<OnLine> line = line_at(at);
  return line && line->distance <= kOnFeature * at.size;
}

/// The freedom by the surface's creases: those of the mesh change as its nodes move over a curved surface.
Freedom freedom_there(const NodeOnReference& at, double feature_cos) {
  const Freedom by_mesh = freedom_of(at.model, at.node, feature_cos);
  if (!at.is_known) return by_mesh;
  const Freedom on_surface = at.surface.freedom_at(at.node);
  if (on_surface == Freedom::surface && by_mesh == Freedom::surface) return Freedom::surface;
  if (on_surface == Freedom::fixed && (at.surface.model().position(at.node) - at.point).norm() <= kOnFeature * at.size)
    return Freedom::fixed;
  const Freedom by_borders = freedom_by_borders(at.model, at.node, feature_cos);
  if (by_borders == Freedom::fixed) return Freedom::fixed;
  if (on_surface == Freedom::line && is_on_line(at)) return Freedom::line;
  if (by_borders == Freedom::surface && !at.surface.find_line(at.point, kNoFeature * at.size)) return Freedom::surface;
  return by_mesh;
}

}  // namespace

SurfaceAnchor find_anchor(const Model& model, const ReferenceSurface& surface, NodeIndex node, double feature_cos) {
  if (model.adjacency->shells_of(node).empty() || !model.position(node).allFinite()) return {};
  const NodeOnReference at(model, surface, node);
  const Freedom freedom = freedom_there(at, feature_cos);
  if (freedom == Freedom::fixed) return {};
  const double near = kOnSurface * at.size;
  if (freedom == Freedom::line) {
    std::optional<OnLine> line;
    if (at.is_known) line = line_at(at);
    if (!line || line->distance > near) line = surface.find_line(at.point, near);
    return line ? SurfaceAnchor{freedom, {}, line->from, line->to, line->tangent, line->size} : SurfaceAnchor();
  }
  std::optional<OnSurface> on;
  if (at.is_known) on = surface.follow(surface.model().adjacency->shells_of(node).front(), at.point);
  if (!on || on->distance > near) on = surface.project(at.point, near);
  return on ? SurfaceAnchor{freedom, on->shell, {}, {}, on->normal, on->size} : SurfaceAnchor();
}

Vec3 move_anchor(const ReferenceSurface& surface, const Vec3& point, SurfaceAnchor& anchor) {
  if (anchor.freedom == Freedom::line) {
    const OnLine on = surface.follow_line(anchor.from, anchor.to, point);
    anchor.from = on.from;
    anchor.to = on.to;
    if (on.tangent.squaredNorm() > 0) anchor.direction = on.tangent;
    return on.point;
  }
  const OnSurface on = surface.follow(anchor.shell, point);
  anchor.shell = on.shell;
  anchor.direction = on.normal;
  return on.point;
}

}  // namespace prismesh::mesh::relax
