// One picture after another: panels laid out and the scene drawn for both eyes, panels and pointer included.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/clock.h"
#include "base/error.h"
#include "kiosk/editor.h"
#include "kiosk/panels/gui.h"
#include "kiosk/panels/panels.h"
#include "kiosk/render/renderer.h"

namespace prismesh::kiosk {

class Screen {
 public:
  Screen(panels::Gui gui, render::Renderer& renderer, Editor& editor, Clock& clock);

  panels::Gui& gui() { return gui_; }
  void set_size(display::PixelSize size);
  display::PixelSize size() const { return size_; }

  /// Lays the panels out and does what the user asked of them. Needed between two edges of a button or a key, so that a quick
  /// press isn't lost.
  Result<void> lay_out();
  /// `pointer`: drawn into the picture of a stereo profile, where the display's own would lie on the woven picture.
  /// `moving`: for speed, see render::Picture.
  Result<void> draw(unsigned framebuffer, const std::optional<tools::Pixel>& pointer, bool moving);

 private:
  panels::Gui gui_;
  panels::Panels panels_;
  render::Renderer& renderer_;
  Editor& editor_;
  Clock& clock_;
  display::PixelSize size_{1, 1};
  std::optional<tools::Pixel> pointer_;
  std::int64_t laid_out_ns_ = 0;
};

}  // namespace prismesh::kiosk
