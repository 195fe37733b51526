// The memory that a graphics card shows, and the OpenGL ES context that draws into it (GBM and EGL).
#pragma once

#include <memory>
#include <string>

#include "base/error.h"
#include "kiosk/display/kms/card.h"

namespace prismesh::kiosk::display::kms {

class Scanout {
 public:
  /// Makes the context current on this thread, until the scanout is destroyed. `descriptor`: the card's, the caller's. Errors: a driver
  /// without GBM or OpenGL ES 3.1; they name the packages to install.
  static Result<std::unique_ptr<Scanout>> create(int descriptor, std::string name, PixelSize size);
  virtual ~Scanout() = default;

  /// Makes the pictures to come this large. The pictures of before stay valid until they are released.
  virtual Result<void> resize(PixelSize size) = 0;
  /// Ends the picture drawn into framebuffer 0. Returns the card's framebuffer that holds it. Errors: no memory; the GPU was lost.
  virtual Result<ObjectId> swap() = 0;
  /// The display doesn't use this picture any more, so that the next can be drawn into its memory.
  virtual void release(ObjectId framebuffer) = 0;
};

}  // namespace prismesh::kiosk::display::kms
