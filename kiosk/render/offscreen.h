// Framebuffer without a window, for pictures that go to a file or a test.
#pragma once

#include <memory>

#include "base/error.h"
#include "kiosk/render/picture_file.h"

namespace prismesh::kiosk::render {

class Offscreen {
 public:
  /// Allocates width x height pixels. Errors: larger than the GPU allows, with the max size; no graphics memory.
  static Result<Offscreen> create(int width, int height);
  Offscreen(Offscreen&&) noexcept;
  Offscreen& operator=(Offscreen&&) noexcept;
  ~Offscreen();

  unsigned framebuffer() const;
  Image read() const;

 private:
  struct Impl;
  explicit Offscreen(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace prismesh::kiosk::render
