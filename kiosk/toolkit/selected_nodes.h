// The selected nodes of a model as its marks tell them.
#pragma once

#include <cstdint>
#include <optional>

#include "kiosk/render/model_source.h"
#include "mesh/document/generation.h"

namespace prismesh::kiosk::toolkit {

/// Calls `visit(index)` for every selected node.
template <class Visit>
void for_each_selected(const render::ModelSource& model, const Visit& visit) {
  for (std::size_t c = 0; c < model.chunk_count(ipc::SnapshotArray::node_marks); ++c) {
    const auto marks = model.chunk<std::uint8_t>(ipc::SnapshotArray::node_marks, c);
    for (std::size_t i = 0; i < marks.size(); ++i)
      if ((marks[i] & mesh::document::kSelected) != 0) visit(c * mesh::kChunkSize + i);
  }
}

/// The middle of the selected nodes; nothing if none is selected. Costs a pass over the marks.
std::optional<mesh::Vec3> selection_centre(const render::ModelSource& model);

}  // namespace prismesh::kiosk::toolkit
