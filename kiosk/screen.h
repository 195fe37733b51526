// Lays the panels out and draws the pictures: scene, panels and pointer for both eyes.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/error.h"
#include "kiosk/editor.h"
#include "kiosk/item_trace.h"
#include "kiosk/panel_arrangement.h"
#include "kiosk/panels/gui.h"

namespace prismesh::kiosk {

class Screen {
 public:
  Screen(panels::Gui gui, std::vector<input::MouseBinding> mouse, KeptArrangement arrangement, Editor& editor);

  panels::Gui& gui() { return gui_; }
  void set_size(display::PixelSize size);
  display::PixelSize size() const { return size_; }

  /// Lays the panels out and does what the user asked for. Needed between press and release of a button or a key, so that a quick press
  /// isn't lost.
  Result<void> lay_out();
  /// `pointer`: drawn into the picture, where the display has none of its own or that would lie on the woven picture.
  enum class Pace : std::uint8_t { rest, moving, waiting };  ///< see render::Picture
  Result<void> draw(unsigned framebuffer, const std::optional<input::Pixel>& pointer, Pace pace);
  /// Draws a piece of the picture at rest, in about `budget_ns`. Returns whether it is whole: then `draw` shows it fast.
  Result<bool> draw_piece(std::int64_t budget_ns);

 private:
  panels::Gui gui_;
  std::vector<input::MouseBinding> mouse_;  ///< what the mouse does, in words
  PanelArrangement panels_;
  Editor& editor_;
  display::PixelSize size_{1, 1};
  std::optional<input::Pixel> pointer_;
  std::int64_t laid_out_ns_ = 0;
  ItemTrace items_;
};

}  // namespace prismesh::kiosk
