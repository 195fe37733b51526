#include "kiosk/render/scene_pass.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "kiosk/render/glyph_levels.h"
#include "kiosk/render/handle_mesh.h"
#include "kiosk/render/palette.h"

namespace prismesh::kiosk::render {

namespace {

// Widths and sizes in display pixels.
constexpr float kBorderHalfWidth = 1.0F;
constexpr float kCreaseHalfWidth = 0.7F;
constexpr float kSelectedRimHalfWidth = 1.4F;
constexpr float kLineElementHalfWidth = 0.9F;
constexpr float kCrowdedLineAlpha = 0.35F;  ///< of line elements a few pixels long
constexpr float kPreviewHalfWidth = 0.65F;
constexpr float kCrossingHalfWidth = 2.0F;
constexpr float kWayOutHalfWidth = 0.9F;
constexpr float kHemWidth = 1.1F;
constexpr float kCutHalfWidth = 1.3F;
/// A shell with a smaller radius on the screen is enlarged to this one for its glyph.
constexpr RadiusLimits kGlyphRadius{9.0F, 5.0F, 0.7F};
constexpr double kGlyphSpacing = 24;  ///< of glyphs that are shown, about
constexpr float kTransparentOpacity = 0.3F;
constexpr double kNearestMm = 50;        ///< what is nearer to the eye counts as at this distance, for its level of detail
constexpr double kLinesTowardEye = 1.3;  ///< pixels: depth offset of lines from the surface they lie on

/// Cuts off what lies above the model's cut, where the driver can, until it goes out of scope.
class CutOff {
 public:
  explicit CutOff(const ModelLayer& model) : on_(model.cut().has_value() && gl::has_clip_distance()) {
    if (on_) glEnable(gl::kClipDistance);
  }
  ~CutOff() { end(); }
  CutOff(const CutOff&) = delete;
  CutOff& operator=(const CutOff&) = delete;
  void end() {
    if (std::exchange(on_, false)) glDisable(gl::kClipDistance);
  }

 private:
  bool on_;
};

constexpr int kFacesOfPlate = 6;

/// Sets what the program of plates reads. Plates are closed, so that faces turned away needn't be drawn, until this goes out of scope;
/// where a cut opens them, their inside is seen.
class PlateFaces {
 public:
  PlateFaces(const gl::Program& program, const ModelLayer& model) {
    const bool open = model.cut().has_value() && gl::has_clip_distance();
    model.plates().rows().bind(unit::kPlates);
    model.plates().thicknesses().bind(unit::kThicknesses);
    program.set("plates", static_cast<int>(unit::kPlates));
    program.set("thicknesses", static_cast<int>(unit::kThicknesses));
    program.set("thick_parts", static_cast<int>(model.plates().part_count()));
    program.set("show_inside", open ? 1 : 0);
    glFrontFace(GL_CCW);
    glCullFace(GL_BACK);
    if (!open) glEnable(GL_CULL_FACE);
  }
  ~PlateFaces() { glDisable(GL_CULL_FACE); }
  PlateFaces(const PlateFaces&) = delete;
  PlateFaces& operator=(const PlateFaces&) = delete;
};

}  // namespace

ScenePass::ScenePass(const Shaders& shaders)
    : shaders_(shaders), no_attributes_(gl::VertexArray::make()), nodes_(shaders), handle_(shaders), shadows_(shaders), contact_(shaders) {}

Result<void> ScenePass::prepare(const Picture& picture, ModelLayer& model) {
  if (picture.colour == ColourMode::part_states)
    if (Result<void> looked = model.update_part_looks(picture.damaged_only); !looked) return looked;
  if (picture.thickness)
    if (Result<void> made = model.update_plates(); !made) return made;
  return picture.shadows ? shadows_.cast(model, picture.view) : Result<void>();
}

void ScenePass::begin(const EyeView& eye, DrawSpan& span) const {
  for (const GLenum capability : {GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_BLEND, GL_CULL_FACE}) glDisable(capability);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glStencilMask(0xffU);
  if (!span.takes()) return;
  glClearDepthf(1);
  glClearStencil(0);
  glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  draw_ground(eye);
}

void ScenePass::begin_pane(const EyeView& eye, double from, double to, DrawSpan& span) const {
  const auto place = [&](const char* corner, double x, double y) {
    const Eigen::Vector2f at = (eye.image.from_picture * Eigen::Vector3d(x, y, 1)).cast<float>();
    shaders_.pane.set(corner, at.x(), at.y());
  };
  const bool now = span.takes();
  glDisable(GL_STENCIL_TEST);
  glDepthMask(GL_TRUE);
  if (now) glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  glDisable(GL_DEPTH_TEST);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_ALWAYS, 1, 0xffU);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  shaders_.pane.use();
  place("corner_a", from, 0);
  place("corner_b", to, 0);
  place("corner_c", to, eye.image.picture_height);
  place("corner_d", from, eye.image.picture_height);
  glBindVertexArray(no_attributes_.get());
  if (now) glDrawArrays(GL_TRIANGLES, 0, 6);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glStencilFunc(GL_EQUAL, 1, 0xffU);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
}

void ScenePass::draw(const Picture& picture, const ViewContent& content, const EyeView& eye, const DrawCaps& caps, DrawSpan& span) const {
  ModelLayer& model = content.model;
  const Frame frame(eye, picture, model, span);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  if (!model.empty()) {
    CutOff cut(model);
    model.textures().positions().bind(unit::kPositions);
    model.textures().connectivity().bind(unit::kConnectivity);
    model.textures().surface().bind(unit::kSurface);
    draw_shells(picture, content, caps.moving_triangles, frame);
    contact_.draw(model, frame);
    model.textures().positions().bind(unit::kPositions);
    draw_model_lines(picture, model, frame);
    if (model.previewing()) draw_preview(model, frame);
    draw_contact_lines(model, frame);
    model.textures().positions().bind(unit::kPositions);
    model.textures().connectivity().bind(unit::kConnectivity);
    if (picture.selected_nodes) nodes_.draw(model, frame);
    if (picture.quality_glyphs || picture.marked) draw_glyphs(picture, model, caps.glyphs, frame);
    cut.end();
    if (picture.shadows && span.takes()) shadows_.draw(model, frame);
    draw_cut(model, frame);
  }
  if (span.takes()) draw_handles(picture, model, eye);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
}

void ScenePass::draw_handles(const Picture& picture, const ModelLayer& model, const EyeView& eye) const {
  const HandleSpace space{picture.view, eye.mm_per_pixel, eye.viewer_mm, model.shown_box()};
  if (!picture.followed_edges.empty()) handle_.draw({followed_edges_piece(picture.followed_edges, space)}, eye);
  if (!picture.halfway_line.empty()) handle_.draw({halfway_piece(picture.halfway_line, space)}, eye);
  if (!picture.measures.empty()) handle_.draw({measures_piece(picture.measures, space)}, eye);
  if (picture.marked_point) handle_.draw(mark_pieces(*picture.marked_point, space), eye);
  if (picture.handle) handle_.draw(handle_pieces(*picture.handle, space), eye);
  if (picture.cut_handle) handle_.draw(cut_pieces(*picture.cut_handle, space), eye);
  if (picture.pen) handle_.draw(pen_pieces(*picture.pen, space), eye);
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

void ScenePass::set_shell_uniforms(const gl::Program& program, const Picture& picture, const ViewContent& content,
                                   const Frame& frame) const {
  const FieldLook& look = content.look;
  frame.set(program);
  const auto& palette = part_colours();
  for (std::size_t i = 0; i < palette.size(); ++i) program.set(("palette[" + std::to_string(i) + "]").c_str(), palette[i]);
  const auto& grades = grade_colours();
  for (std::size_t i = 0; i < grades.size(); ++i) program.set(("grades[" + std::to_string(i) + "]").c_str(), grades[i]);
  program.set("by_grade", picture.colour == ColourMode::quality ? 1 : picture.colour == ColourMode::part_states ? 2 : 0);
  const PartLooks& looks = content.model.part_looks();
  looks.texture().bind(unit::kPartLooks);
  program.set("part_looks", static_cast<int>(unit::kPartLooks));
  program.set("part_count", static_cast<int>(looks.count()));
  const bool coloured = picture.colour == ColourMode::field && look.on;
  content.field.bind(unit::kField, unit::kColourMap, look);
  program.set("field", static_cast<int>(unit::kField));
  program.set("colour_map", static_cast<int>(unit::kColourMap));
  program.set("field_kind", coloured ? content.field.kind_for(content.model.table()) : 0);
  program.set("limits", Eigen::Vector3f(static_cast<float>(look.clear), static_cast<float>(1 / (look.full - look.clear)),
                                        static_cast<float>(look.bands)));
  program.set("eye_in_model", frame.eye_in_model);
  program.set("edge_strength", picture.element_edges ? 0.42F : 0.0F);
  program.set("opacity", 1.0F);
}

/// Parts that are seen through come last, over the others. They don't hide each other, so their order shows in the mixture only.
void ScenePass::draw_opaque_and_transparent(const gl::Program& program, const ViewContent& content,
                                            const std::function<void()>& draw) const {
  content.paint.use(program, false);
  draw();
  if (!content.paint.any_transparent()) return;
  program.set("opacity", kTransparentOpacity);
  content.paint.use(program, true);
  blend_by_alpha();
  glDepthMask(GL_FALSE);
  draw();
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void ScenePass::draw_shells(const Picture& picture, const ViewContent& content, std::size_t moving_triangles, const Frame& frame) const {
  ShellDraws& draws = content.model.shell_draws();
  const gl::Program& program = picture.thickness ? shaders_.plates : shaders_.shells;
  set_shell_uniforms(program, picture, content, frame);
  FacesOfShell faces;
  std::optional<PlateFaces> plate_faces;
  if (picture.thickness) {
    const PlateTextures& plates = content.model.plates();
    faces = {kFacesOfPlate, 0.5 * kMaxPlateWay * plates.max_thickness()};
    plate_faces.emplace(program, content.model);
  }
  const Eigen::Matrix4d clip_from_model = frame.clip_from_model.cast<double>();
  if (!picture.moving || !draws.has_levels())
    return draw_opaque_and_transparent(program, content, [&] { draws.draw_all(clip_from_model, faces, frame.span); });
  // The same for both eyes: from between them.
  const double pixels = picture.view.mm_per_unit * picture.between_eyes_mm.z() / frame.eye.mm_per_pixel;
  const Vec3 away = -stereo::screen_from_deck(picture.view).row(2).head<3>().transpose();  // mm in depth, which is compressed
  draws.choose({stereo::to_deck(picture.view, picture.between_eyes_mm), pixels, kNearestMm, away}, clip_from_model, moving_triangles);
  draw_opaque_and_transparent(program, content, [&] { draws.draw_chosen_shells(faces.count); });
  plate_faces.reset();
  set_shell_uniforms(shaders_.coarse, picture, content, frame);
  draws.coarse().bind(unit::kCoarse);
  shaders_.coarse.set("coarse", static_cast<int>(unit::kCoarse));
  draw_opaque_and_transparent(shaders_.coarse, content, [&] { draws.draw_chosen_coarse(); });
}

void ScenePass::draw_items(const ModelLayer& model, const PaintTexture& paint, const Eigen::Matrix4d& clip_from_deck,
                           DrawSpan& span) const {
  const GLuint ground[4] = {0, 0, 0, 0};
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  if (span.takes()) {
    glClearBufferuiv(GL_COLOR, 0, ground);
    glClearDepthf(1);
    glClear(GL_DEPTH_BUFFER_BIT);
  }
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
  paint.use(shaders_.items, false);
  shaders_.items.set("cut_plane", cut_plane(model));
  const CutOff cut(model);
  model.shell_draws().draw_all(clip_from_model, {}, span);
  glDisable(GL_DEPTH_TEST);
}

void ScenePass::draw_lines(const LineSet& lines, const RowTexture& positions, const LineStyle& style, const Frame& frame) const {
  const DrawSpan::Part now = frame.span.take(lines.count);
  if (now.count == 0) return;
  positions.bind(unit::kPositions);
  lines.texture.bind(unit::kLines);
  frame.set(shaders_.lines);
  shaders_.lines.set("half_width", style.half_width);
  shaders_.lines.set("min_alpha", style.min_alpha);
  shaders_.lines.set("toward_eye_mm", static_cast<float>(kLinesTowardEye * frame.eye.mm_per_pixel));
  shaders_.lines.set("ink", style.ink.x(), style.ink.y(), style.ink.z(), style.ink.w());
  glBindVertexArray(no_attributes_.get());
  glDrawArrays(GL_TRIANGLES, static_cast<GLint>(now.first * 6), static_cast<GLsizei>(now.count * 6));
}

void ScenePass::draw_model_lines(const Picture& picture, const ModelLayer& model, const Frame& frame) const {
  blend_by_alpha();
  glDepthMask(GL_FALSE);
  const RowTexture& positions = model.textures().positions();
  if (picture.outlines) {
    draw_lines(model.creases(), positions, {kCreaseHalfWidth, ink(kCreaseColour, 0.55F)}, frame);
    draw_lines(model.borders(), positions, {kBorderHalfWidth, ink(kBorderColour, 0.85F)}, frame);
  }
  if (picture.selected_nodes) {
    draw_lines(model.selected_rim(), positions, {kSelectedRimHalfWidth + kHemWidth, ink(kBorderColour, 0.9F)}, frame);
    draw_lines(model.selected_rim(), positions, {kSelectedRimHalfWidth, ink(kSelectedColour, 1.0F)}, frame);
  }
  glDepthMask(GL_TRUE);
  draw_lines(model.line_elements(), positions, {kLineElementHalfWidth, ink(kLineElementColour, 1.0F), kCrowdedLineAlpha}, frame);
}

/// A light line in a dark hem shows on the stripes and on any part; what hides it makes it fainter.
void ScenePass::draw_contact_lines(const ModelLayer& model, const Frame& frame) const {
  const ContactMarks& marks = model.contact();
  if (marks.curve().lines().count + marks.vectors().lines().count == 0) return;
  blend_by_alpha();
  glDepthMask(GL_FALSE);
  for (const bool hidden : {true, false}) {
    glDepthFunc(hidden ? GL_GREATER : GL_LEQUAL);
    const float alpha = hidden ? 0.45F : 1.0F;
    draw_hemmed(marks.vectors(), {kWayOutHalfWidth, ink(kInformationColour, alpha)}, frame);
    draw_hemmed(marks.curve(), {kCrossingHalfWidth, ink(kFailColour, alpha)}, frame);
  }
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
}

/// A line in a dark hem shows on any part.
void ScenePass::draw_hemmed(const FreeLines& lines, const LineStyle& style, const Frame& frame) const {
  draw_lines(lines.lines(), lines.positions(), {style.half_width + kHemWidth, ink(kBorderColour, style.ink.w())}, frame);
  draw_lines(lines.lines(), lines.positions(), style, frame);
}

void ScenePass::draw_cut(const ModelLayer& model, const Frame& frame) const {
  if (!model.cut() || model.cut_curves().lines().count == 0) return;
  blend_by_alpha();
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_GREATER);
  draw_hemmed(model.cut_curves(), {kCutHalfWidth, ink(kInformationColour, 0.45F)}, frame);
  glDepthFunc(GL_LEQUAL);
  draw_hemmed(model.cut_curves(), {kCutHalfWidth, ink(kInformationColour, 1.0F)}, frame);
  glDepthMask(GL_TRUE);
}

void ScenePass::draw_preview(const ModelLayer& model, const Frame& frame) const {
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_GREATER);  // edges behind the old surface are drawn, fainter
  draw_lines(model.preview_edges(), model.preview_positions(), {kPreviewHalfWidth, ink(kSelectedColour, 0.45F)}, frame);
  glDepthFunc(GL_LEQUAL);
  draw_lines(model.preview_edges(), model.preview_positions(), {kPreviewHalfWidth, ink(kSelectedColour, 1.0F)}, frame);
  glDepthMask(GL_TRUE);
}

void ScenePass::draw_glyphs(const Picture& picture, ModelLayer& model, std::size_t cap, const Frame& frame) const {
  const Result<ModelLayer::Glyphs> glyphs = model.glyphs(cap, picture.damaged_only);
  if (!glyphs) return;  // Renderer::draw returns the error
  struct Batch {
    const Instances& instances;
    const RowTexture& positions;
    const RowTexture& connectivity;
  };
  std::vector<Batch> batches;
  const ModelTextures& textures = model.textures();
  if (picture.quality_glyphs) {
    batches.push_back({glyphs->model, textures.positions(), textures.connectivity()});
    if (model.previewing()) batches.push_back({glyphs->preview, model.preview_positions(), model.preview_connectivity()});
  }
  if (picture.marked) batches.push_back({model.marked(*picture.marked), textures.positions(), textures.connectivity()});
  frame.set(shaders_.glyphs);
  shaders_.glyphs.set("min_pixels", frame.fitting_radius(kGlyphRadius, model.typical_side()));
  const double spacing = kGlyphSpacing * frame.eye.mm_per_pixel / frame.view.mm_per_unit;
  shaders_.glyphs.set("needed_level", static_cast<int>(needed_glyph_level(spacing)));
  shaders_.glyphs.set("warn_ink", kWarnColour);
  shaders_.glyphs.set("fail_ink", kFailColour);
  shaders_.glyphs.set("mark_ink", kInformationColour);
  blend_by_alpha();
  glDepthMask(GL_FALSE);
  for (const Batch& batch : batches) {
    if (batch.instances.count == 0 || !frame.span.takes(batch.instances.count)) continue;
    batch.positions.bind(unit::kPositions);
    batch.connectivity.bind(unit::kConnectivity);
    glBindVertexArray(batch.instances.array.get());
    glDrawArraysInstanced(GL_TRIANGLES, 0, 6, static_cast<GLsizei>(batch.instances.count));
  }
  glDepthMask(GL_TRUE);
}

}  // namespace prismesh::kiosk::render
