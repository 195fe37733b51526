// The result of an edit for the shells it changes, to show it before it is made.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/quality/shell_state.h"

namespace prismesh::kiosk::render {

struct MeshChange {
  std::vector<mesh::Vec3> points;                     ///< deck coordinates
  std::vector<std::array<std::uint32_t, 4>> corners;  ///< of each shell, into `points`; a triangle repeats its third
  std::vector<mesh::quality::ShellState> states;      ///< of each shell
  std::vector<std::uint8_t> clusters;                 ///< of each shell: bit k: corner k carries the sign of a cluster
  std::vector<mesh::ShellIndex> replaced;             ///< shells of the model that the edit would remove or change
};

}  // namespace prismesh::kiosk::render
