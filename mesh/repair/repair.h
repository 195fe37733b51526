// Repairing: local changes to the shells' structure, worst first, until they are valid or nothing gets better. Operations, order and
// sources: docs/repairing.md.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/model/model.h"
#include "mesh/relax/relax.h"
#include "mesh/repair/operation.h"
#include "mesh/repair/restructuring.h"
#include "mesh/repair/rules.h"

namespace prismesh::mesh::repair {

struct Options {
  relax::Options relax;
  double most_off_surface = 0.02;     ///< no node or diagonal leaves the surface farther, as a fraction of the target size
  double most_triangles_percent = 5;  ///< of the whole model, unless there are more already
  int most_rounds = 20;
};

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

/// One operation by hand: split a shell, or two across their common edge; collapse a shell's shortest edge, two shells' common edge, or the
/// edge between two `nodes`; merge two triangles; swap the edge of two shells. `judge` settles what is left open (which diagonal). Errors:
/// why it can't be done there, as a sentence that ends what the edit says ("shell 12 and shell 40 have no edge in common").
Result<Restructuring> by_hand(const Model& model, const relax::ReferenceSurface& surface, Operation operation,
                              std::span<const ShellIndex> shells, std::span<const NodeIndex> nodes, const Rules& rules,
                              const relax::Judge& judge, const Options& options);

}  // namespace prismesh::mesh::repair
