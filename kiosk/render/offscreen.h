// A framebuffer that isn't a window: what `draw` fills when the picture goes to a file or a test.
#pragma once

#include <memory>

#include "base/error.h"
#include "kiosk/render/picture_file.h"

namespace prismesh::kiosk::render {

class Offscreen {
 public:
  /// Errors: larger than the GPU allows (says how large it may be).
  static Result<Offscreen> create(int width, int height);
  Offscreen(Offscreen&&) noexcept;
  Offscreen& operator=(Offscreen&&) noexcept;
  ~Offscreen();

  unsigned framebuffer() const;
  Image read() const;

 private:
  struct State;
  explicit Offscreen(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace prismesh::kiosk::render
