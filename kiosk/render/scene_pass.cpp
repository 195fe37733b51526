#include "kiosk/render/scene_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/LU>

#include "kiosk/render/palette.h"

namespace prismesh::kiosk::render {

namespace {

// Widths and sizes in display pixels.
constexpr float kBorderHalfWidth = 1.0F;
constexpr float kCreaseHalfWidth = 0.7F;
constexpr float kLineElementHalfWidth = 0.9F;
constexpr float kCrowdedLineAlpha = 0.35F;  ///< of line elements a few pixels short
constexpr float kPreviewHalfWidth = 0.65F;
// Signs keep their size over the screen, but make room where elements are small.
constexpr float kNodeRadius = 4.2F, kLeastNodeRadius = 1.3F, kNodeShareOfSide = 0.26F;
constexpr float kGlyphRadius = 8.0F, kLeastGlyphRadius = 5.0F, kGlyphShareOfSide = 0.55F;
constexpr float kRimmedNodeRadius = 2.6F;  ///< from this size on, white nodes have a dark rim
constexpr double kLinesTowardEye = 1.3;    ///< pixels: what lifts lines off the surface they lie on
constexpr float kHiddenLight = 0.80F;      ///< selected nodes behind a surface: lighter than any part, darker than white

Eigen::Vector4f ink(const Colour& colour, float alpha) { return {colour.x(), colour.y(), colour.z(), alpha}; }

/// An image's places (texels from its lower left corner) to the picture's (pixels from the upper left corner).
Eigen::Matrix3d picture_from(const EyeImage& image) {
  Eigen::Matrix3d from_texels, to_picture = Eigen::Matrix3d::Identity();
  from_texels << 2.0 / image.width, 0, -1, 0, 2.0 / image.height, -1, 0, 0, 1;
  to_picture.topRows<2>() = image.from_picture;
  return to_picture.inverse() * from_texels;
}

}  // namespace

struct ScenePass::Frame {
  const EyeView& eye;
  Eigen::Matrix4d clip_from_deck;
  Eigen::Matrix4f clip_from_model;  ///< the model's coordinates count from its origin
  Eigen::Matrix3f screen_from_normal;
  Eigen::Vector3f eye_in_model;
  // Steps on the display (pixels, y up), in normalised coordinates and in texels.
  Eigen::Matrix2f clip_from_pixels, pixels_from_clip, texels_from_pixels, pixels_from_texels;
  const stereo::View& view;

  Frame(const EyeView& eye_view, const Picture& picture, const ModelLayer& model) : eye(eye_view), view(picture.view) {
    const Eigen::Matrix4d screen_from_deck = stereo::screen_from_deck(view);
    clip_from_deck = eye.clip_from_screen * screen_from_deck;
    Eigen::Matrix4d deck_from_model = Eigen::Matrix4d::Identity();
    deck_from_model.topRightCorner<3, 1>() = model.textures().origin();
    clip_from_model = (clip_from_deck * deck_from_model).cast<float>();
    screen_from_normal = view.rotation.toRotationMatrix().cast<float>();
    eye_in_model = (stereo::to_deck(view, eye.eye_mm) - model.textures().origin()).cast<float>();
    const Eigen::Matrix2d clip = eye.image.from_picture.leftCols<2>() * Eigen::Vector2d(1, -1).asDiagonal();
    const Eigen::Matrix2d texels = 0.5 * Eigen::Vector2d(eye.image.width, eye.image.height).asDiagonal() * clip;
    clip_from_pixels = clip.cast<float>();
    pixels_from_clip = clip.inverse().cast<float>();
    texels_from_pixels = texels.cast<float>();
    pixels_from_texels = texels.inverse().cast<float>();
  }

  /// A sign's radius in pixels: `largest` unless that crowds typical elements.
  float fitting_radius(float largest, float least, float share, double typical_side) const {
    if (typical_side <= 0) return largest;
    const double side_pixels = typical_side * view.mm_per_unit / eye.mm_per_pixel;
    return std::clamp(share * static_cast<float>(std::min(side_pixels, 1000.0)), least, largest);
  }
  /// What every program that pulls the model needs.
  void set(const gl::Program& program) const {
    program.use();
    const double n = eye.range.near_mm, f = eye.range.far_mm;
    program.set("clip_from_model", clip_from_model);
    program.set("depth_terms", static_cast<float>((f + n) / (f - n)), static_cast<float>(2 * f * n / (f - n)));
    program.set("positions", static_cast<int>(unit::kPositions));
    program.set("connectivity", static_cast<int>(unit::kConnectivity));
    program.set("surface", static_cast<int>(unit::kSurface));
    program.set("lines", static_cast<int>(unit::kLines));
    program.set("clip_from_pixels", clip_from_pixels);
    program.set("pixels_from_clip", pixels_from_clip);
    program.set("texels_from_pixels", texels_from_pixels);
    program.set("pixels_from_texels", pixels_from_texels);
    program.set("mm_per_pixel", static_cast<float>(eye.mm_per_pixel));
    program.set("screen_from_normal", screen_from_normal);
  }
};

bool may_be_seen(const stereo::Box& box, const Eigen::Matrix4d& clip_from_deck) {
  if (box.empty()) return false;
  unsigned outside_of_all = 0x3f;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector4d at((corner & 1 ? box.high : box.low).x(), (corner & 2 ? box.high : box.low).y(),
                             (corner & 4 ? box.high : box.low).z(), 1);
    const Eigen::Vector4d clip = clip_from_deck * at;
    unsigned outside = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (clip[axis] < -clip.w()) outside |= 1U << (2 * axis);
      if (clip[axis] > clip.w()) outside |= 2U << (2 * axis);
    }
    outside_of_all &= outside;
  }
  return outside_of_all == 0;
}

ScenePass::ScenePass(const Shaders& shaders)
    : shaders_(shaders), no_attributes_(gl::VertexArray::make()), arrow_(upload(arrow_mesh())), ring_(upload(ring_mesh())) {}

ScenePass::Solid ScenePass::upload(const std::vector<HandleVertex>& mesh) {
  Solid solid{gl::VertexArray::make(), gl::Buffer::make(), static_cast<GLsizei>(mesh.size())};
  glBindVertexArray(solid.array.get());
  glBindBuffer(GL_ARRAY_BUFFER, solid.buffer.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.size() * sizeof(HandleVertex)), mesh.data(), GL_STATIC_DRAW);
  constexpr std::array<std::size_t, 3> kOffsets{offsetof(HandleVertex, circle), offsetof(HandleVertex, stem),
                                                offsetof(HandleVertex, slant)};
  for (GLuint attribute = 0; attribute < kOffsets.size(); ++attribute) {
    glEnableVertexAttribArray(attribute);
    // NOLINTNEXTLINE(performance-no-int-to-ptr): OpenGL passes offsets as pointers
    glVertexAttribPointer(attribute, 2, GL_FLOAT, GL_FALSE, sizeof(HandleVertex), reinterpret_cast<const void*>(kOffsets[attribute]));
  }
  glBindVertexArray(0);
  return solid;
}

void ScenePass::draw(const Picture& picture, ModelLayer& model, const EyeView& eye, std::size_t glyph_cap) const {
  const Frame frame(eye, picture, model);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glClearDepthf(1);
  glClear(GL_DEPTH_BUFFER_BIT);
  draw_ground(eye);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  if (!model.empty()) {
    model.textures().positions().bind(unit::kPositions);
    model.textures().connectivity().bind(unit::kConnectivity);
    model.textures().surface().bind(unit::kSurface);
    draw_shells(picture, model, frame);
    draw_model_lines(picture, model, frame);
    if (model.previewing()) draw_preview(model, frame);
    model.textures().positions().bind(unit::kPositions);
    if (picture.selected_nodes) draw_selected(model, frame);
    if (picture.quality_glyphs) draw_glyphs(model, glyph_cap, frame);
  }
  if (picture.handle) draw_handle(*picture.handle, frame);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
}

void ScenePass::draw_ground(const EyeView& eye) const {
  glDisable(GL_DEPTH_TEST);
  shaders_.ground.use();
  shaders_.ground.set("top", kGroundTop);
  shaders_.ground.set("bottom", kGroundBottom);
  shaders_.ground.set("height", static_cast<float>(eye.image.height));
  glBindVertexArray(no_attributes_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void ScenePass::draw_shells(const Picture& picture, const ModelLayer& model, const Frame& frame) const {
  frame.set(shaders_.shells);
  const auto& palette = part_colours();
  for (std::size_t i = 0; i < palette.size(); ++i) shaders_.shells.set(("palette[" + std::to_string(i) + "]").c_str(), palette[i]);
  const auto& grades = grade_colours();
  for (std::size_t i = 0; i < grades.size(); ++i) shaders_.shells.set(("grades[" + std::to_string(i) + "]").c_str(), grades[i]);
  shaders_.shells.set("by_grade", picture.colour == ColourMode::quality ? 1 : 0);
  shaders_.shells.set("eye_in_model", frame.eye_in_model);
  shaders_.shells.set("edge_strength", picture.element_edges ? 0.42F : 0.0F);
  draw_chunks(model, frame.clip_from_deck);
}

void ScenePass::draw_chunks(const ModelLayer& model, const Eigen::Matrix4d& clip_from_deck) const {
  glBindVertexArray(no_attributes_.get());
  Eigen::Matrix4d clip_from_model = clip_from_deck;
  clip_from_model.col(3) += clip_from_deck.leftCols<3>() * model.textures().origin();
  const auto& chunks = model.textures().shell_chunks();
  std::size_t first = 0, last = 0;  // neighbours that are seen go in one call
  const auto flush = [&] {
    const std::size_t end = std::min(last * mesh::kChunkSize, model.textures().shell_count());
    const std::size_t begin = first * mesh::kChunkSize;
    if (end > begin) glDrawArrays(GL_TRIANGLES, static_cast<GLint>(begin * 6), static_cast<GLsizei>((end - begin) * 6));
  };
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    if (!chunks[c].shown || !may_be_seen(chunks[c].box, clip_from_model)) continue;
    if (c != last) {
      flush();
      first = c;
    }
    last = c + 1;
  }
  flush();
}

void ScenePass::draw_items(const ModelLayer& model, const Eigen::Matrix4d& clip_from_deck) const {
  const GLuint ground[4] = {0, 0, 0, 0};
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glClearBufferuiv(GL_COLOR, 0, ground);
  glClearDepthf(1);
  glClear(GL_DEPTH_BUFFER_BIT);
  if (model.empty()) return;
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  model.textures().positions().bind(unit::kPositions);
  model.textures().connectivity().bind(unit::kConnectivity);
  model.textures().surface().bind(unit::kSurface);
  shaders_.items.use();
  Eigen::Matrix4d clip_from_model = clip_from_deck;
  clip_from_model.col(3) += clip_from_deck.leftCols<3>() * model.textures().origin();
  shaders_.items.set("clip_from_model", Eigen::Matrix4f(clip_from_model.cast<float>()));
  shaders_.items.set("positions", static_cast<int>(unit::kPositions));
  shaders_.items.set("connectivity", static_cast<int>(unit::kConnectivity));
  shaders_.items.set("surface", static_cast<int>(unit::kSurface));
  draw_chunks(model, clip_from_deck);
  glDisable(GL_DEPTH_TEST);
}

void ScenePass::draw_lines(const LineSet& lines, const RowTexture& positions, const Frame& frame, float half_width,
                           const Eigen::Vector4f& line_ink, float least_alpha) const {
  if (lines.count == 0) return;
  positions.bind(unit::kPositions);
  lines.texture.bind(unit::kLines);
  frame.set(shaders_.lines);
  shaders_.lines.set("half_width", half_width);
  shaders_.lines.set("least_alpha", least_alpha);
  shaders_.lines.set("toward_eye_mm", static_cast<float>(kLinesTowardEye * frame.eye.mm_per_pixel));
  shaders_.lines.set("ink", line_ink.x(), line_ink.y(), line_ink.z(), line_ink.w());
  glBindVertexArray(no_attributes_.get());
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(lines.count * 6));
}

void ScenePass::draw_model_lines(const Picture& picture, const ModelLayer& model, const Frame& frame) const {
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  const RowTexture& positions = model.textures().positions();
  if (picture.outlines) {
    draw_lines(model.creases(), positions, frame, kCreaseHalfWidth, ink(kCreaseColour, 0.55F));
    draw_lines(model.borders(), positions, frame, kBorderHalfWidth, ink(kBorderColour, 0.85F));
  }
  glDepthMask(GL_TRUE);
  draw_lines(model.line_elements(), positions, frame, kLineElementHalfWidth, ink(kLineElementColour, 1.0F), kCrowdedLineAlpha);
}

void ScenePass::draw_preview(const ModelLayer& model, const Frame& frame) const {
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_GREATER);  // what has been pushed behind the old surface shows through it
  draw_lines(model.preview_edges(), model.preview_positions(), frame, kPreviewHalfWidth, ink(kSelectedColour, 0.45F));
  glDepthFunc(GL_LEQUAL);
  draw_lines(model.preview_edges(), model.preview_positions(), frame, kPreviewHalfWidth, ink(kSelectedColour, 1.0F));
  glDepthMask(GL_TRUE);
}

void ScenePass::draw_selected(const ModelLayer& model, const Frame& frame) const {
  const Instances& nodes = model.selected();
  if (nodes.count == 0) return;
  const float room = frame.fitting_radius(kNodeRadius, kLeastNodeRadius, kNodeShareOfSide, model.typical_side());
  const float radius = model.previewing() ? kLeastNodeRadius : room;  // the wireframe says where they go
  frame.set(shaders_.nodes);
  shaders_.nodes.set("radius_pixels", radius);
  glBindVertexArray(nodes.array.get());
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glFrontFace(GL_CCW);
  const auto draw = [&](float grow, const Colour& colour) {
    shaders_.nodes.set("grow", grow);
    shaders_.nodes.set("ink", colour.x(), colour.y(), colour.z(), 1.0F);
    glDrawArraysInstanced(GL_TRIANGLES, 0, 24, static_cast<GLsizei>(nodes.count));
  };
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_GREATER);
  glEnable(GL_BLEND);
  glBlendEquation(GL_MAX);
  draw(0.85F, kHiddenLight * kSelectedColour);
  glBlendEquation(GL_FUNC_ADD);
  glDisable(GL_BLEND);
  glDepthFunc(GL_LEQUAL);
  if (radius >= kRimmedNodeRadius) draw(1.35F, kBorderColour);  // a dark rim tells white nodes from a light part
  glDepthMask(GL_TRUE);
  draw(1.0F, kSelectedColour);
  glDisable(GL_CULL_FACE);
}

void ScenePass::draw_glyphs(ModelLayer& model, std::size_t cap, const Frame& frame) const {
  const Instances& glyphs = model.glyphs(cap);
  if (glyphs.count == 0) return;
  frame.set(shaders_.glyphs);
  shaders_.glyphs.set("radius_pixels", frame.fitting_radius(kGlyphRadius, kLeastGlyphRadius, kGlyphShareOfSide, model.typical_side()));
  shaders_.glyphs.set("warn_ink", kWarnColour);
  shaders_.glyphs.set("fail_ink", kFailColour);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  glBindVertexArray(glyphs.array.get());
  glDrawArraysInstanced(GL_TRIANGLES, 0, 6, static_cast<GLsizei>(glyphs.count));
  glDepthMask(GL_TRUE);
}

void ScenePass::draw_handle(const Handle& handle, const Frame& frame) const {
  if (!finite(handle.at) || !finite(handle.direction) || handle.direction.norm() == 0) return;
  const Vec3 foot = stereo::to_screen(frame.view, handle.at);
  const double eye_z = frame.eye.eye_mm.z();
  const double pixel = frame.eye.mm_per_pixel * std::max(eye_z - foot.z(), 1.0) / std::max(eye_z, 1.0);  // mm at the foot's depth
  const double length = stereo::kHandleLengthPixels * pixel / frame.view.mm_per_unit;
  const Vec3 axis = stereo::to_screen(frame.view, handle.at + handle.direction.normalized() * length) - foot;
  shaders_.handle.use();
  shaders_.handle.set("clip_from_screen", Eigen::Matrix4f(frame.eye.clip_from_screen.cast<float>()));
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glFrontFace(GL_CCW);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  // A few pixels before the foot, so that the surface the handle stands on doesn't swallow half of the ring.
  constexpr double kRingBefore = 6, kRingThickness = 2;
  if (handle.use != Handle::Use::arrow)
    draw_solid(ring_, foot + Vec3(0, 0, kRingBefore * pixel), Vec3(0, 0, kRingThickness * pixel), pixel, handle.use == Handle::Use::ring);
  if (handle.use != Handle::Use::ring && axis.norm() > 0) draw_solid(arrow_, foot, axis, pixel, handle.use == Handle::Use::arrow);
  glDisable(GL_CULL_FACE);
}

void ScenePass::draw_solid(const Solid& solid, const Vec3& foot, const Vec3& axis, double pixel, bool active) const {
  const Vec3 along = axis.normalized();
  const Vec3 helper = std::abs(along.z()) < 0.9 ? Vec3(Vec3::UnitZ()) : Vec3(Vec3::UnitX());
  const Vec3 side_a = helper.cross(along).normalized() * pixel, side_b = along.cross(side_a);
  const gl::Program& program = shaders_.handle;
  program.set("foot", Eigen::Vector3f(foot.cast<float>()));
  program.set("axis", Eigen::Vector3f(axis.cast<float>()));
  program.set("side_a", Eigen::Vector3f(side_a.cast<float>()));
  program.set("side_b", Eigen::Vector3f(side_b.cast<float>()));
  glBindVertexArray(solid.array.get());
  const Colour& colour = active ? kActiveColour : kSelectedColour;
  const auto draw = [&](float alpha) {
    program.set("ink", colour.x(), colour.y(), colour.z(), alpha);
    glDrawArrays(GL_TRIANGLES, 0, solid.vertices);
  };
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_GREATER);  // behind a surface it stays visible, but says that it is behind
  draw(0.35F);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LEQUAL);
  draw(1.0F);
}

void ScenePass::draw_flat(const Picture& picture, const EyeView& eye) const {
  glDisable(GL_DEPTH_TEST);
  if (picture.rubber_band) {
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    const PixelRect& band = *picture.rubber_band;
    const gl::Program& program = shaders_.rectangle;
    program.use();
    program.set("rectangle", static_cast<float>(band.x0), static_cast<float>(band.y0), static_cast<float>(band.x1),
                static_cast<float>(band.y1));
    const Eigen::Matrix3d picture_from_image = picture_from(eye.image);
    program.set("picture_from_image", Eigen::Matrix3f(picture_from_image.cast<float>()));
    program.set("soft", static_cast<float>(picture_from_image.row(0).head<2>().norm()),
                static_cast<float>(picture_from_image.row(1).head<2>().norm()));
    glBindVertexArray(no_attributes_.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  glDisable(GL_BLEND);
  if (picture.overlay) picture.overlay(eye.image);
}

}  // namespace prismesh::kiosk::render
