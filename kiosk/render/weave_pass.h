// Makes one picture of the eyes' images: the last step, after which nothing may touch a pixel.
#pragma once

#include <compare>
#include <map>
#include <string>

#include "kiosk/render/composition.h"
#include "kiosk/render/eye_images.h"
#include "kiosk/render/gl.h"

namespace prismesh::kiosk::render {

class WeavePass {
 public:
  /// Into a framebuffer of width x height pixels (0: the window's). Errors: the graphics driver refuses the shader.
  Result<void> draw(const Composition& composition, const EyeImages& images, unsigned framebuffer, int width, int height);

 private:
  /// A program for each way of weaving: software renderers walk through every branch of a shader, taken or not.
  struct Way {
    Join join = Join::alone;
    bool by_rows = false;
    bool subpixels = false;
    bool leaking = false;
    auto operator<=>(const Way&) const = default;  // NOLINT(modernize-use-nullptr): the check mistakes the operator
  };
  static std::string fragment_shader(const Way& way);
  Result<const gl::Program*> program_for(const Way& way);
  void upload(const drivers::display::PhaseMap& phases);

  std::map<Way, gl::Program> programs_;
  gl::VertexArray no_attributes_ = gl::VertexArray::make();
  gl::Texture phases_;
  int columns_ = 0, rows_ = 0;  ///< of the texture
};

}  // namespace prismesh::kiosk::render
