// Relaxing: moves nodes over the surface until edge lengths vary smoothly. Method and source: docs/relaxing.md.
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
  std::vector<Vec3> positions;  ///< of each of them; deck's length unit
  int rounds = 0;
  bool converged = false;
  std::size_t held_back = 0;  ///< nodes that stopped because an element would have got too bad
  std::size_t limited = 0;    ///< nodes that stopped at max_move_on_surface or max_move_on_line
  double farthest = 0;        ///< max displacement; deck's length unit
};

/// Relaxes the `movable` nodes (ascending); every other node stays. Afterwards no metric of a shell fails or warns that didn't before, and
/// the min composite (mesh/quality/composite.h) isn't lower. Deterministic, whatever the number of threads. Errors: cancelled.
/// Precondition: nodes whose coordinates must not change aren't in `movable`.
Result<Relaxed> relax(const RelaxInput& input, const NodeSet& movable, const Progress& progress = {});

/// Relaxes hierarchically: first only the start's node and the nodes about it may move; the neighbours of a node join when it is displaced
/// by more than the threshold. Otherwise as relax.
Result<Relaxed> relax_from(const RelaxInput& input, const SpreadFrom& start, const NodeSet& movable, const Progress& progress = {});

}  // namespace prismesh::mesh::relax
