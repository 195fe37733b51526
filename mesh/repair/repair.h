// Repairing: local changes to the shells' structure, worst first, until they are valid or nothing gets better. Operations, order and
// sources: docs/repairing.md.
#pragma once

#include "base/error.h"
#include "base/progress.h"
#include "mesh/model/node_set.h"
#include "mesh/repair/repair_input.h"
#include "mesh/repair/repaired.h"

namespace prismesh::mesh::repair {

/// Repairs the shells of `scope` that fail or warn; their neighbours may change with them, nothing that passes fails afterwards.
/// Deterministic. Errors: cancelled. Preconditions: as of relax.
Result<Repaired> repair(const RepairInput& input, const ShellSet& scope, const Progress& progress = {});

}  // namespace prismesh::mesh::repair
