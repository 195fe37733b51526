// Draws one eye's image of the model and what belongs to it.
#pragma once

#include "kiosk/render/frame.h"
#include "kiosk/render/handle_pass.h"
#include "kiosk/render/node_pass.h"
#include "kiosk/render/shaders.h"
#include "kiosk/render/shadow_pass.h"

namespace prismesh::kiosk::render {

class ScenePass {
 public:
  explicit ScenePass(const Shaders& shaders);

  /// Once for all images of a scene, before them: changes framebuffer and viewport. Errors: no graphics memory.
  Result<void> prepare(const Picture& picture, ModelLayer& model);
  /// Nothing but the ground, into the bound framebuffer; its viewport is set.
  void begin(const EyeView& eye) const;
  /// What is drawn from now on stays between two columns of the picture (pixels), until the next call, and hides nothing of what was drawn
  /// before.
  void begin_pane(const EyeView& eye, double from, double to) const;
  /// The model and what belongs to it.
  void draw(const Picture& picture, ModelLayer& model, FieldColours& field, const FieldLook& look, const EyeView& eye,
            std::size_t glyph_cap) const;
  /// Numbers of shells into a bound R32UI framebuffer.
  void draw_items(const ModelLayer& model, const Eigen::Matrix4d& clip_from_deck) const;

 private:
  void draw_ground(const EyeView& eye) const;
  void draw_shells(const Picture& picture, const ModelLayer& model, FieldColours& field, const FieldLook& look, const Frame& frame) const;
  void draw_lines(const LineSet& lines, const RowTexture& positions, const Frame& frame, float half_width, const Eigen::Vector4f& ink,
                  float least_alpha = 1) const;
  void draw_model_lines(const Picture& picture, const ModelLayer& model, const Frame& frame) const;
  void draw_preview(const ModelLayer& model, const Frame& frame) const;
  void draw_glyphs(const Picture& picture, ModelLayer& model, std::size_t cap, const Frame& frame) const;
  void draw_chunks(const ModelLayer& model, const Eigen::Matrix4d& clip_from_deck) const;

  const Shaders& shaders_;
  gl::VertexArray no_attributes_;
  NodePass nodes_;
  HandlePass handle_;
  ShadowPass shadows_;
};

}  // namespace prismesh::kiosk::render
