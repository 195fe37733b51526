// Cost and acceptance tests for a patch change, measured on the shells that it changed, before and after.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "mesh/repair/context.h"

namespace prismesh::mesh::repair {

/// Measures and judges shells by the context's limits, and stores the results in the patch.
void judge_shells(const RepairContext& context, std::span<const LocalShell> shells);

/// The cost of the changed shells. Failing shells cost most, then warnings, adjacent triangles, triangles, and the distance from ideal.
struct Cost {
  double total = 0;
  float worst = 1;  ///< min composite
  int failing = 0;
  int warning = 0;  ///< shells that warn and don't fail
  int triangles = 0;
  int triangle_pairs = 0;  ///< edges between two triangles
};
Cost cost_before(const Patch& patch);  ///< of the shells as they were at Patch::begin
Cost cost_now(const Patch& patch);

/// Whether the mesh conforms at a shell: it isn't there twice and has no node twice, two shells are at each edge inside a sheet, as many as
/// before at each edge of a line, and it doesn't fold.
bool conforms(const Patch& patch, LocalShell shell);

/// Whether the mesh conforms at every changed shell.
bool conforms(const Patch& patch);

/// Whether a shell that passed fails now, or a new one fails while not fewer shells fail than before.
bool adds_failures(const Patch& patch);

/// Whether a new shell fails, or one that passed.
bool has_new_failure(const Patch& patch);

/// Whether the changed shells stay on the surface: no point of their edges and centres is farther off than the options allow, or than the
/// shells before.
bool stays_on_surface(const RepairContext& context);

/// Whether the places that nodes left are still near the changed shells: within a twentieth of the target size. A node that slides off a
/// peak stays on the surface, but cuts the peak off.
bool keeps_peaks(const RepairContext& context);

/// The edges inside sheets between two triangles, ascending; each with its lower node first.
std::vector<std::pair<LocalNode, LocalNode>> pair_edges(const Patch& patch);

}  // namespace prismesh::mesh::repair
