// Weaves the eyes' images into the display's picture. This is the last step: after it no pixel may change.
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
  /// Draws into a framebuffer of width x height pixels (0: the window's). Errors: the graphics driver refuses the shader.
  Result<void> draw(const Composition& composition, const EyeImages& images, unsigned framebuffer, int width, int height);

  std::size_t bytes_held() const { return bytes_of_phases(columns_, rows_); }
  static std::size_t bytes_of_phases(int columns, int rows) {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) * 8;
  }

 private:
  /// Selects the program. There is one for each variant, as software renderers execute every branch of a shader.
  struct Variant {
    Join join = Join::alone;
    bool by_rows = false;
    bool subpixels = false;
    bool leaking = false;
    auto operator<=>(const Variant&) const = default;  // NOLINT(modernize-use-nullptr): the check mistakes the operator
  };
  static std::string fragment_shader(const Variant& variant);
  Result<const gl::Program*> program_for(const Variant& variant);
  void upload(const drivers::display::PhaseMap& phases);

  std::map<Variant, gl::Program> programs_;
  gl::VertexArray no_attributes_ = gl::VertexArray::make();
  gl::Texture phases_;
  int columns_ = 0, rows_ = 0;  ///< of the texture phases_
};

}  // namespace prismesh::kiosk::render
