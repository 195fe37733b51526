// The passes of a repair: each goes over the patch once and keeps the changes that make it better.
#pragma once

#include "mesh/quality/shell_state.h"
#include "mesh/repair/context.h"
#include "mesh/repair/repair_state.h"

namespace prismesh::mesh::repair {

// What a pass takes of its round's progress, as a share.
inline constexpr double kStripShare = 0.2, kSweepShare = 0.4;

/// Divides or removes whole strips of quads where shells are long or short across, and relaxes after each pass that helped. Returns
/// whether one did.
bool divide_strips(const RepairContext& context, RepairState& state);

/// Takes triangles away from nodes with too many about them (mesh/repair/clusters.h). Returns whether a change was kept.
bool repair_clusters(const RepairContext& context, RepairState& state);

/// Tries all candidates for each shell whose grade is `min_grade` or worse, worst first. `done`: share of the round done before. Returns
/// whether a shell got better.
bool cure_shells(const RepairContext& context, RepairState& state, quality::Grade min_grade, double done);

/// Splits each failing quad whose halves pass, worst first, along the diagonal across which it is bent more, even if the halves are next to
/// other triangles. Then joins or separates these. For quads that nothing else helps. Returns whether one was split.
bool split_failing_quads(const RepairContext& context, RepairState& state);

/// Tries on each failing shell what a single operation by hand can do, with no more than its conditions: fewer shells fail, and none newly.
/// Begins again until nothing helps. For shells that nothing else helps. Returns whether one was healed.
bool heal_failing_shells(const RepairContext& context, RepairState& state);

/// Joins or separates triangles that the repair made, where nothing gets worse. `done`: share of the round done before.
void tidy_triangles(const RepairContext& context, RepairState& state, double done);

/// Relaxes the nodes of shells that are bad or were changed, and those about them.
void relax_neighbourhood(const RepairContext& context, RepairState& state);

}  // namespace prismesh::mesh::repair
