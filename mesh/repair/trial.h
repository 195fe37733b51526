// Tries the candidates for a shell and keeps the best acceptable one.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/repair/candidates.h"
#include "mesh/repair/repair_state.h"

namespace prismesh::mesh::repair {

enum class TrialGoal : std::uint8_t {
  cure,   ///< a shell that fails or warns
  split,  ///< a quad that fails and that nothing else helps: in two, whose nodes stay and which may be adjacent to other triangles
  heal,   ///< a shell that fails and that nothing else helps: by any single operation as by hand, with no more than its conditions
  tidy,   ///< triangles, where nothing fails or warns more than before
};

/// Tries the candidates in two stages: all of them with little smoothing, then the most promising in full. Applies the best acceptable one
/// and records it, or records why there is none. Returns whether one was applied.
bool improve(const RepairContext& context, RepairState& state, const std::vector<Candidate>& candidates, LocalShell shell, TrialGoal goal);

}  // namespace prismesh::mesh::repair
