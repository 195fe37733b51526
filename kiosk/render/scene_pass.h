// Draws one eye's image of the model with its lines, selected nodes, glyphs, shadows and handle.
#pragma once

#include <functional>

#include "kiosk/render/contact_pass.h"
#include "kiosk/render/frame.h"
#include "kiosk/render/handle_pass.h"
#include "kiosk/render/node_pass.h"
#include "kiosk/render/paint_texture.h"
#include "kiosk/render/shaders.h"
#include "kiosk/render/shadow_pass.h"

namespace prismesh::kiosk::render {

/// What one view shows. The renderer holds these.
struct ViewContent {
  ModelLayer& model;
  FieldColours& field;
  const FieldLook& look;      ///< how `field` is coloured
  const PaintTexture& paint;  ///< of the model's parts
};

/// At most so many.
struct DrawCaps {
  std::size_t glyphs = 0;
  std::size_t moving_triangles = 0;  ///< of shells, in a moving picture with levels of detail
};

class ScenePass {
 public:
  explicit ScenePass(const Shaders& shaders);

  /// Call once before all images of a scene. Changes framebuffer and viewport. Errors: no graphics memory.
  Result<void> prepare(const Picture& picture, ModelLayer& model);
  /// Clears the bound framebuffer and draws the ground, if the span begins there. The viewport must be set.
  void begin(const EyeView& eye, DrawSpan& span) const;
  /// Limits later draws to the picture's columns from `from` to `to` (pixels), until the next call. Clears the depth there, so that
  /// earlier draws hide nothing.
  void begin_pane(const EyeView& eye, double from, double to, DrawSpan& span) const;
  /// Draws what lies in the span. A scene that is drawn in pieces must be at rest.
  void draw(const Picture& picture, const ViewContent& content, const EyeView& eye, const DrawCaps& caps, DrawSpan& span) const;
  /// Draws shell index + 1 into a bound R32UI framebuffer; 0: no shell. Transparent parts aren't drawn. Clears it if the span begins there.
  void draw_items(const ModelLayer& model, const PaintTexture& paint, const Eigen::Matrix4d& clip_from_deck, DrawSpan& span) const;

  std::size_t bytes_held() const { return nodes_.bytes_held() + handle_.bytes_held() + shadows_.bytes_held(); }

  std::size_t shadow_bytes() const { return shadows_.bytes_held(); }

 private:
  struct LineStyle {
    float half_width = 1;  ///< display pixels
    Eigen::Vector4f ink;
    float min_alpha = 1;  ///< of lines a few pixels long; longer ones become opaque
  };
  void draw_ground(const EyeView& eye) const;
  void draw_handles(const Picture& picture, const ModelLayer& model, const EyeView& eye) const;
  void draw_shells(const Picture& picture, const ViewContent& content, std::size_t moving_triangles, const Frame& frame) const;
  void set_shell_uniforms(const gl::Program& program, const Picture& picture, const ViewContent& content, const Frame& frame) const;
  void draw_opaque_and_transparent(const gl::Program& program, const ViewContent& content, const std::function<void()>& draw) const;
  void draw_lines(const LineSet& lines, const RowTexture& positions, const LineStyle& style, const Frame& frame) const;
  void draw_model_lines(const Picture& picture, const ModelLayer& model, const Frame& frame) const;
  void draw_contact_lines(const ModelLayer& model, const Frame& frame) const;
  void draw_hemmed(const FreeLines& lines, const LineStyle& style, const Frame& frame) const;
  void draw_cut(const ModelLayer& model, const Frame& frame) const;
  void draw_preview(const ModelLayer& model, const Frame& frame) const;
  void draw_glyphs(const Picture& picture, ModelLayer& model, std::size_t cap, const Frame& frame) const;

  const Shaders& shaders_;
  gl::VertexArray no_attributes_;
  NodePass nodes_;
  HandlePass handle_;
  ShadowPass shadows_;
  ContactPass contact_;
};

}  // namespace prismesh::kiosk::render
