// What a key or a button of a panel asks for, and the one table of keys that the program, its help panel and docs/kiosk.md share.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "kiosk/display/window.h"

namespace prismesh::kiosk::tools {

enum class Command : std::uint8_t {
  open,
  save,
  save_as,
  undo,
  redo,
  cancel,
  grow,
  shrink,
  invert,
  hide,
  only,
  show_all,
  toggle_through,
  fit,
  view_front,
  view_back,
  view_left,
  view_right,
  view_top,
  view_bottom,
  view_oblique,
  colour_mode,
  next_profile,
  selection_to_plane,
  keep_selection_in_plane,
  more_depth,
  less_depth,
  wider_comfort,
  narrower_comfort,
  rearm,
  fullscreen,
  help,
};

struct KeyBinding {
  display::Key key = display::Key::none;
  bool ctrl = false;
  bool shift = false;
  Command command = Command::cancel;
  std::string_view label;    ///< the key as people write it: "Ctrl+Shift+S"
  std::string_view meaning;  ///< what it does, a short sentence part
};

/// All keys, in the order in which help shows them.
std::span<const KeyBinding> key_bindings();

/// The command of a key, if it has one. Shift must match for keys with Ctrl; elsewhere it is ignored.
std::optional<Command> command_for(display::Key key, const display::Modifiers& modifiers);

/// Whether a key held down asks for it again and again.
bool repeats(Command command);

struct MouseBinding {
  std::string_view gesture;
  std::string_view meaning;
};
/// What the mouse does, in the order in which help shows it.
std::span<const MouseBinding> mouse_bindings();

}  // namespace prismesh::kiosk::tools
