// Collapses edges and diagonals: two nodes become one, and the shells between them are removed. Refusals: as in redivide.h.
#pragma once

#include <optional>
#include <vector>

#include "mesh/repair/context.h"
#include "mesh/repair/reshaping.h"

namespace prismesh::mesh::repair {

/// A node that is removed, and the one that takes its place.
struct Collapse {
  LocalNode removed;
  LocalNode kept;
};
/// Carries out collapses together: shells that lose a second corner are removed, and quads that lose one become triangles. A kept node that
/// may move goes to the middle.
Refusal collapse_nodes(const RepairContext& context, const std::vector<Collapse>& collapses);
/// The collapse of two nodes in the direction that is possible: the less constrained node is removed; nothing if both must stay.
std::optional<Collapse> collapse_of(const RepairContext& context, LocalNode a, LocalNode b);

}  // namespace prismesh::mesh::repair
