// Cost and acceptance tests for a patch change, measured on the shells that it changed, before and after.
#pragma once

#include <span>

#include "mesh/repair/context.h"

namespace prismesh::mesh::repair {

/// Measures and judges shells as they are now.
void judge_shells(const RepairContext& context, std::span<const LocalShell> shells);

/// What the changed shells weigh: failing shells most, then warnings, adjacent triangles, triangles, and how far from ideal each is.
struct Cost {
  double weight = 0;
  float worst = 1;  ///< least composite
  int failing = 0;
  int warning = 0;  ///< not failing
  int triangles = 0;
  int triangle_pairs = 0;  ///< edges between two triangles
};
Cost cost_before(const Patch& patch);
Cost cost_now(const Patch& patch);

/// Whether the mesh is whole: no shell twice or with a node twice, every edge inside a sheet has two shells, every line as many as it had,
/// and nothing is folded over.
bool conforms(const Patch& patch);

/// Whether a shell that passed fails now, or a new one fails without another being cured.
bool harms(const Patch& patch);

/// Whether what changed keeps to the surface: no new edge or centre farther off than allowed, or than what was there before.
bool keeps_to_surface(const RepairContext& context);

}  // namespace prismesh::mesh::repair
