#include "kiosk/render/contact_pass.h"

#include <cmath>

#include "kiosk/render/palette.h"

namespace prismesh::kiosk::render {

namespace {

constexpr double kTextureTowardEye = 0.7;  ///< pixels: less than lines on the surface
constexpr float kHiddenAlpha = 0.4F;

}  // namespace

double stripe_period(double mm_per_unit, double mm_per_pixel) {
  return std::exp2(std::ceil(std::log2(2 * kStripePixels * mm_per_pixel / mm_per_unit)));
}

void ContactPass::draw(const ModelLayer& model, const Frame& frame) const {
  const ContactMarks& marks = model.contact();
  const bool dragged = model.previewing();
  if (marks.chosen().count + marks.shells().count + (dragged ? marks.moved().count + marks.touched().count : 0) == 0) return;
  frame.set(shaders_.alert);
  shaders_.alert.set("eye_in_model", frame.eye_in_model);
  shaders_.alert.set("toward_eye_mm", static_cast<float>(kTextureTowardEye * frame.eye.mm_per_pixel));
  shaders_.alert.set("period", static_cast<float>(stripe_period(frame.view.mm_per_unit, frame.eye.mm_per_pixel)));
  shaders_.alert.set("bright", kAlertBright);
  shaders_.alert.set("dark", kAlertDark);
  const RowTexture& positions = model.textures().positions();
  blend_by_alpha();
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_GREATER);
  draw_shells(marks.chosen(), positions, kHiddenAlpha, frame.span);
  if (dragged) {
    draw_shells(marks.touched(), positions, kHiddenAlpha, frame.span);
    draw_shells(marks.moved(), model.preview_positions(), kHiddenAlpha, frame.span);
  }
  glDepthFunc(GL_LEQUAL);
  draw_shells(marks.shells(), positions, 1, frame.span);
  draw_shells(marks.chosen(), positions, 1, frame.span);
  if (dragged) {
    draw_shells(marks.touched(), positions, 1, frame.span);
    glDepthMask(GL_TRUE);  // no other surface is drawn where these are
    draw_shells(marks.moved(), model.preview_positions(), 1, frame.span);
  }
  glDepthMask(GL_TRUE);
}

void ContactPass::draw_shells(const ContactMarks::Shells& shells, const RowTexture& positions, float alpha, DrawSpan& span) const {
  const DrawSpan::Part now = span.take(shells.count);
  if (now.count == 0) return;
  positions.bind(unit::kPositions);
  shells.connectivity.bind(unit::kConnectivity);
  shaders_.alert.set("alpha", alpha);
  glBindVertexArray(no_attributes_.get());
  glDrawArrays(GL_TRIANGLES, static_cast<GLint>(now.first * 6), static_cast<GLsizei>(now.count * 6));
}

}  // namespace prismesh::kiosk::render
