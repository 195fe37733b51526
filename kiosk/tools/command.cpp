#include "kiosk/tools/command.h"

#include <array>

namespace prismesh::kiosk::tools {
namespace {

using display::Key;
using display::letter;

constexpr Key digit(int value) { return static_cast<Key>('0' + value); }

constexpr std::array kKeys = {
    KeyBinding{letter('O'), true, false, Command::open, "Ctrl+O", "open a deck"},
    KeyBinding{letter('S'), true, false, Command::save, "Ctrl+S", "save"},
    KeyBinding{letter('S'), true, true, Command::save_as, "Ctrl+Shift+S", "save under another name"},
    KeyBinding{letter('Z'), true, false, Command::undo, "Ctrl+Z", "undo the last edit, selections included"},
    KeyBinding{letter('Y'), true, false, Command::redo, "Ctrl+Y", "redo"},
    KeyBinding{Key::escape, false, false, Command::cancel, "Esc", "cancel a drag, close a panel, or clear the selection"},
    KeyBinding{letter('G'), false, false, Command::grow, "G", "grow the selection by a ring"},
    KeyBinding{letter('B'), false, false, Command::shrink, "B", "shrink the selection by a ring"},
    KeyBinding{letter('I'), false, false, Command::invert, "I", "invert the selection"},
    KeyBinding{letter('V'), false, false, Command::toggle_through, "V", "rectangle takes visible nodes, or all through the model"},
    KeyBinding{letter('H'), false, false, Command::hide, "H", "hide the part under the pointer, else the selection's parts"},
    KeyBinding{letter('O'), false, false, Command::only, "O", "show only that part or those parts"},
    KeyBinding{letter('S'), false, false, Command::show_all, "S", "show all parts"},
    KeyBinding{letter('F'), false, false, Command::fit, "F", "fit the visible model into the picture"},
    KeyBinding{digit(1), false, false, Command::view_front, "1", "view from the front"},
    KeyBinding{digit(2), false, false, Command::view_back, "2", "view from behind"},
    KeyBinding{digit(3), false, false, Command::view_left, "3", "view from the left"},
    KeyBinding{digit(4), false, false, Command::view_right, "4", "view from the right"},
    KeyBinding{digit(5), false, false, Command::view_top, "5", "view from above"},
    KeyBinding{digit(6), false, false, Command::view_bottom, "6", "view from below"},
    KeyBinding{digit(7), false, false, Command::view_oblique, "7", "oblique view"},
    KeyBinding{letter('Q'), false, false, Command::colour_mode, "Q", "colour by part or by quality"},
    KeyBinding{letter('P'), false, false, Command::next_profile, "P", "next display profile"},
    KeyBinding{letter('Z'), false, false, Command::selection_to_plane, "Z", "bring the selection into the plane of the screen"},
    KeyBinding{letter('X'), false, false, Command::keep_selection_in_plane, "X", "keep every new selection there, or not"},
    KeyBinding{Key::page_up, false, false, Command::more_depth, "PgUp", "more depth"},
    KeyBinding{Key::page_down, false, false, Command::less_depth, "PgDn", "less depth"},
    KeyBinding{Key::page_up, true, false, Command::wider_comfort, "Ctrl+PgUp", "let a model reach farther out of and into the screen"},
    KeyBinding{Key::page_down, true, false, Command::narrower_comfort, "Ctrl+PgDn", "less far: easier on the eyes"},
    KeyBinding{letter('R'), true, false, Command::rearm, "Ctrl+R", "try the prism mask again after it was stuck"},
    KeyBinding{Key::f11, false, false, Command::fullscreen, "F11", "fullscreen on and off"},
    KeyBinding{Key::f1, false, false, Command::help, "F1", "show or hide this help"},
};

constexpr std::array kMouse = {
    MouseBinding{"left click", "select the nearest visible node; in the empty ground: clear the selection"},
    MouseBinding{"Shift+left, Ctrl+left", "add to the selection, remove from it (clicks, double clicks and rectangles)"},
    MouseBinding{"double click", "select the region around the node, up to creases and edges"},
    MouseBinding{"left drag", "select with a rectangle"},
    MouseBinding{"left drag on the arrow", "lift the selection along the normal; Esc cancels"},
    MouseBinding{"left drag on the ring", "move the selection in the plane of the screen; Esc cancels"},
    MouseBinding{"right click", "remove the nearest visible node from the selection"},
    MouseBinding{"middle click", "take back the last selection step"},
    MouseBinding{"right drag, Alt+left drag", "orbit"},
    MouseBinding{"middle drag, Alt+right drag", "pan"},
    MouseBinding{"wheel", "zoom to the pointer"},
};

}  // namespace

std::span<const KeyBinding> key_bindings() { return kKeys; }
std::span<const MouseBinding> mouse_bindings() { return kMouse; }

bool repeats(Command command) {
  switch (command) {
    case Command::undo:
    case Command::redo:
    case Command::grow:
    case Command::shrink:
    case Command::more_depth:
    case Command::less_depth:
    case Command::wider_comfort:
    case Command::narrower_comfort: return true;
    default: return false;
  }
}

std::optional<Command> command_for(Key key, const display::Modifiers& modifiers) {
  if (modifiers.alt) return std::nullopt;
  for (const KeyBinding& binding : kKeys)
    if (binding.key == key && binding.ctrl == modifiers.ctrl && (!binding.ctrl || binding.shift == modifiers.shift)) return binding.command;
  return std::nullopt;
}

}  // namespace prismesh::kiosk::tools
