// Draws the model for both eyes and weaves the display's picture. Needs a current OpenGL ES 3.1 context for all of its life
// (display/headless.h, or a window's).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "base/error.h"
#include "ipc/preview.h"
#include "kiosk/render/mesh_change.h"
#include "kiosk/render/model_source.h"
#include "kiosk/render/picture.h"

namespace prismesh::kiosk::render {

struct RendererOptions {
  int samples = 4;                ///< 4 or 1 (no multisampling)
  std::size_t glyph_cap = 20000;  ///< quality glyphs drawn at most: failures first
};

/// What a picture had to leave out, to be said in words beside it.
struct DrawReport {
  std::size_t glyphs = 0;
  std::size_t glyphs_left_out = 0;
};

class Renderer {
 public:
  /// Errors: no context or one below OpenGL ES 3.1 (named), a shader that the driver refuses (its words).
  static Result<std::unique_ptr<Renderer>> create(const RendererOptions& options);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Shows a model: uploads the chunks whose versions it doesn't have yet. Null: an empty screen. Errors: too large for the GPU.
  Result<void> set_model(std::shared_ptr<const ModelSource> model);
  const ModelSource* model() const;
  /// Around the nodes of visible shells and lines: what View::bounds should be, anew after each set_model. Costs the chunks only.
  stereo::Box bounds() const;
  /// The view that frames them closely, from the side that `view` is seen from. Costs the model.
  stereo::View fitted(const stereo::View& view, const Eigen::Vector2d& screen_mm, double eye_distance_mm = 650) const;

  /// What stands beside the model in a picture of two views; null: nothing. Errors: too large for the GPU.
  Result<void> set_other(std::shared_ptr<const ModelSource> model);
  const ModelSource* other() const;
  /// Values to colour a view by, for each of its nodes or shells; none: no colours. Uploads what differs from the last ones.
  Result<void> set_field(Pane pane, std::span<const float> values, bool on_nodes);

  /// A drag's preview over the model: nodes that move and shells they touch, as PreviewReader gives them.
  void begin_preview(std::span<const mesh::NodeIndex> nodes, std::span<const mesh::ShellIndex> shells);
  /// A frame: one position per node, one state per shell; other sizes are ignored. Until the first, nothing is drawn. Errors: no graphics
  /// memory.
  Result<void> update_preview(const ipc::PreviewFrame& frame);
  /// What an edit would make of some shells, in a preview's place, until end_preview. Errors: no graphics memory.
  Result<void> show_change(const MeshChange& change);
  void end_preview();

  /// Draws into `framebuffer` (0: the window's), width x height pixels. Lower rows are first, as OpenGL counts. A picture that differs
  /// from the last one in its overlay and rubber band only doesn't cost the model.
  Result<DrawReport> draw(const Picture& picture, unsigned framebuffer, int width, int height);

  /// What lies where on the picture, for `aim`; drawn again only when the aim, the model or the visible parts changed. The pixels of a
  /// preview are those of the model underneath.
  std::optional<mesh::ShellIndex> shell_at(const stereo::Aim& aim, const Eigen::Vector2d& pixel);
  /// The visible node nearest to the pixel, at most `radius` pixels away; corners of the shell at the pixel go first.
  std::optional<mesh::NodeIndex> node_near(const stereo::Aim& aim, const Eigen::Vector2d& pixel, double radius);
  /// Nodes of visible parts inside a rectangle, ascending: those that can be seen, or all of them (`through`).
  mesh::NodeSet nodes_in(const stereo::Aim& aim, const PixelRect& rect, bool through);

  struct Figures {
    std::size_t chunks_uploaded = 0;  ///< over the renderer's life; for tests and figures
    std::size_t bytes_uploaded = 0;   ///< of the model and of previews, over the renderer's life
    std::size_t item_buffers_drawn = 0;
    std::size_t scenes_drawn = 0;  ///< pictures whose model was drawn
  };
  Figures figures() const;

 private:
  struct State;
  explicit Renderer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace prismesh::kiosk::render
