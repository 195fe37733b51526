// Repairing: local changes to the shells' structure, worst first, until they are valid or nothing gets better. Operations, order and
// sources: docs/repairing.md.
#pragma once

#include "base/error.h"
#include "base/progress.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/relax/reference_surface.h"
#include "mesh/repair/options.h"
#include "mesh/repair/repaired.h"
#include "mesh/repair/rules.h"

namespace prismesh::mesh::repair {

/// Repairs the shells of `scope` that fail or warn; their neighbours may change with them, nothing that passes fails afterwards.
/// Deterministic. Errors: cancelled. Preconditions: as of relax; `surface` covers the scope and two rings about it.
Result<Repaired> repair(const Model& model, const relax::ReferenceSurface& surface, const ShellSet& scope, const Rules& rules,
                        const relax::Judge& judge, const Options& options, const Progress& progress = {});

}  // namespace prismesh::mesh::repair
