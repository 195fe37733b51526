// The commands and keys of the view.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "kiosk/tools/command.h"

namespace prismesh::kiosk::tools::view {

inline constexpr std::string_view kName = "view";

enum class ViewCommand : std::uint8_t {
  fit,
  front,
  back,
  left,
  right,
  top,
  bottom,
  oblique,
  colour_mode,
  shadows,
  next_profile,
  selection_to_plane,
  keep_selection_in_plane,
  more_depth,
  less_depth,
  wider_comfort,
  narrower_comfort,
};

constexpr Command command_of(ViewCommand command) { return {kName, static_cast<std::uint8_t>(command)}; }

inline constexpr std::array kKeys = {
    KeyBinding{display::letter('F'), false, false, command_of(ViewCommand::fit), Menu::view, "F", "fit the visible model into the picture"},
    KeyBinding{digit_key(1), false, false, command_of(ViewCommand::front), Menu::view, "1", "view from the front"},
    KeyBinding{digit_key(2), false, false, command_of(ViewCommand::back), Menu::view, "2", "view from behind"},
    KeyBinding{digit_key(3), false, false, command_of(ViewCommand::left), Menu::view, "3", "view from the left"},
    KeyBinding{digit_key(4), false, false, command_of(ViewCommand::right), Menu::view, "4", "view from the right"},
    KeyBinding{digit_key(5), false, false, command_of(ViewCommand::top), Menu::view, "5", "view from above"},
    KeyBinding{digit_key(6), false, false, command_of(ViewCommand::bottom), Menu::view, "6", "view from below"},
    KeyBinding{digit_key(7), false, false, command_of(ViewCommand::oblique), Menu::view, "7", "oblique view"},
    KeyBinding{display::letter('Q'), false, false, command_of(ViewCommand::colour_mode), Menu::view, "Q",
               "colour by part, by quality, or parts by their state"},
    KeyBinding{display::letter('Y'), false, false, command_of(ViewCommand::shadows), Menu::view, "Y",
               "shadows of the pulled surface beside the model, or none"},
    KeyBinding{display::letter('P'), false, false, command_of(ViewCommand::next_profile), Menu::display, "P", "next display profile"},
    KeyBinding{display::letter('Z'), false, false, command_of(ViewCommand::selection_to_plane), Menu::display, "Z",
               "bring the selection into the plane of the screen"},
    KeyBinding{display::letter('X'), false, false, command_of(ViewCommand::keep_selection_in_plane), Menu::display, "X",
               "keep every new selection there, or not"},
    KeyBinding{display::Key::page_up, false, false, command_of(ViewCommand::more_depth), Menu::display, "PgUp", "more depth", kRepeats},
    KeyBinding{display::Key::page_down, false, false, command_of(ViewCommand::less_depth), Menu::display, "PgDn", "less depth", kRepeats},
    KeyBinding{display::Key::page_up, true, false, command_of(ViewCommand::wider_comfort), Menu::display, "Ctrl+PgUp",
               "let a model reach farther out of and into the screen", kRepeats},
    KeyBinding{display::Key::page_down, true, false, command_of(ViewCommand::narrower_comfort), Menu::display, "Ctrl+PgDn",
               "less far: easier on the eyes", kRepeats},
};

}  // namespace prismesh::kiosk::tools::view
