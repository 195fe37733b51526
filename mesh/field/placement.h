// The map from the model into the pen's space: a turn, a shift and one scale.
#pragma once

#include <Eigen/Core>

#include "mesh/model/model.h"

namespace prismesh::mesh::field {

/// pen_mm = scale * turn * position + shift_mm. The scale holds both the deck's length unit and the scaling of the workspace: millimetres
/// of the pen for one length of the deck.
struct Placement {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< a rotation
  Vec3 shift_mm = Vec3::Zero();
  double scale = 1;  ///< above 0

  Vec3 to_pen(const Vec3& position) const { return scale * (turn * position) + shift_mm; }
  Vec3 to_model(const Vec3& pen_mm) const { return turn.transpose() * (pen_mm - shift_mm) / scale; }
};

}  // namespace prismesh::mesh::field
