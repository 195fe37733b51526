// Where a repair may put a node.
#pragma once

#include <optional>

#include "mesh/repair/context.h"

namespace prismesh::mesh::repair {

/// The point of the surface nearest to `point` on a sheet with about the normal `toward` (any length; zero: any sheet); nothing if there is
/// none within `radius`.
std::optional<Vec3> on_surface(const RepairContext& context, const Vec3& point, const Vec3& toward, double radius);

/// Where the max move of a node counts from; nothing: it is a new one.
std::optional<Vec3> move_origin(const RepairContext& context, LocalNode node);

/// Whether a node may be put at `place`: a node of the model only within its max move.
bool within_limit(const RepairContext& context, LocalNode node, const Vec3& place);

}  // namespace prismesh::mesh::repair
