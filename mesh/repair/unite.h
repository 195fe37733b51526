// Unites nodes, so that edges and shells between them go. Refusals as in redivide.h.
#pragma once

#include <optional>
#include <vector>

#include "mesh/repair/context.h"
#include "mesh/repair/reshaping.h"

namespace prismesh::mesh::repair {

/// Each first node becomes the second of its pair, which takes the place given: shells between them go, quads at an end become triangles.
struct Union {
  LocalNode gone;
  LocalNode stays;
};
Refusal unite(const RepairContext& context, const std::vector<Union>& unions);
/// The pair in the order in which it can be united, and null if in none.
std::optional<Union> union_of(const RepairContext& context, LocalNode a, LocalNode b);

}  // namespace prismesh::mesh::repair
