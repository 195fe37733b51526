// The selected nodes as the GPU draws them: for each chunk of nodes a row of indices, so that a change costs the chunks it touches.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kiosk/render/model_table.h"
#include "kiosk/render/row_texture.h"

namespace prismesh::kiosk::render {

class SelectionRows {
 public:
  /// What is drawn or left out together: neighbours in the row, which mostly are neighbours on the sheet.
  static constexpr std::size_t kBlockSize = 256;
  struct Chunk {
    std::uint32_t count = 0;          ///< of its row's first indices
    std::vector<stereo::Box> blocks;  ///< around each kBlockSize of them, from the model's origin
  };

  /// Takes over a model. `all`: visibility or origin may have changed; `moved_chunks`: chunks of positions that differ, ascending;
  /// `visible`: asked where parts are hidden only, by chunks that changed. Errors: too large for the GPU.
  Result<void> update(const ModelTable& table, const mesh::Vec3& origin, bool all, std::span<const std::uint32_t> moved_chunks,
                      const std::function<const std::vector<std::uint8_t>&()>& visible);

  std::size_t count() const { return count_; }
  const std::vector<Chunk>& chunks() const { return chunks_; }
  /// One index a texel, kOneIndex.
  const RowTexture& texture() const { return texture_; }

 private:
  struct Known {
    std::uint64_t version = 0;
    bool known = false;
  };
  std::vector<Known> known_;
  std::vector<Chunk> chunks_;
  RowTexture texture_{kOneIndex};
  std::size_t count_ = 0;
};

}  // namespace prismesh::kiosk::render
