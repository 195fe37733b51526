// Holds the ImGui context of the panels, with our fonts and colours: takes window events, and draws into each eye's image.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/error.h"
#include "kiosk/display/window.h"
#include "kiosk/panels/gui_renderer.h"

struct ImFont;

namespace prismesh::kiosk::panels {

/// Sizes of the one type family, in pixels of the picture.
struct TypeSizes {
  float small = 14;
  float body = 16;
  float title = 21;
  bool operator==(const TypeSizes&) const = default;
};
/// Sizes for an ordinary picture and for one whose eyes see half the columns each.
inline constexpr TypeSizes kFlatType{14, 16, 21};
inline constexpr TypeSizes kStereoType{24, 24, 30};
/// The sizes for a picture: larger on a display of many rows, where the eye stands farther away in pixels, and for stereo no larger than a
/// low picture has room for.
TypeSizes type_for(display::PixelSize picture, bool stereo);

/// The same for fingers, and for those who stand: at least 24 pixels, and so large that a button of 2.5 lines is 15 mm high.
TypeSizes for_fingers(const TypeSizes& sizes, double pixel_pitch_mm);

class Gui {
 public:
  /// Needs a current GL context. Errors: the font isn't installed (names the package).
  static Result<Gui> create();
  Gui(Gui&&) noexcept;
  Gui& operator=(Gui&&) noexcept;
  ~Gui();

  Result<void> set_type(const TypeSizes& sizes);
  const TypeSizes& type() const;

  void feed(const display::WindowEvent& event);
  /// Whether a pixel lay on a panel when they were last laid out.
  bool on_panel(double x, double y) const;
  /// A menu or list is open over the panels: it has the pointer wherever that is.
  bool popup_open() const;
  void close_popups();
  /// Something on a panel is held with the pointer.
  bool holds_pointer() const;
  /// A text field has the keyboard.
  bool wants_keys() const;

  /// What Ctrl+V pastes into a field.
  void set_clipboard(const std::string& text);
  /// A text that was copied or cut from a field since the last call.
  std::optional<std::string> take_copied();

  /// Lays the panels out: `build` calls ImGui. `seconds`: since the last time.
  void layout(display::PixelSize picture, double seconds, const std::function<void()>& build);
  /// Draws what was laid out into the bound framebuffer (see GuiRenderer::draw).
  void draw(display::PixelSize target, const PictureMap& from_picture) const;

 private:
  struct Impl;
  explicit Gui(std::unique_ptr<Impl> state);
  std::unique_ptr<Impl> impl_;
};

/// Inside `build`: an arrow whose tip is at the pixel, over everything else.
void draw_pointer(double x, double y);

/// Inside `build`: the fonts of the three sizes. Body is the default.
ImFont* small_font();
ImFont* title_font();

/// Colours with a meaning, 0xAABBGGRR as ImGui packs them. No part has them.
inline constexpr unsigned kInk = 0xffe6e4e2;
inline constexpr unsigned kFaintInk = 0xffaaa6a2;
inline constexpr unsigned kWarnColour = 0xff3cc8f0;
inline constexpr unsigned kFailColour = 0xff4a54ee;
inline constexpr unsigned kInformationColour = 0xffecb468;
inline constexpr unsigned kActiveColour = 0xff7ad65a;
/// What panels stand on: opaque, so that words keep a contrast of 4.5 at least (WCAG 2.1, 1.4.3) whatever the model's colours are.
inline constexpr unsigned kPanelColour = 0xff211f1c;

/// The line between two panels.
inline constexpr unsigned kBorderColour = 0xff3c3a37;

/// The grid that panels keep to, in pixels.
inline constexpr float kGrid = 8;

}  // namespace prismesh::kiosk::panels
