// Finds the target of a mesh operation: the shell under the pointer, or its edge next to the pointer. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kiosk/input/gestures.h"
#include "kiosk/render/model_source.h"
#include "kiosk/stereo/pointer.h"
#include "mesh/document/edit.h"
#include "mesh/repair/operation.h"

namespace prismesh::kiosk::tools::mesh_operations {

/// What a click means for an operation, by indices of the model.
struct HandTarget {
  std::vector<mesh::ShellIndex> shells;
  std::vector<mesh::NodeIndex> nodes;  ///< an edge's ends, for an operation on the edge itself
  bool operator==(const HandTarget&) const = default;
};

/// For a split: the shell, or the two shells at the edge that the pointer is within a fifth of; for a collapse: the ends of the nearest
/// edge; for a merge and a swap: the shells at it. Nothing where the shell isn't on the picture. Costs a pass over the shells.
std::optional<HandTarget> hand_target(const render::ModelSource& model, const stereo::Aim& aim, mesh::repair::Operation operation,
                                      mesh::ShellIndex shell, const input::Pixel& pixel);

}  // namespace prismesh::kiosk::tools::mesh_operations
