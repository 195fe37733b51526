// A plane that cuts the model away on one side, and the curves in which it cuts the shells.
#pragma once

#include <array>
#include <vector>

#include "mesh/model/model.h"

namespace prismesh::kiosk::render {

/// Plain data, deck coordinates. What lies above the plane, along its normal, is neither drawn nor picked.
struct CutPicture {
  mesh::Vec3 point = mesh::Vec3::Zero();
  mesh::Vec3 normal = mesh::Vec3::UnitX();            ///< unit
  std::vector<std::array<mesh::Vec3, 2>> segments{};  ///< of the curves
  std::vector<std::array<mesh::Vec3, 2>> beside{};    ///< of the curves on the model of the other view

  bool takes_away(const mesh::Vec3& at) const { return (at - point).dot(normal) > 0; }
};

}  // namespace prismesh::kiosk::render
