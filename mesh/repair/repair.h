// Repairing: local changes to the shells' structure, worst first, until they are valid or nothing gets better. Operations, order and
// sources: docs/repairing.md.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/relax/reference_surface.h"
#include "mesh/repair/operation.h"
#include "mesh/repair/options.h"
#include "mesh/repair/restructuring.h"
#include "mesh/repair/rules.h"

namespace prismesh::mesh::repair {

struct Unrepaired {
  ShellIndex shell;  ///< of the model, or node_count()-style new ones: shell_count() + i
  std::string why;   ///< "no operation makes it better", "a neighbour is locked", ...
};
struct Repaired {
  Restructuring change;
  std::array<std::size_t, kOperationCount> done{};  ///< operations that stayed, by Operation
  std::size_t relaxed = 0;                          ///< nodes that moved
  std::size_t bad_before = 0;                       ///< shells of the scope that failed or warned
  std::vector<Unrepaired> unrepaired;               ///< still failing
  int rounds = 0;
};

/// Repairs the shells of `scope` that fail or warn; their neighbours may change with them, nothing that passes fails afterwards.
/// Deterministic. Errors: cancelled. Preconditions: as of relax; `surface` covers the scope and two rings about it.
Result<Repaired> repair(const Model& model, const relax::ReferenceSurface& surface, const ShellSet& scope, const Rules& rules,
                        const relax::Judge& judge, const Options& options, const Progress& progress = {});

}  // namespace prismesh::mesh::repair
