// Options of a repair.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/relax/options.h"

namespace prismesh::mesh::repair {

struct Options {
  relax::Options relax;
  /// The max moves count from where this model has its nodes, the first of the repaired model's; null: from where that one has them.
  const Model* moves_from = nullptr;
  double max_off_surface = 0.02;     ///< max distance of nodes and diagonals from the surface, as a fraction of the target size
  double max_triangles_percent = 5;  ///< of the whole model; triangles that are there already are allowed
  int max_rounds = 20;
  /// The step at which to stop each piece, as `StoppedAt::steps` of a repair that was stopped; 0 or missing: it isn't stopped.
  std::vector<std::uint64_t> stop_at;
  std::size_t max_threads = 0;  ///< that repair pieces at once; 0: as many as the processor has. The result is the same for any number
};

}  // namespace prismesh::mesh::repair
