// Keeps the indices of the selected nodes in a texture, one row for each chunk of nodes. A change uploads only the rows of the chunks that
// it touches.
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
  /// Neighbours in a row that are drawn or left out together. Most of them are also neighbours on the sheet.
  static constexpr std::size_t kBlockSize = 256;
  struct Chunk {
    std::uint32_t count = 0;          ///< of indices, at the start of its row
    std::vector<stereo::Box> blocks;  ///< around each kBlockSize nodes, relative to the model's origin
  };

  struct Covered {
    std::vector<std::uint8_t> nodes;       ///< by node: not 0 for those that are left out; beyond the end none is
    std::vector<std::uint32_t> changed{};  ///< chunks of nodes in which others are than before, ascending
  };

  /// Takes over a model. `all`: visibility or origin may have changed. `moved_chunks`: chunks of positions that differ, ascending.
  /// `visible`: gives the visible nodes; called only if parts are hidden and a chunk changed. `covered`: nodes to leave out. Errors: too
  /// large for the GPU, no graphics memory.
  Result<void> update(const ModelTable& table, const mesh::Vec3& origin, bool all, std::span<const std::uint32_t> moved_chunks,
                      const std::function<const std::vector<std::uint8_t>&()>& visible, const Covered* covered = nullptr);

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
