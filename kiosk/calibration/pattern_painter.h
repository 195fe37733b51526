// Draws a calibration pattern into the eyes' images instead of a model. An OpenGL ES 3.1 context must be current.
#pragma once

#include "kiosk/calibration/pattern.h"
#include "kiosk/render/gl.h"
#include "kiosk/render/picture.h"

namespace prismesh::kiosk::calibration {

class PatternPainter {
 public:
  /// Links the shaders. Errors: a shader that the driver refuses.
  static Result<PatternPainter> create();
  /// Covers the bound image with the pattern. An image from between the eyes gets the left eye's colours, and stripes and bars on the
  /// display's pixels. An image of one eye has no stripes and bars, as its pixels aren't the display's.
  void paint(const Pattern& pattern, const render::EyeImage& image) const;

 private:
  PatternPainter() = default;
  render::gl::Program program_;
  render::gl::VertexArray no_attributes_ = render::gl::VertexArray::make();
};

}  // namespace prismesh::kiosk::calibration
