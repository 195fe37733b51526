// Relaxing: nodes find better places on the surface they are on. Method and source: docs/relaxing.md.
#pragma once

#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/relax/relax_input.h"

namespace prismesh::mesh::relax {

struct Relaxed {
  NodeSet nodes;                ///< that moved
  std::vector<Vec3> positions;  ///< of each
  int rounds = 0;
  bool converged = false;
  std::size_t held_back = 0;  ///< nodes that would have made an element worse than it may become
  std::size_t limited = 0;    ///< nodes that stopped at most_on_surface or most_on_line
  double farthest = 0;        ///< the greatest displacement
};

/// Relaxes `movable` nodes; every other node stays. Deterministic, whatever the number of threads. Afterwards no metric of a shell fails or
/// warns that didn't, and the least composite (mesh/quality/composite.h) isn't lower. Errors: cancelled.
/// Preconditions: the model has its adjacency; nodes whose coordinates mustn't change aren't in `movable`; `surface` covers the shells
/// that touch it.
Result<Relaxed> relax(const RelaxInput& input, const NodeSet& movable, const Progress& progress = {});

/// Hierarchical: begins with the start's node and the nodes around it; the neighbours of a node join while it is displaced by more than the
/// threshold. Otherwise as relax.
Result<Relaxed> relax_from(const RelaxInput& input, const SpreadFrom& start, const NodeSet& movable, const Progress& progress = {});

}  // namespace prismesh::mesh::relax
