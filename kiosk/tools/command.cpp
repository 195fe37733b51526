#include "kiosk/tools/command.h"

namespace prismesh::kiosk::tools {
namespace {

using display::Key;
using display::letter;

constexpr Key digit(int value) { return static_cast<Key>('0' + value); }

constexpr std::array kKeys = {
    KeyBinding{letter('O'), true, false, Command::open, Menu::file, "Ctrl+O", "open a deck"},
    KeyBinding{letter('S'), true, false, Command::save, Menu::file, "Ctrl+S", "save"},
    KeyBinding{letter('S'), true, true, Command::save_as, Menu::file, "Ctrl+Shift+S", "save as another deck, and go on with that one"},
    KeyBinding{letter('C'), true, true, Command::save_copy, Menu::file, "Ctrl+Shift+C", "save a copy, and go on with this deck"},
    KeyBinding{letter('I'), true, false, Command::deck_warnings, Menu::file, "Ctrl+I", "list all warnings of the deck"},
    KeyBinding{letter('Z'), true, false, Command::undo, Menu::edit, "Ctrl+Z", "undo the last edit, selections included"},
    KeyBinding{letter('Y'), true, false, Command::redo, Menu::edit, "Ctrl+Y", "redo"},
    KeyBinding{letter('C'), false, false, Command::compare, Menu::edit, "C", "compare: show the state before the last edit, or after it"},
    KeyBinding{letter('C'), false, true, Command::compare_panel, Menu::view, "Shift+C", "colours by distance and the like, two views"},
    KeyBinding{letter('C'), true, false, Command::two_views, Menu::view, "Ctrl+C", "two views side by side: before and after, or one"},
    KeyBinding{Key::escape, false, false, Command::cancel, Menu::edit, "Esc",
               "stop what takes long, cancel a drag, close a panel, or clear the selection"},
    KeyBinding{letter('E'), false, false, Command::expression, Menu::select, "E", "select by an id expression"},
    KeyBinding{letter('L'), false, false, Command::outline_kind, Menu::select, "L", "draw outlines as a lasso, or as rectangles"},
    KeyBinding{letter('V'), false, false, Command::toggle_through, Menu::select, "V",
               "outlines take visible nodes, or all through the model"},
    KeyBinding{letter('G'), false, false, Command::grow, Menu::select, "G", "grow the selection by a ring"},
    KeyBinding{letter('B'), false, false, Command::shrink, Menu::select, "B", "shrink the selection by a ring"},
    KeyBinding{letter('I'), false, false, Command::invert, Menu::select, "I", "invert the selection"},
    KeyBinding{letter('R'), false, false, Command::region, Menu::select, "R", "select the region under the pointer"},
    KeyBinding{letter('R'), false, true, Command::region_by, Menu::select, "Shift+R",
               "what bounds regions: creases, the part, the piece, a free edge"},
    KeyBinding{Key::page_up, false, true, Command::wider_angle, Menu::select, "Shift+PgUp", "regions go on over sharper creases"},
    KeyBinding{Key::page_down, false, true, Command::narrower_angle, Menu::select, "Shift+PgDn", "regions end at blunter creases"},
    KeyBinding{letter('W'), false, false, Command::region_across_welds, Menu::select, "W", "regions go on over welded sheets, or not"},
    KeyBinding{letter('N'), false, false, Command::type_number, Menu::shape, "N", "type how far to lift, slide, move or turn"},
    KeyBinding{letter('N'), false, true, Command::next_tool, Menu::shape, "Shift+N", "what typed numbers do: lift, slide, move"},
    KeyBinding{letter('A'), false, false, Command::pick_axis, Menu::shape, "A", "pick an axis to turn about: two nodes"},
    KeyBinding{letter('A'), false, true, Command::axis_edge, Menu::shape, "Shift+A",
               "the axis is the edge under the pointer: free edges and creases first"},
    KeyBinding{letter('X'), false, true, Command::axis_x, Menu::shape, "Shift+X", "the axis is the deck's x through the handle"},
    KeyBinding{letter('Y'), false, true, Command::axis_y, Menu::shape, "Shift+Y", "the axis is the deck's y through the handle"},
    KeyBinding{letter('Z'), false, true, Command::axis_z, Menu::shape, "Shift+Z", "the axis is the deck's z through the handle"},
    KeyBinding{letter('D'), false, true, Command::no_axis, Menu::shape, "Shift+D", "no axis: lift, slide and move again"},
    KeyBinding{letter('T'), false, false, Command::shaping_panel, Menu::shape, "T", "show or hide how pulls fade out"},
    KeyBinding{letter('D'), false, false, Command::falloff, Menu::shape, "D", "next profile of the falloff"},
    KeyBinding{Key::up, true, false, Command::flatter, Menu::shape, "Ctrl+Up", "a wider flat top of the falloff"},
    KeyBinding{Key::down, true, false, Command::less_flat, Menu::shape, "Ctrl+Down", "a narrower one"},
    KeyBinding{letter('G'), false, true, Command::along, Menu::shape, "Shift+G", "fall off in all directions, or along x, y or z only"},
    KeyBinding{letter('F'), false, true, Command::free_ends, Menu::shape, "Shift+F", "free edges follow the pull, or hold"},
    KeyBinding{letter('E'), false, true, Command::origin, Menu::shape, "Shift+E", "the grab is one node, or its whole free edge"},
    KeyBinding{letter('I'), false, true, Command::each_normal, Menu::shape, "Shift+I",
               "lift along the normal at the grab, or each node along its own"},
    KeyBinding{letter('T'), false, true, Command::move_limit, Menu::shape, "Shift+T", "type the farthest that a node may move"},
    KeyBinding{letter('M'), false, false, Command::symmetry, Menu::shape, "M", "mirror the pull: off, at x, y or z"},
    KeyBinding{letter('M'), false, true, Command::symmetry_place, Menu::shape, "Shift+M", "type where the mirror stands"},
    KeyBinding{letter('W'), false, true, Command::weights_across_welds, Menu::shape, "Shift+W", "pulls go on over welded sheets, or not"},
    KeyBinding{letter('J'), false, false, Command::quality_panel, Menu::mesh, "J", "show or hide quality in figures"},
    KeyBinding{Key::right, false, false, Command::next_error, Menu::mesh, "Right", "go to the next error, worst first"},
    KeyBinding{Key::left, false, false, Command::previous_error, Menu::mesh, "Left", "back to the error before"},
    KeyBinding{letter('J'), false, true, Command::damaged_only, Menu::mesh, "Shift+J",
               "signs and errors: all, or only what edits made worse"},
    KeyBinding{letter('L'), true, false, Command::relax_selection, Menu::mesh, "Ctrl+L", "relax the selected nodes"},
    KeyBinding{letter('L'), true, true, Command::relax_part, Menu::mesh, "Ctrl+Shift+L", "relax the selection's parts"},
    KeyBinding{letter('L'), false, true, Command::relax_from, Menu::mesh, "Shift+L", "relax outwards from the node under the pointer"},
    KeyBinding{letter('J'), true, false, Command::relax_failed, Menu::mesh, "Ctrl+J", "relax what fails"},
    KeyBinding{letter('E'), true, false, Command::repair_damaged, Menu::mesh, "Ctrl+E", "repair what edits made worse"},
    KeyBinding{letter('E'), true, true, Command::repair_selection, Menu::mesh, "Ctrl+Shift+E", "repair the shells at the selected nodes"},
    KeyBinding{letter('J'), true, true, Command::repair_all, Menu::mesh, "Ctrl+Shift+J", "repair all that warns or fails"},
    KeyBinding{letter('D'), true, false, Command::split, Menu::mesh, "Ctrl+D", "split: the shell under the pointer, or two at their edge"},
    KeyBinding{letter('B'), true, false, Command::collapse, Menu::mesh, "Ctrl+B", "collapse the edge under the pointer to a point"},
    KeyBinding{letter('M'), true, false, Command::merge, Menu::mesh, "Ctrl+M", "merge the triangles at the edge under the pointer"},
    KeyBinding{letter('W'), true, false, Command::swap, Menu::mesh, "Ctrl+W", "swap the edge under the pointer"},
    KeyBinding{Key::enter, false, false, Command::do_previewed, Menu::mesh, "Enter", "do what is shown as a preview"},
    KeyBinding{letter('H'), false, false, Command::hide, Menu::parts, "H", "hide the part under the pointer, else the selection's parts"},
    KeyBinding{letter('O'), false, false, Command::only, Menu::parts, "O", "show only that part or those parts"},
    KeyBinding{letter('S'), false, false, Command::show_all, Menu::parts, "S", "show all parts"},
    KeyBinding{letter('U'), false, false, Command::reverse, Menu::parts, "U", "show what is hidden and hide the rest"},
    KeyBinding{letter('K'), false, false, Command::lock, Menu::parts, "K", "lock that part or those parts: their nodes don't move"},
    KeyBinding{letter('U'), false, true, Command::unlock, Menu::parts, "Shift+U", "unlock that part or those parts"},
    KeyBinding{letter('H'), false, true, Command::hide_file, Menu::parts, "Shift+H",
               "hide all parts of the include file of the part under the pointer"},
    KeyBinding{letter('O'), false, true, Command::only_file, Menu::parts, "Shift+O", "show only the parts of that file"},
    KeyBinding{letter('K'), false, true, Command::lock_file, Menu::parts, "Shift+K", "lock or unlock the parts of that file"},
    KeyBinding{letter('F'), false, false, Command::fit, Menu::view, "F", "fit the visible model into the picture"},
    KeyBinding{digit(1), false, false, Command::view_front, Menu::view, "1", "view from the front"},
    KeyBinding{digit(2), false, false, Command::view_back, Menu::view, "2", "view from behind"},
    KeyBinding{digit(3), false, false, Command::view_left, Menu::view, "3", "view from the left"},
    KeyBinding{digit(4), false, false, Command::view_right, Menu::view, "4", "view from the right"},
    KeyBinding{digit(5), false, false, Command::view_top, Menu::view, "5", "view from above"},
    KeyBinding{digit(6), false, false, Command::view_bottom, Menu::view, "6", "view from below"},
    KeyBinding{digit(7), false, false, Command::view_oblique, Menu::view, "7", "oblique view"},
    KeyBinding{letter('Q'), false, false, Command::colour_mode, Menu::view, "Q", "colour by part, by quality, or parts by their state"},
    KeyBinding{letter('Y'), false, false, Command::shadows, Menu::view, "Y", "shadows of the pulled surface beside the model, or none"},
    KeyBinding{letter('P'), false, false, Command::next_profile, Menu::display, "P", "next display profile"},
    KeyBinding{letter('Z'), false, false, Command::selection_to_plane, Menu::display, "Z",
               "bring the selection into the plane of the screen"},
    KeyBinding{letter('X'), false, false, Command::keep_selection_in_plane, Menu::display, "X", "keep every new selection there, or not"},
    KeyBinding{Key::page_up, false, false, Command::more_depth, Menu::display, "PgUp", "more depth"},
    KeyBinding{Key::page_down, false, false, Command::less_depth, Menu::display, "PgDn", "less depth"},
    KeyBinding{Key::page_up, true, false, Command::wider_comfort, Menu::display, "Ctrl+PgUp",
               "let a model reach farther out of and into the screen"},
    KeyBinding{Key::page_down, true, false, Command::narrower_comfort, Menu::display, "Ctrl+PgDn", "less far: easier on the eyes"},
    KeyBinding{letter('R'), true, false, Command::rearm, Menu::display, "Ctrl+R", "try the prism mask again after it was stuck"},
    KeyBinding{Key::f11, false, false, Command::fullscreen, Menu::display, "F11", "fullscreen on and off"},
    KeyBinding{Key::f10, false, false, Command::menu, Menu::help, "F10", "show or hide all commands as buttons"},
    KeyBinding{Key::f1, false, false, Command::help, Menu::help, "F1", "show or hide this help"},
};

}  // namespace

std::span<const KeyBinding> key_bindings() { return kKeys; }

bool asks_for_edit(Command command) {
  switch (command) {
    case Command::undo:
    case Command::redo:
    case Command::expression:
    case Command::grow:
    case Command::shrink:
    case Command::invert:
    case Command::region:
    case Command::type_number:
    case Command::relax_selection:
    case Command::relax_part:
    case Command::relax_from:
    case Command::relax_failed:
    case Command::repair_damaged:
    case Command::repair_selection:
    case Command::repair_all:
    case Command::split:
    case Command::collapse:
    case Command::merge:
    case Command::swap:
    case Command::do_previewed:
    case Command::hide:
    case Command::only:
    case Command::show_all:
    case Command::reverse:
    case Command::lock:
    case Command::unlock:
    case Command::hide_file:
    case Command::only_file:
    case Command::lock_file: return true;
    default: return false;
  }
}

bool repeats(Command command) {
  switch (command) {
    case Command::undo:
    case Command::redo:
    case Command::next_error:
    case Command::previous_error:
    case Command::grow:
    case Command::shrink:
    case Command::wider_angle:
    case Command::narrower_angle:
    case Command::flatter:
    case Command::less_flat:
    case Command::more_depth:
    case Command::less_depth:
    case Command::wider_comfort:
    case Command::narrower_comfort: return true;
    default: return false;
  }
}

std::optional<Command> command_for(Key key, const display::Modifiers& modifiers) {
  if (modifiers.alt) return std::nullopt;
  const auto find = [&](bool shift) -> std::optional<Command> {
    for (const KeyBinding& binding : kKeys)
      if (binding.key == key && binding.ctrl == modifiers.ctrl && binding.shift == shift) return binding.command;
    return std::nullopt;
  };
  if (const std::optional<Command> exactly = find(modifiers.shift); exactly || modifiers.ctrl) return exactly;
  return find(false);
}

}  // namespace prismesh::kiosk::tools
