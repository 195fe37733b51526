// Reads which mouse button does what from a data file, so that users can keep the layout of other programs. The built-in layouts are
// kiosk/input/mouse/*.toml, which also list all choices.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "kiosk/display/window.h"

namespace prismesh::kiosk::input {

enum class DragDoes : std::uint8_t { outline, remove_outline, other_outline, orbit, pan, zoom };
enum class ClickDoes : std::uint8_t { nothing, pick, unpick, take_back, region };
enum class WheelDoes : std::uint8_t { zoom, angle };

struct MouseBinding {
  std::string gesture;  ///< "left drag"
  std::string meaning;
};

class MouseLayout {
 public:
  /// `file`: its name for errors. Errors: text that isn't TOML, an unknown section, button or deed (with the nearest), no way to draw an
  /// outline, orbit, pan or zoom: each with file and line.
  static Result<MouseLayout> parse(std::string_view text, const std::string& file);

  /// What a button does with these modifiers: the binding for exactly these, or else the one without Shift and Ctrl, which then choose the
  /// select mode.
  DragDoes drag(display::MouseButton button, const display::Modifiers& modifiers) const;
  ClickDoes click(display::MouseButton button, const display::Modifiers& modifiers) const;
  ClickDoes double_click(display::MouseButton button, const display::Modifiers& modifiers) const;
  WheelDoes wheel(const display::Modifiers& modifiers) const;
  /// Whether the binding uses Shift and Ctrl itself: then they don't choose the select mode.
  bool takes_modifiers(display::MouseButton button, const display::Modifiers& modifiers) const;

  /// What the mouse does, in words, in the order of the file.
  std::vector<MouseBinding> in_words() const;

 private:
  template <class Does>
  struct Binding {
    display::MouseButton button = display::MouseButton::left;
    display::Modifiers modifiers;
    Does does{};
  };
  template <class Does>
  static const Binding<Does>* find(const std::vector<Binding<Does>>& all, display::MouseButton button, const display::Modifiers& modifiers);
  friend class MouseReader;

  std::vector<Binding<DragDoes>> drags_;
  std::vector<Binding<ClickDoes>> clicks_, double_clicks_;
  std::vector<Binding<WheelDoes>> wheels_;
};

struct MouseText {
  std::string_view name, text;
};
extern const std::array<MouseText, 3> kMouseTexts;

/// A built-in layout by its name, or a file's: a text with a slash, or one that ends in .toml. Errors: no such name (the nearest is
/// named), those of the file.
Result<MouseLayout> find_mouse_layout(const std::string& name_or_file);
/// The built-in layout "default".
MouseLayout default_mouse_layout();

}  // namespace prismesh::kiosk::input
