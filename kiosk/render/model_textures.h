// Keeps the model on the GPU. Uploads only what changed since the last snapshot.
#pragma once

#include <array>
#include <vector>

#include "kiosk/render/model_table.h"
#include "kiosk/render/row_texture.h"

namespace prismesh::kiosk::render {

/// What an update changed.
struct ModelChanges {
  bool topology = false;                     ///< shells, their nodes, or the number of nodes
  bool visibility = false;                   ///< hidden parts
  bool reparted = false;                     ///< shells are in other parts
  std::vector<std::uint32_t> moved_chunks;   ///< of positions, ascending
  std::vector<std::uint32_t> marked_chunks;  ///< of nodes whose marks differ, ascending
  std::size_t uploaded = 0;                  ///< rows
};

/// The first of two words for each shell in `surface`: colour, grade, marks. The second is the packed normal.
namespace shell_word {
inline constexpr std::uint32_t kColourMask = 31;
inline constexpr std::uint32_t kGradeShift = 5;  ///< two bits
inline constexpr std::uint32_t kSelected = 1U << 7;
inline constexpr std::uint32_t kGone =
    1U << 8;  ///< not drawn: of a hidden part, or with a node out of range or a coordinate that isn't finite
inline constexpr std::uint32_t kPartShift = 9;  ///< the remaining bits: PartIndex, or kNoPart
inline constexpr std::uint32_t kNoPart = (1U << (32 - kPartShift)) - 1;
}  // namespace shell_word

class ModelTextures {
 public:
  /// Extent of the shells of one chunk, and whether any is shown.
  struct ShellChunk {
    stereo::Box box;  ///< of those shown
    bool shown = false;
  };

  /// Takes over a model. Errors: too large for the GPU, or no graphics memory.
  Result<ModelChanges> update(const ModelTable& table);

  /// Positions are uploaded relative to this point, so that models far from zero keep their precision.
  const mesh::Vec3& origin() const { return origin_; }
  const RowTexture& positions() const { return positions_; }
  const RowTexture& connectivity() const { return connectivity_; }
  const RowTexture& surface() const { return surface_; }
  const std::vector<ShellChunk>& shell_chunks() const { return shell_chunks_; }
  std::size_t shell_count() const { return shell_count_; }

 private:
  struct ShellVersions {
    std::uint64_t nodes = 0;
    std::array<std::uint64_t, 3> look{};  ///< of parts, marks, quality
    bool known = false;
    std::vector<std::uint32_t> depends_on;  ///< chunks of nodes
    std::vector<bool> selected_faces;       ///< by shell of the chunk: all corners are
  };
  struct ShellRow;

  void forget();
  void choose_origin(const ModelTable& table);
  void update_positions(const ModelTable& table, ModelChanges& changes);
  void update_marks(const ModelTable& table, ModelChanges& changes);
  void update_shells(const ModelTable& table, ModelChanges& changes);
  static std::vector<bool> selected_faces(const ModelTable& table, std::size_t chunk);
  ShellRow build_row(const ModelTable& table, std::size_t chunk) const;

  std::uint64_t document_ = 0;
  bool any_document_ = false;
  mesh::Vec3 origin_ = mesh::Vec3::Zero();
  std::size_t node_count_ = 0;
  std::size_t shell_count_ = 0;
  std::vector<std::uint8_t> hidden_;
  std::vector<std::uint64_t> position_versions_;
  std::vector<bool> position_known_;
  std::vector<std::uint64_t> mark_versions_;
  std::vector<ShellVersions> shell_versions_;
  std::vector<ShellChunk> shell_chunks_;
  RowTexture positions_{kPositionTexel};
  RowTexture connectivity_{kFourIndices};
  RowTexture surface_{kTwoIndices};
};

/// Packs a normal of any length into two 16-bit numbers by its projection on an octahedron [Cigolle 2014].
std::uint32_t pack_normal(const mesh::Vec3& normal);

}  // namespace prismesh::kiosk::render
