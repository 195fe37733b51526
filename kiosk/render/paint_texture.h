// The paints of parts on the GPU.
#pragma once

#include <cstddef>
#include <span>

#include "kiosk/render/part_paint.h"
#include "kiosk/render/row_texture.h"

namespace prismesh::kiosk::render {

class PaintTexture {
 public:
  /// By PartIndex; parts beyond the end have no paint. Errors: no graphics memory.
  Result<void> set(std::span<const PartPaint> paints);
  /// Sets the uniforms of programs that read kPaint of shaders.cpp. `see_through`: they draw the transparent parts, else the others.
  void use(const gl::Program& program, bool see_through) const;
  std::size_t bytes_held() const { return texture_.bytes_held(); }
  bool any_transparent() const { return any_transparent_; }

 private:
  RowTexture texture_{kOneIndex};
  std::size_t count_ = 0;
  bool any_transparent_ = false;
};

}  // namespace prismesh::kiosk::render
