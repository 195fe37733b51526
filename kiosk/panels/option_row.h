// The row of settings below the view: each as a button that shows its value, as many as the row has room for.
#pragma once

#include <string>

#include "kiosk/input/command.h"
#include "kiosk/panels/panel_layout.h"

namespace prismesh::kiosk::panels {

/// Inside the row's window. What doesn't fit is left out from the end on: every setting stands in the tool's panel too.
class OptionRow {
 public:
  explicit OptionRow(PanelLayout& layout) : layout_(layout) {}

  /// "Falloff smooth": a click asks for the next value.
  void value(const char* label, const std::string& value, const input::KeyBinding& next);
  /// A button that is lit while the setting is on.
  void toggle(const char* label, bool on, const input::KeyBinding& binding);
  void command(const char* label, const input::KeyBinding& binding);
  /// Words without a button.
  void words(const std::string& text);

 private:
  /// Moves to the next item; false: it has no room, nor has any after it.
  bool next(float width);
  void button(const char* name, const std::string& label, bool lit, const std::string& state, const input::KeyBinding& binding);

  PanelLayout& layout_;
  bool first_ = true, full_ = false;
};

}  // namespace prismesh::kiosk::panels
