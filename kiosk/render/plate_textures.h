// The plates of a model's shells on the GPU (plate_shape.h). Nothing is computed until they are drawn.
#pragma once

#include <vector>

#include "kiosk/render/model_textures.h"
#include "kiosk/render/plate_shape.h"
#include "kiosk/render/row_texture.h"

namespace prismesh::kiosk::render {

class PlateTextures {
 public:
  /// Takes note of what has changed, for the next update.
  void note(const ModelChanges& changes);
  /// Computes and uploads what has changed: after moves of nodes the chunks around them, else a pass over the model. Errors: too large for
  /// the GPU, no graphics memory.
  Result<void> update(const ModelTable& table);

  /// A row for each shell.
  const RowTexture& rows() const { return rows_; }
  /// The bits of a float for each part.
  const RowTexture& thicknesses() const { return thickness_texture_; }
  std::size_t part_count() const { return thicknesses_.size(); }
  /// Of all parts, deck's length unit.
  double max_thickness() const;
  std::size_t bytes_uploaded() const { return rows_.bytes_uploaded() + thickness_texture_.bytes_uploaded(); }
  std::size_t bytes_held() const { return rows_.bytes_held() + thickness_texture_.bytes_held(); }

 private:
  void upload_chunk(std::size_t chunk);

  PlateShape shape_;
  RowTexture rows_{kFourIndices};
  RowTexture thickness_texture_{kOneIndex};
  std::vector<float> thicknesses_;
  bool stale_ = true;
  std::vector<std::uint32_t> moved_chunks_;
};

}  // namespace prismesh::kiosk::render
