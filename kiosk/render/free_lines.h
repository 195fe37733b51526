// Lines on the GPU between places of their own, which need not be nodes.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "kiosk/render/line_set.h"
#include "mesh/model/model.h"

namespace prismesh::kiosk::render {

class FreeLines {
 public:
  /// Replaces the lines: from place to place, deck coordinates. `origin`: of the model's textures. `what` names them in errors. Errors: too
  /// large for the GPU, no graphics memory.
  Result<void> set(const std::vector<std::array<mesh::Vec3, 2>>& segments, const mesh::Vec3& origin, const char* what);
  void clear() { lines_.count = 0; }

  const LineSet& lines() const { return lines_; }
  const RowTexture& positions() const { return positions_; }
  std::size_t bytes_held() const { return positions_.bytes_held() + lines_.texture.bytes_held(); }
  std::size_t bytes_uploaded() const { return positions_.bytes_uploaded() + lines_.texture.bytes_uploaded(); }

 private:
  RowTexture positions_{kPositionTexel};
  LineSet lines_;
};

}  // namespace prismesh::kiosk::render
