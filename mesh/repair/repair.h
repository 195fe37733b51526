// Repairs shells that fail or warn by local changes of the mesh, worst first, until none is left or nothing gets better. Operations, order
// and sources: docs/repairing.md.
#pragma once

#include "base/error.h"
#include "base/progress.h"
#include "mesh/model/node_set.h"
#include "mesh/repair/repair_input.h"
#include "mesh/repair/repaired.h"

namespace prismesh::mesh::repair {

/// Repairs the shells of `scope` (ascending) that fail or warn. Their neighbours may change with them; no shell that passes fails
/// afterwards. What makes nothing better isn't kept, in each piece: fewer shells fail, or as many and fewer warn or stand at crowded nodes.
/// Returns the change of the model and what was done. When it is stopped, it returns what it has reached by then, which is
/// as valid as a finished repair. Deterministic, whatever the number of threads.
Result<Repaired> repair(const RepairInput& input, const ShellSet& scope, const Progress& progress = {});

}  // namespace prismesh::mesh::repair
