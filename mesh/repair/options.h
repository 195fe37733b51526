// Options of a repair.
#pragma once

#include <cstdint>
#include <optional>

#include "mesh/relax/options.h"

namespace prismesh::mesh::repair {

struct Options {
  relax::Options relax;
  double max_off_surface = 0.02;     ///< max distance of nodes and diagonals from the surface, as a fraction of the target size
  double max_triangles_percent = 5;  ///< of the whole model; triangles that are there already are allowed
  int max_rounds = 20;
  std::optional<std::uint64_t> stop_at;  ///< the step at which to stop, as `StoppedAt::step` of a repair that was stopped; from 1
};

}  // namespace prismesh::mesh::repair
