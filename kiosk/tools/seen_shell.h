// Shells as the pointer meets them on the picture. What picking an axis and picking a place for an operation share.
#pragma once

#include <algorithm>

#include "kiosk/render/model_source.h"
#include "kiosk/tools/gestures.h"

namespace prismesh::kiosk::tools {

/// Whether all of a shell's nodes are the model's: nothing in a snapshot is trusted.
inline bool is_whole(const render::ModelSource& model, const mesh::ShellNodes& shell) {
  const std::size_t nodes = model.size(ipc::SnapshotArray::positions);
  return std::all_of(shell.node.begin(), shell.node.end(), [&](mesh::NodeIndex node) { return node.value < nodes; });
}

/// Pixels from the line between two places of the picture.
inline double pixels_from_line(const Pixel& from, const Pixel& to, const Pixel& pixel) {
  const Pixel way = to - from;
  const double length = way.squaredNorm(), share = length > 0 ? std::clamp((pixel - from).dot(way) / length, 0.0, 1.0) : 0;
  return (pixel - (from + share * way)).norm();
}

}  // namespace prismesh::kiosk::tools
