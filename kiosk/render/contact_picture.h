// What is drawn where shells touch: which shells carry the alerting texture, the curves along which they cross, and the ways out.
#pragma once

#include <array>
#include <vector>

#include "mesh/model/model.h"

namespace prismesh::kiosk::render {

/// Plain data. Indices of the model; those out of range and hidden shells aren't drawn.
struct ContactPicture {
  std::vector<mesh::ShellIndex> chosen;            ///< shells of the chosen region: seen through what hides them
  std::vector<mesh::ShellIndex> shells;            ///< of all other regions
  std::vector<std::array<mesh::Vec3, 2>> curve;    ///< segments, deck coordinates
  std::vector<std::array<mesh::Vec3, 2>> vectors;  ///< from a node to where it must go, deck coordinates
  bool operator==(const ContactPicture&) const = default;
};

}  // namespace prismesh::kiosk::render
