// An OpenGL ES context without any screen: EGL's surfaceless platform, software rendering is enough.
#pragma once

#include <memory>

#include "base/error.h"

namespace prismesh::kiosk::display {

class Headless {
 public:
  /// Makes the context current on this thread. Errors: no EGL, no surfaceless platform, no OpenGL ES 3.1 (says which package helps).
  static Result<Headless> create();
  Headless(Headless&&) noexcept;
  Headless& operator=(Headless&&) noexcept;
  ~Headless();

 private:
  struct State;
  explicit Headless(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace prismesh::kiosk::display
