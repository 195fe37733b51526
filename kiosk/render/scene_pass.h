// Draws one eye's image.
#pragma once

#include "kiosk/render/eye_images.h"
#include "kiosk/render/gl.h"
#include "kiosk/render/handle_mesh.h"
#include "kiosk/render/model_layer.h"
#include "kiosk/render/renderer.h"
#include "kiosk/render/shaders.h"

namespace prismesh::kiosk::render {

/// From where and onto what an image is drawn.
struct EyeView {
  Vec3 eye_mm = Vec3(0, 0, 650);
  Eigen::Matrix4d clip_from_screen = Eigen::Matrix4d::Identity();  ///< onto the image
  stereo::DepthRange range;
  EyeImage image;
  double mm_per_pixel = 0.28;  ///< of the display
};

class ScenePass {
 public:
  explicit ScenePass(const Shaders& shaders);

  /// The model and what belongs to it, into the bound framebuffer; its viewport is set.
  void draw(const Picture& picture, ModelLayer& model, const EyeView& eye, std::size_t glyph_cap) const;
  /// What lies in the screen's plane, over the finished scene.
  void draw_flat(const Picture& picture, const EyeView& eye) const;
  /// Numbers of shells into a bound R32UI framebuffer.
  void draw_items(const ModelLayer& model, const Eigen::Matrix4d& clip_from_deck) const;

 private:
  struct Frame;  ///< what all the draws of one image share

  void draw_ground(const EyeView& eye) const;
  void draw_shells(const Picture& picture, const ModelLayer& model, const Frame& frame) const;
  void draw_lines(const LineSet& lines, const RowTexture& positions, const Frame& frame, float half_width, const Eigen::Vector4f& ink,
                  float least_alpha = 1) const;
  void draw_model_lines(const Picture& picture, const ModelLayer& model, const Frame& frame) const;
  void draw_preview(const ModelLayer& model, const Frame& frame) const;
  void draw_selected(const ModelLayer& model, const Frame& frame) const;
  void draw_glyphs(ModelLayer& model, std::size_t cap, const Frame& frame) const;
  void draw_handle(const Handle& handle, const Frame& frame) const;
  void draw_chunks(const ModelLayer& model, const Eigen::Matrix4d& clip_from_deck) const;

  const Shaders& shaders_;
  gl::VertexArray no_attributes_;
  /// A mesh of the handle.
  struct Solid {
    gl::VertexArray array;
    gl::Buffer buffer;
    GLsizei vertices = 0;
  };
  static Solid upload(const std::vector<HandleVertex>& mesh);
  /// Draws one with its axis; sides are a pixel long.
  void draw_solid(const Solid& solid, const Vec3& foot, const Vec3& axis, double pixel, bool active) const;

  Solid arrow_;
  Solid ring_;
};

/// Whether a box may be seen: false only if all its corners are outside one side of the picture.
bool may_be_seen(const stereo::Box& box, const Eigen::Matrix4d& clip_from_deck);

}  // namespace prismesh::kiosk::render
