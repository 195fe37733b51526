// All data of a model that the passes draw, on the GPU and on the processor. Updated from snapshots and previews.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "kiosk/render/contact_marks.h"
#include "kiosk/render/cut_picture.h"
#include "kiosk/render/free_lines.h"
#include "kiosk/render/glyphs.h"
#include "kiosk/render/line_set.h"
#include "kiosk/render/model_textures.h"
#include "kiosk/render/outline.h"
#include "kiosk/render/part_looks.h"
#include "kiosk/render/plate_textures.h"
#include "kiosk/render/preview_patch.h"
#include "kiosk/render/selection_rows.h"
#include "kiosk/render/shell_draws.h"

namespace prismesh::kiosk::render {

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

  /// Takes over a model; null: none. Errors: too large for the GPU, no graphics memory.
  Result<void> set_model(std::shared_ptr<const ModelSource> source);
  /// Takes over levels of detail; ignored unless they were made of this model's shells. Errors: no graphics memory.
  Result<void> set_levels(MadeLevels made);
  ShellDraws& shell_draws() { return shell_draws_; }
  const ShellDraws& shell_draws() const { return shell_draws_; }
  bool empty() const { return !table_; }
  const ModelTable& table() const { return *table_; }
  const ModelTextures& textures() const { return textures_; }
  /// Increases whenever the position or shape of drawn shells may have changed.
  std::uint64_t shape_version() const { return shape_version_; }
  std::size_t chunks_uploaded() const { return chunks_uploaded_; }

  const LineSet& borders() const { return borders_; }
  const LineSet& creases() const { return creases_; }
  /// Edges around the selected faces.
  const LineSet& selected_rim() const { return selected_rim_; }
  const LineSet& line_elements() const { return line_elements_; }
  const SelectionRows& selected() const { return selected_; }
  /// Those that are corners of no selected face.
  const SelectionRows& loose() const { return loose_; }

  /// Starts a drag's preview: nodes that move and shells they touch. Until the first frame nothing is previewed.
  void begin_preview(std::span<const mesh::NodeIndex> nodes, std::span<const mesh::ShellIndex> shells);
  /// Takes over a frame; one of another size is ignored. Errors: no graphics memory.
  Result<void> update_preview(const ipc::PreviewFrame& frame);
  /// Shows the result of an edit as a preview. Errors: no graphics memory.
  Result<void> show_change(const MeshChange& change);
  void end_preview();
  /// Marks where shells touch, until the next call or until the model's shells or nodes are others. Errors: too large for the GPU, no
  /// graphics memory.
  Result<void> set_contact(ContactPicture picture);
  const ContactMarks& contact() const { return contact_; }
  /// Cuts the model, until the next call or until there is no model. Nothing: it is whole. Errors: too large for the GPU, no graphics
  /// memory.
  Result<void> set_cut(std::optional<CutPicture> cut);
  const std::optional<CutPicture>& cut() const { return cut_; }
  const FreeLines& cut_curves() const { return cut_curves_; }
  bool previewing() const { return preview_ && preview_->any_frame(); }
  const RowTexture& preview_positions() const { return preview_positions_; }
  const LineSet& preview_edges() const { return preview_edges_; }

  /// Glyphs in drawing order: first the model's, without the shells that a preview shows, then the preview's. Rebuilt only after a
  /// change. The cost of a preview's frame depends on the preview alone.
  struct Glyphs {
    const Instances& model;
    const Instances& preview;
    std::size_t left_out = 0;
  };
  /// At most `cap`. `damaged`: only what the document's edits made worse. Errors: no graphics memory.
  Result<Glyphs> glyphs(std::size_t cap, bool damaged);
  /// Corners of the preview's shells, which its glyphs refer to.
  const RowTexture& preview_connectivity() const { return preview_casting_.connectivity; }
  /// Updates the colours of parts by their state. After a change it costs a pass over the shells. Errors: no graphics memory.
  Result<void> update_part_looks(bool damaged);
  const PartLooks& part_looks() const { return part_looks_; }
  /// Brings the plates up to date, as PlateTextures::update.
  Result<void> update_plates();
  const PlateTextures& plates() const { return plates_; }
  /// The frame around one shell of the model; no instance if the shell isn't visible.
  const Instances& marked(mesh::ShellIndex shell);

  /// The shells that cast shadows: those of the preview, else those with all nodes selected. To find the latter costs a pass over the model
  /// after a change. Errors: no graphics memory.
  struct ShadowCaster {
    const RowTexture* positions = nullptr;
    const RowTexture* connectivity = nullptr;
    std::size_t shells = 0;
  };
  Result<ShadowCaster> shadow_caster();

  /// Bytes on the graphics card, with those of shell_draws().
  std::size_t bytes_held() const;
  /// Bytes that a model's nodes and shells hold, without the order in which shells are drawn.
  static std::size_t bytes_for(const ModelSource& source);

  /// Bytes uploaded over the layer's life.
  std::size_t bytes_uploaded() const;

  /// Box around the visible shells and line elements, deck coordinates. Time is proportional to the number of chunks and line elements.
  stereo::Box shown_box() const;
  /// Length of a typical shell's side, deck's unit; 0 without shells. Limits the size of marks on nodes and shells.
  double typical_side() const { return typical_side_; }
  /// By node: 1 if a visible shell or line element uses it.
  const std::vector<std::uint8_t>& visible_nodes();
  /// Nodes of visible line elements, ascending.
  const std::vector<std::uint32_t>& line_nodes() const { return line_nodes_; }

 private:
  std::array<const RowTexture*, 14> row_textures() const;
  Result<void> update_line_elements(bool changed);
  void forget_visible_nodes();
  Result<void> choose_preview_glyphs(std::size_t cap);
  Result<void> upload_preview_positions();

  std::optional<ModelTable> table_;
  ModelTextures textures_;
  ShellDraws shell_draws_;
  Outline outline_;
  GlyphList glyph_list_;
  LineSet borders_, creases_, selected_rim_, line_elements_;
  std::vector<std::uint32_t> line_nodes_;
  std::vector<std::uint64_t> line_versions_;
  SelectionRows selected_, loose_;
  SelectionRows::Covered covered_;  ///< corners of selected faces
  std::optional<PreviewPatch> preview_;
  RowTexture preview_positions_{kPositionTexel};
  LineSet preview_edges_;
  /// Corners of shells that cast shadows.
  struct Casting {
    RowTexture connectivity{kFourIndices};
    std::size_t shells = 0;
    bool stale = true;
  };
  Result<void> upload_casting(Casting& casting, const std::vector<std::array<std::uint32_t, 4>>& shells) const;
  Casting preview_casting_, selection_casting_;
  /// Glyphs on the GPU, and whether they are out of date.
  struct GlyphBatch {
    Instances instances;
    std::size_t left_out = 0;
    bool stale = true;
  };
  GlyphBatch model_glyphs_, preview_glyphs_;
  std::size_t glyph_cap_ = 0;
  bool glyphs_of_damage_ = false;
  ContactMarks contact_;
  std::optional<CutPicture> cut_;
  FreeLines cut_curves_;
  PlateTextures plates_;
  PartLooks part_looks_;
  bool part_looks_stale_ = true, part_looks_of_damage_ = false;
  Instances marked_;
  std::optional<mesh::ShellIndex> marked_shell_;  ///< the shell of marked_
  std::optional<std::vector<std::uint8_t>> visible_nodes_;
  std::vector<std::uint64_t> visible_versions_;  ///< of the chunks that visible_nodes_ depends on
  double typical_side_ = 0;
  std::uint64_t shape_version_ = 0;
  std::size_t chunks_uploaded_ = 0;
};

}  // namespace prismesh::kiosk::render
