// Lines on the GPU.
#pragma once

#include <cstddef>
#include <vector>

#include "base/error.h"
#include "kiosk/render/outline.h"
#include "kiosk/render/row_texture.h"

namespace prismesh::kiosk::render {

/// Lines as a texture of node pairs.
struct LineSet {
  RowTexture texture{kTwoIndices};
  std::size_t count = 0;
  /// Replaces the lines. `what` names them in errors. Errors: too large for the GPU, no graphics memory.
  Result<void> upload(const std::vector<NodePair>& lines, const char* what);
};

}  // namespace prismesh::kiosk::render
