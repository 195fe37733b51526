// Draws the model for both eyes and weaves the display's picture. An OpenGL ES 3.1 context must be current during the renderer's whole life
// (display/headless.h, or a window's).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "base/clock.h"
#include "base/error.h"
#include "ipc/model/preview.h"
#include "kiosk/render/contact_picture.h"
#include "kiosk/render/cut_picture.h"
#include "kiosk/render/memory_plan.h"
#include "kiosk/render/mesh_change.h"
#include "kiosk/render/model_source.h"
#include "kiosk/render/part_paint.h"
#include "kiosk/render/picture.h"
#include "kiosk/render/shell_draws.h"

namespace prismesh::kiosk::render {

struct RendererOptions {
  int samples = 4;                ///< 4 or 1 (no multisampling)
  std::size_t glyph_cap = 20000;  ///< max number of quality glyphs drawn, failures first
  /// Of a moving picture's image, at most so many where levels of detail allow it; 0: by whether a graphics card draws.
  std::size_t moving_triangles = 0;
  /// Bytes that may be held on the graphics card, without the target of the pictures and without panels; 0: no limit. See memory_plan.h.
  std::size_t video_memory = 0;
};

/// Number of glyphs drawn and left out, for a message beside the picture.
struct DrawReport {
  std::size_t glyphs = 0;
  std::size_t glyphs_left_out = 0;
  VideoMemory memory;
};

class Renderer {
 public:
  /// Errors: no context, one below OpenGL ES 3.1 (with its version), a shader that the driver refuses (with its message).
  static Result<std::unique_ptr<Renderer>> create(const RendererOptions& options);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Shows a model. Uploads only the chunks whose versions differ. Null: an empty screen. Errors: too large for the GPU, no graphics
  /// memory.
  Result<void> set_model(std::shared_ptr<const ModelSource> model);
  /// Takes over levels of detail: moving pictures show coarse triangles for shells that are small in them. Ignored unless they were made of
  /// the shells that are shown; dropped when the shells are others. Errors: no graphics memory.
  Result<void> set_levels(MadeLevels made);
  /// Whether moving pictures have levels of detail, of the places where the nodes are now; or the limit of video memory has no room for
  /// them.
  bool levels_are_current() const;
  const ModelSource* model() const;
  const std::shared_ptr<const ModelSource>& shared_model() const;
  /// Box around the nodes of visible shells and line elements, deck coordinates, for View::bounds; changes with each set_model. Time is
  /// proportional to the number of chunks and line elements.
  stereo::Box bounds() const;
  /// The view that fits the screen (mm) to these nodes, from the direction of `view`. Costs a pass over the model.
  stereo::View fitted(const stereo::View& view, const Eigen::Vector2d& screen_mm, double eye_distance_mm = 650) const;

  /// Sets the model of the other view in a picture of two views; null: none. Errors: too large for the GPU, no graphics memory.
  Result<void> set_other(std::shared_ptr<const ModelSource> model);
  const ModelSource* other() const;
  /// Sets the values that colour a view, one for each of its nodes or shells; empty: no colours. Uploads only the rows that changed.
  /// Errors: no graphics memory.
  Result<void> set_field(Pane pane, std::span<const float> values, bool on_nodes);

  /// Sets what was chosen for parts, by PartIndex, in both views; it stays when the model changes. Parts beyond the end have no paint. The
  /// shells of transparent parts are drawn last, blended without depth, and picks go through them. Errors: no graphics memory.
  Result<void> set_part_paints(std::span<const PartPaint> paints);

  /// Marks where shells of the model touch; an empty picture: nowhere. Errors: too large for the GPU, no graphics memory.
  Result<void> set_contact(ContactPicture picture);

  /// Cuts the model by a plane, in both views; nothing: it is whole. What is cut away isn't picked either. Errors: too large for the GPU,
  /// no graphics memory.
  Result<void> set_cut(std::optional<CutPicture> cut);
  const std::optional<CutPicture>& cut() const;
  /// False: the driver can't cut the picture, and only the curves are drawn.
  static bool can_cut();

  /// Starts a drag's preview over the model: nodes that move and shells they touch, as in PreviewReader. Nothing is drawn until the first
  /// frame.
  void begin_preview(std::span<const mesh::NodeIndex> nodes, std::span<const mesh::ShellIndex> shells);
  /// Takes over a frame: one position for each node, one state for each shell; a frame of other sizes is ignored. Errors: no graphics
  /// memory.
  Result<void> update_preview(const ipc::PreviewFrame& frame);
  /// Shows the result of an edit as a preview, until end_preview. Errors: no graphics memory.
  Result<void> show_change(const MeshChange& change);
  void end_preview();

  /// Draws into `framebuffer` (0: the window's), width x height pixels; the lowest row is the first. The scene is drawn again only if it
  /// changed: a picture that differs from the last one only in its overlay, rubber band or lasso doesn't cost the model. Errors: larger
  /// than the GPU allows, no graphics memory, a shader that the driver refuses.
  Result<DrawReport> draw(const Picture& picture, unsigned framebuffer, int width, int height);

  /// Draws a piece of the scene of a picture at rest, aside, in about `budget_ns`. Returns whether the scene is whole: then `draw` shows it
  /// at once, the same as if it had been drawn in one go. It is begun anew if the picture's scene, the model or the preview isn't that of
  /// the last piece, or if `draw` has drawn another scene. Errors: as of `draw`.
  Result<bool> draw_piece(const Picture& picture, int width, int height, Clock& clock, std::int64_t budget_ns);

  /// Draws a piece of the item image, from which things are picked, in about `budget_ns`. Returns whether it is whole: then picking is
  /// fast.
  bool draw_items_piece(const stereo::Aim& aim, Clock& clock, std::int64_t budget_ns);
  /// The shell at a pixel of the picture of `aim`. The item image is drawn again only if the aim, the model or the visible parts changed. A
  /// preview isn't in it: its pixels give the model's shells.
  std::optional<mesh::ShellIndex> shell_at(const stereo::Aim& aim, const Eigen::Vector2d& pixel);
  /// The visible node nearest to the pixel, at most `radius` pixels away; corners of the shell at the pixel come first.
  std::optional<mesh::NodeIndex> node_near(const stereo::Aim& aim, const Eigen::Vector2d& pixel, double radius);
  /// Nodes of visible parts inside a rectangle, ascending: only those that nothing hides, or all of them (`through`).
  mesh::NodeSet nodes_in(const stereo::Aim& aim, const PixelRect& rect, bool through);

  /// Counters for tests and benchmarks.
  struct Figures {
    std::size_t chunks_uploaded = 0;  ///< over the renderer's life
    std::size_t bytes_uploaded = 0;   ///< of the model and of previews, over the renderer's life
    std::size_t item_buffers_drawn = 0;
    std::size_t scenes_drawn = 0;      ///< pictures for which the model was drawn
    std::size_t pieces_drawn = 0;      ///< of the last scene that was drawn in pieces
    std::size_t moving_triangles = 0;  ///< of the last moving picture's image with levels of detail
    double moving_pixels = 0;          ///< how far they may be off
  };
  Figures figures() const;
  VideoMemory video_memory() const;

 private:
  struct Impl;
  explicit Renderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace prismesh::kiosk::render
