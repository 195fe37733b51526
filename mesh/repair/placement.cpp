#include "mesh/repair/placement.h"

namespace prismesh::mesh::repair {

std::optional<Vec3> on_surface(const RepairContext& context, const Vec3& point, const Vec3& toward, double radius) {
  const std::optional<Vec3> direction = toward.squaredNorm() > 0 ? std::optional<Vec3>(toward.normalized()) : std::nullopt;
  const auto place = context.surface.project(point, radius, direction);
  return place && place->point.allFinite() ? std::optional<Vec3>(place->point) : std::nullopt;
}

std::optional<Vec3> move_origin(const RepairContext& context, LocalNode node) {
  const NodeIndex index = context.patch.node(node).model;
  const Model& from = context.options.moves_from != nullptr ? *context.options.moves_from : context.patch.model();
  return index.valid() && index.value < from.node_count() ? std::optional<Vec3>(from.position(index)) : std::nullopt;
}

bool within_limit(const RepairContext& context, LocalNode node, const Vec3& place) {
  const PatchNode& n = context.patch.node(node);
  const std::optional<double>& max_move =
      n.lines.empty() ? context.options.relax.max_move_on_surface : context.options.relax.max_move_on_line;
  const std::optional<Vec3> origin = move_origin(context, node);
  return !origin || !max_move || (place - *origin).norm() <= *max_move;
}

}  // namespace prismesh::mesh::repair
