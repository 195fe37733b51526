// Draws Dear ImGui's triangles with OpenGL ES 3, into an eye's image that may be narrower than the picture it stands for.
// (The backend shipped with the library is built for desktop OpenGL.)
#pragma once

#include <memory>

#include <Eigen/Core>

#include "base/error.h"
#include "kiosk/display/window.h"

struct ImDrawData;

namespace prismesh::kiosk::panels {

/// Places in the picture (pixels from the upper left corner) to an image's normalised coordinates (y up): affine.
using PictureMap = Eigen::Matrix<double, 2, 3>;

class GuiRenderer {
 public:
  /// Needs a current GL context and a current ImGui context. Errors: the driver refuses a shader.
  static Result<GuiRenderer> create();
  GuiRenderer(GuiRenderer&&) noexcept;
  GuiRenderer& operator=(GuiRenderer&&) noexcept;
  ~GuiRenderer();

  /// Takes the font atlas of the current ImGui context, which must have been built or changed since.
  void upload_fonts();

  /// Draws into the bound framebuffer's lower left `target` pixels; `from_picture` says where the picture's places lie there.
  void draw(const ImDrawData& data, display::PixelSize target, const PictureMap& from_picture) const;

 private:
  struct Impl;
  explicit GuiRenderer(std::unique_ptr<Impl> state);
  std::unique_ptr<Impl> impl_;
};

}  // namespace prismesh::kiosk::panels
