// Where a repair may place a node.
#pragma once

#include <optional>

#include "mesh/repair/context.h"

namespace prismesh::mesh::repair {

/// The place on the surface for a point near it; nothing if there is none close by.
std::optional<Vec3> on_surface(const RepairContext& context, const Vec3& point, const Vec3& toward, double radius);

/// Whether a node may be at a place: one of the model no farther from where it was than the options allow.
bool within_limit(const RepairContext& context, LocalNode node, const Vec3& place);

}  // namespace prismesh::mesh::repair
