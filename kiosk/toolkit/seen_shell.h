// Tests of shells and edges under the pointer.
#pragma once

#include <algorithm>

#include "kiosk/input/gestures.h"
#include "kiosk/render/model_source.h"

namespace prismesh::kiosk::toolkit {

/// Whether all nodes of a shell exist in the model; snapshots aren't trusted.
inline bool is_whole(const render::ModelSource& model, const mesh::ShellNodes& shell) {
  const std::size_t nodes = model.size(ipc::SnapshotArray::positions);
  return std::all_of(shell.node.begin(), shell.node.end(), [&](mesh::NodeIndex node) { return node.value < nodes; });
}

/// Distance in pixels from the line between two points of the picture.
inline double pixels_from_line(const input::Pixel& from, const input::Pixel& to, const input::Pixel& pixel) {
  const input::Pixel way = to - from;
  const double length = way.squaredNorm(), share = length > 0 ? std::clamp((pixel - from).dot(way) / length, 0.0, 1.0) : 0;
  return (pixel - (from + share * way)).norm();
}

}  // namespace prismesh::kiosk::toolkit
