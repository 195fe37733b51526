// What a repair keeps to.
#pragma once

#include "mesh/relax/options.h"

namespace prismesh::mesh::repair {

struct Options {
  relax::Options relax;
  double most_off_surface = 0.02;     ///< no node or diagonal leaves the surface farther, as a fraction of the target size
  double most_triangles_percent = 5;  ///< of the whole model, unless there are more already
  int most_rounds = 20;
};

}  // namespace prismesh::mesh::repair
