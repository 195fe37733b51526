// Everything that is drawn of a model, on the GPU and beside it, kept in step with the snapshots.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "kiosk/render/glyphs.h"
#include "kiosk/render/model_textures.h"
#include "kiosk/render/outline.h"
#include "kiosk/render/part_looks.h"
#include "kiosk/render/preview_patch.h"
#include "kiosk/render/selection_rows.h"

namespace prismesh::kiosk::render {

/// Lines as a texture of node pairs.
struct LineSet {
  RowTexture texture{kTwoIndices};
  std::size_t count = 0;
  Result<void> upload(const std::vector<NodePair>& lines, const char* what);
};

/// Instances for one draw call.
struct Instances {
  gl::VertexArray array;
  gl::Buffer buffer;
  std::size_t count = 0;
  std::size_t bytes_uploaded = 0;
};

class ModelLayer {
 public:
  ModelLayer();

  Result<void> set_model(std::shared_ptr<const ModelSource> source);
  bool empty() const { return !table_; }
  const ModelTable& table() const { return *table_; }
  const ModelTextures& textures() const { return textures_; }
  /// Counts up whenever the shells' picture may have changed in place or shape.
  std::uint64_t shape_version() const { return shape_version_; }
  std::size_t chunks_uploaded() const { return chunks_uploaded_; }

  const LineSet& borders() const { return borders_; }
  const LineSet& creases() const { return creases_; }
  const LineSet& line_elements() const { return line_elements_; }
  const SelectionRows& selected() const { return selected_; }

  void begin_preview(std::span<const mesh::NodeIndex> nodes, std::span<const mesh::ShellIndex> shells);
  Result<void> update_preview(const ipc::PreviewFrame& frame);
  /// What an edit would make of some shells, in a preview's place.
  Result<void> show_change(const MeshChange& change);
  void end_preview();
  bool previewing() const { return preview_ && preview_->any_frame(); }
  const RowTexture& preview_positions() const { return preview_positions_; }
  const LineSet& preview_edges() const { return preview_edges_; }

  /// The signs to draw now, in this order: the model's, but for the shells that a preview shows, and the preview's. Rebuilt only after a
  /// change; a preview's frame costs the preview.
  struct Glyphs {
    const Instances& model;
    const Instances& preview;
    std::size_t left_out = 0;
  };
  Result<Glyphs> glyphs(std::size_t cap, bool damaged);
  /// The shells of the preview, by their corners: what its glyphs are pulled from.
  const RowTexture& preview_connectivity() const { return preview_casting_.connectivity; }
  /// Parts by their state; a pass over the shells where these have changed.
  Result<void> update_part_looks(bool damaged);
  const PartLooks& part_looks() const { return part_looks_; }
  /// A glyph about one shell of the model; nothing where it isn't shown.
  const Instances& marked(mesh::ShellIndex shell);

  /// What throws shadows: the shells of the preview, else those with all nodes selected. The latter are found by a pass over the model
  /// where it has changed. Errors: no graphics memory.
  struct ShadowCaster {
    const RowTexture* positions = nullptr;
    const RowTexture* connectivity = nullptr;
    std::size_t shells = 0;
  };
  Result<ShadowCaster> shadow_caster();

  /// Bytes given to OpenGL over the layer's life.
  std::size_t bytes_uploaded() const;

  /// Around what is shown, deck coordinates. Costs the chunks and the line elements.
  stereo::Box shown_box() const;
  /// Length of a typical shell's side, deck's unit; 0 without shells. What signs on nodes and shells must leave room for.
  double typical_side() const { return typical_side_; }
  const std::vector<std::uint8_t>& visible_nodes();
  const std::vector<std::uint32_t>& line_nodes() const { return line_nodes_; }

 private:
  Result<void> update_line_elements(bool changed);
  void forget_visible_nodes();
  Result<void> choose_preview_glyphs(std::size_t cap);
  Result<void> upload_preview_positions();

  std::optional<ModelTable> table_;
  ModelTextures textures_;
  Outline outline_;
  GlyphList glyph_list_;
  LineSet borders_, creases_, line_elements_;
  std::vector<std::uint32_t> line_nodes_;
  std::vector<std::uint64_t> line_versions_;
  SelectionRows selected_;
  std::optional<PreviewPatch> preview_;
  RowTexture preview_positions_{kPositionTexel};
  LineSet preview_edges_;
  /// Shells that throw shadows, by their corners.
  struct Casting {
    RowTexture connectivity{kFourIndices};
    std::size_t shells = 0;
    bool stale = true;
  };
  Result<void> upload_casting(Casting& casting, const std::vector<std::array<std::uint32_t, 4>>& shells) const;
  Casting preview_casting_, selection_casting_;
  /// Glyphs on the GPU, and whether they are of what is to be shown.
  struct GlyphBatch {
    Instances instances;
    std::size_t left_out = 0;
    bool stale = true;
  };
  GlyphBatch model_glyphs_, preview_glyphs_;
  std::size_t glyph_cap_ = 0;
  bool glyphs_of_damage_ = false;
  PartLooks part_looks_;
  bool part_looks_stale_ = true, part_looks_of_damage_ = false;
  Instances marked_;
  std::optional<mesh::ShellIndex> marked_shell_;  ///< that marked_ is of
  std::optional<std::vector<std::uint8_t>> visible_nodes_;
  std::vector<std::uint64_t> visible_versions_;  ///< of the chunks that visible_nodes_ is made of
  double typical_side_ = 0;
  std::uint64_t shape_version_ = 0;
  std::size_t chunks_uploaded_ = 0;
};

}  // namespace prismesh::kiosk::render
