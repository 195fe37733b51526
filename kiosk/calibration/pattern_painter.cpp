#include "kiosk/calibration/pattern_painter.h"

#include <cmath>

namespace prismesh::kiosk::calibration {
namespace {

namespace gl = render::gl;

// Maps a rectangle of the picture into the image.
constexpr const char* kVertex = R"(#version 310 es
precision highp float;
uniform vec4 rectangle;
uniform vec3 map_x, map_y;
out vec2 place;
void main() {
  place = vec2((gl_VertexID & 1) == 0 ? rectangle.x : rectangle.z, (gl_VertexID & 2) == 0 ? rectangle.y : rectangle.w);
  gl_Position = vec4(dot(map_x, vec3(place, 1.0)), dot(map_y, vec3(place, 1.0)), 0.0, 1.0);
}
)";

// Two alternating colours, each `stripe` display pixels wide; 0: only the first.
constexpr const char* kFragment = R"(#version 310 es
precision highp float;
uniform vec3 even, odd;
uniform int stripe;
out vec4 colour;
void main() {
  bool second = stripe > 0 && (int(gl_FragCoord.x) / stripe) % 2 == 1;
  colour = vec4(second ? odd : even, 1.0);
}
)";

Eigen::Vector3f vector(const Colour& colour) { return {colour[0], colour[1], colour[2]}; }

/// A rectangle in the picture's pixels.
struct PixelRectangle {
  double x0, y0, x1, y1;
};

void draw(const gl::Program& program, const PixelRectangle& rectangle, const Colour& even, const Colour& odd = {}, int stripe = 0) {
  program.set("rectangle", static_cast<float>(rectangle.x0), static_cast<float>(rectangle.y0), static_cast<float>(rectangle.x1),
              static_cast<float>(rectangle.y1));
  program.set("even", vector(even));
  program.set("odd", vector(odd));
  program.set("stripe", stripe);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

/// The pixels that a field (in shares of the picture) covers.
template <class Shape>
PixelRectangle pixels_of(const Shape& shape, const render::EyeImage& image) {
  const double w = image.picture_width, h = image.picture_height;
  return {std::round(shape.x0 * w), std::round(shape.y0 * h), std::round(shape.x1 * w), std::round(shape.y1 * h)};
}

/// The pixels of a bar: in the middle of the upper half.
PixelRectangle pixels_of(const Bar& bar, const render::EyeImage& image) {
  const double left = std::floor(0.5 * (image.picture_width - bar.pixels)), top = std::floor(0.25 * image.picture_height);
  return {left, top, left + bar.pixels, top + std::max(8.0, std::floor(0.03 * image.picture_height))};
}

}  // namespace

Result<PatternPainter> PatternPainter::create() {
  Result<gl::Program> program = gl::Program::link("pattern", kVertex, kFragment);
  if (!program) return fail(program.error());
  PatternPainter painter;
  painter.program_ = std::move(*program);
  return painter;
}

void PatternPainter::paint(const Pattern& pattern, const render::EyeImage& image) const {
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  glClearColor(pattern.ground[0], pattern.ground[1], pattern.ground[2], 1);
  glClear(GL_COLOR_BUFFER_BIT);
  program_.use();
  program_.set("map_x", Eigen::Vector3f(image.from_picture.row(0).transpose().cast<float>()));
  program_.set("map_y", Eigen::Vector3f(image.from_picture.row(1).transpose().cast<float>()));
  glBindVertexArray(no_attributes_.get());
  const bool right = image.eye == stereo::Eye::right;
  // A field at the picture's edge is extended beyond it, as an image may show slightly more than the picture.
  const auto extended = [&](PixelRectangle rectangle) {
    const double w = image.picture_width, h = image.picture_height;
    if (rectangle.x0 <= 0) rectangle.x0 = -w;
    if (rectangle.y0 <= 0) rectangle.y0 = -h;
    if (rectangle.x1 >= w) rectangle.x1 = 2 * w;
    if (rectangle.y1 >= h) rectangle.y1 = 2 * h;
    return rectangle;
  };
  for (const Field& field : pattern.fields) draw(program_, extended(pixels_of(field, image)), right ? field.right : field.left);
  if (image.eye) return;
  for (const Stripes& stripes : pattern.stripes) draw(program_, pixels_of(stripes, image), stripes.even, stripes.odd, stripes.pixels);
  for (const Bar& bar : pattern.bars) draw(program_, pixels_of(bar, image), {1, 1, 1});
}

}  // namespace prismesh::kiosk::calibration
