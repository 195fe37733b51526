// What a key or an entry of the menu asks for: one table that the program, its menu, its help panel and docs/kiosk.md share.
#pragma once

#include <array>
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
  save_copy,
  deck_warnings,
  undo,
  redo,
  compare,
  compare_panel,
  two_views,
  cancel,
  expression,
  outline_kind,
  toggle_through,
  grow,
  shrink,
  invert,
  region,
  region_by,
  wider_angle,
  narrower_angle,
  region_across_welds,
  type_number,
  next_tool,
  pick_axis,
  axis_edge,
  axis_x,
  axis_y,
  axis_z,
  no_axis,
  shaping_panel,
  falloff,
  flatter,
  less_flat,
  along,
  free_ends,
  origin,
  each_normal,
  move_limit,
  symmetry,
  symmetry_place,
  weights_across_welds,
  quality_panel,
  next_error,
  previous_error,
  damaged_only,
  relax_selection,
  relax_part,
  relax_from,
  relax_failed,
  repair_damaged,
  repair_selection,
  repair_all,
  split,
  collapse,
  merge,
  swap,
  do_previewed,
  hide,
  only,
  show_all,
  reverse,
  lock,
  unlock,
  hide_file,
  only_file,
  lock_file,
  fit,
  view_front,
  view_back,
  view_left,
  view_right,
  view_top,
  view_bottom,
  view_oblique,
  colour_mode,
  shadows,
  next_profile,
  selection_to_plane,
  keep_selection_in_plane,
  more_depth,
  less_depth,
  wider_comfort,
  narrower_comfort,
  rearm,
  fullscreen,
  menu,
  help,
};
inline constexpr std::size_t kCommandCount = static_cast<std::size_t>(Command::help) + 1;

enum class Menu : std::uint8_t { file, edit, select, shape, mesh, parts, view, display, help };
inline constexpr std::array<std::string_view, 9> kMenuNames{"File", "Edit", "Select", "Shape", "Mesh", "Parts", "View", "Display", "Help"};

struct KeyBinding {
  display::Key key = display::Key::none;
  bool ctrl = false;
  bool shift = false;
  Command command = Command::cancel;
  Menu menu = Menu::file;    ///< where its entry stands
  std::string_view label;    ///< the key as people write it: "Ctrl+Shift+S"
  std::string_view meaning;  ///< what it does, a short sentence part; the entry's text
};

/// All commands with their keys, in the order in which help and the menu show them.
std::span<const KeyBinding> key_bindings();

/// The command of a key, if it has one. Shift must match for keys with Ctrl; elsewhere a key with Shift that has no meaning of its own has
/// that of the plain key.
std::optional<Command> command_for(display::Key key, const display::Modifiers& modifiers);

/// Whether it edits the model, the selection or what is known of parts, or begins to.
bool asks_for_edit(Command command);

/// Whether a key held down asks for it again and again.
bool repeats(Command command);

}  // namespace prismesh::kiosk::tools
