#include "kiosk/render/flat_pass.h"

#include <array>
#include <cstddef>

#include <Eigen/LU>

namespace prismesh::kiosk::render {

namespace {

// Display pixels.
constexpr float kLassoHalfWidth = 0.9F, kLassoRim = 0.9F;
constexpr float kDash = 7, kGap = 6;
const Colour kLassoRimColour{0.20F, 0.21F, 0.23F};

struct Segment {
  std::array<float, 4> ends;
  float dashed = 0;
};

/// The lasso's line, and a dashed segment from its end to its start that closes it.
std::vector<Segment> segments_of(const std::vector<Eigen::Vector2d>& corners) {
  std::vector<Eigen::Vector2f> points;
  for (const Eigen::Vector2d& corner : corners)
    if (const Eigen::Vector2f point = corner.cast<float>(); point.allFinite()) points.push_back(point);
  std::vector<Segment> segments;
  for (std::size_t i = 0; i < points.size() && points.size() > 1; ++i) {
    const bool closing = i + 1 == points.size();
    const Eigen::Vector2f& a = points[i];
    const Eigen::Vector2f& b = points[closing ? 0 : i + 1];
    if (!closing || points.size() > 2) segments.push_back({{a.x(), a.y(), b.x(), b.y()}, closing ? 1.0F : 0.0F});
  }
  return segments;
}

}  // namespace

FlatPass::FlatPass(const Shaders& shaders)
    : shaders_(shaders), no_attributes_(gl::VertexArray::make()), segments_(gl::VertexArray::make()), segment_buffer_(gl::Buffer::make()) {
  glBindVertexArray(segments_.get());
  glBindBuffer(GL_ARRAY_BUFFER, segment_buffer_.get());
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(Segment), nullptr);
  // NOLINTNEXTLINE(performance-no-int-to-ptr): OpenGL passes offsets as pointers
  glVertexAttribPointer(1, 1, GL_FLOAT, GL_FALSE, sizeof(Segment), reinterpret_cast<const void*>(offsetof(Segment, dashed)));
  for (const GLuint attribute : {0U, 1U}) {
    glEnableVertexAttribArray(attribute);
    glVertexAttribDivisor(attribute, 1);
  }
  glBindVertexArray(0);
}

void FlatPass::draw(const Picture& picture, const EyeView& eye) const {
  glDisable(GL_DEPTH_TEST);
  blend_by_alpha();
  if (picture.rubber_band) draw_rectangle(*picture.rubber_band, eye.image);
  if (!picture.lasso.empty()) draw_lasso(picture.lasso, eye.image);
  glDisable(GL_BLEND);
  if (picture.overlay) picture.overlay(eye.image);
}

void FlatPass::draw_rectangle(const PixelRect& band, const EyeImage& image) const {
  const gl::Program& program = shaders_.rectangle;
  program.use();
  program.set("rectangle", static_cast<float>(band.x0), static_cast<float>(band.y0), static_cast<float>(band.x1),
              static_cast<float>(band.y1));
  const Eigen::Matrix3d picture_from_image = picture_from(image);
  program.set("picture_from_image", Eigen::Matrix3f(picture_from_image.cast<float>()));
  program.set("soft", static_cast<float>(picture_from_image.row(0).head<2>().norm()),
              static_cast<float>(picture_from_image.row(1).head<2>().norm()));
  glBindVertexArray(no_attributes_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void FlatPass::draw_lasso(const std::vector<Eigen::Vector2d>& corners, const EyeImage& image) const {
  const std::vector<Segment> segments = segments_of(corners);
  if (segments.empty()) return;
  glBindVertexArray(segments_.get());
  glBindBuffer(GL_ARRAY_BUFFER, segment_buffer_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(segments.size() * sizeof(Segment)), segments.data(), GL_STREAM_DRAW);
  const gl::Program& program = shaders_.screen_lines;
  program.use();
  Eigen::Matrix3d image_from_picture = Eigen::Matrix3d::Identity();
  image_from_picture.topRows<2>() = image.from_picture;
  program.set("image_from_picture", Eigen::Matrix3f(image_from_picture.cast<float>()));
  const Eigen::Matrix2d pixels_from_texels = picture_from(image).topLeftCorner<2, 2>();
  program.set("pixels_from_texels", Eigen::Matrix2f(pixels_from_texels.cast<float>()));
  program.set("dash", kDash, kGap);
  const auto draw = [&](float half_width, const Colour& colour) {
    program.set("half_width", half_width);
    program.set("reach", half_width + 0.5F + 0.5F * static_cast<float>(pixels_from_texels.norm()));
    program.set("ink", colour.x(), colour.y(), colour.z(), 1.0F);
    glDrawArraysInstanced(GL_TRIANGLES, 0, 6, static_cast<GLsizei>(segments.size()));
  };
  draw(kLassoHalfWidth + kLassoRim, kLassoRimColour);
  draw(kLassoHalfWidth, kSelectedColour);
}

}  // namespace prismesh::kiosk::render
