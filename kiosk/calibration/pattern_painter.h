// Draws a calibration pattern into the eyes' images, instead of a model. Needs a current OpenGL ES 3.1 context.
#pragma once

#include "kiosk/calibration/pattern.h"
#include "kiosk/render/gl.h"
#include "kiosk/render/picture.h"

namespace prismesh::kiosk::calibration {

class PatternPainter {
 public:
  /// Errors: a shader that the driver refuses.
  static Result<PatternPainter> create();
  /// Covers the image that is bound. An image from between the eyes gets the left eye's colours; stripes and bars lie on display pixels
  /// there, and are left out of images of one eye, whose pixels aren't the display's.
  void paint(const Pattern& pattern, const render::EyeImage& image) const;

 private:
  PatternPainter() = default;
  render::gl::Program program_;
  render::gl::VertexArray no_attributes_ = render::gl::VertexArray::make();
};

}  // namespace prismesh::kiosk::calibration
