// A turn about an axis.
#pragma once

#include <optional>

#include "mesh/model/model.h"

namespace prismesh::mesh::shape {

struct Axis {
  Vec3 point = Vec3::Zero();      ///< any point on it
  Vec3 direction = Vec3::Zero();  ///< of length 1
};

struct Rotation {
  Axis axis;
  double degrees = 0;              ///< right-handed; of a node with weight 1
  std::optional<double> max_move;  ///< no node ends farther from its start, in a straight line; deck's length unit
};

}  // namespace prismesh::mesh::shape
