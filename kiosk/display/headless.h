// Creates an OpenGL ES context without a screen, on EGL's surfaceless platform. Software rendering is enough.
#pragma once

#include <memory>

#include "base/error.h"

namespace prismesh::kiosk::display {

class Headless {
 public:
  /// Creates the context and makes it current on this thread. Errors: no EGL, no surfaceless platform, no OpenGL ES 3.1; they name the
  /// packages to install.
  static Result<Headless> create();
  Headless(Headless&&) noexcept;
  Headless& operator=(Headless&&) noexcept;
  ~Headless();

 private:
  struct Impl;
  explicit Headless(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace prismesh::kiosk::display
