// The commands and keys of the view.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "kiosk/input/command.h"

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
  fit_model,
  thickness,
};

constexpr input::Command command_of(ViewCommand command) { return {kName, static_cast<std::uint8_t>(command)}; }

inline constexpr std::array kKeys = {
    input::KeyBinding{display::letter('F'), false, false, command_of(ViewCommand::fit), input::Menu::view, "F",
                      "fit the selection into the view, else the visible model"},
    input::KeyBinding{display::letter('F'), true, false, command_of(ViewCommand::fit_model), input::Menu::view, "Ctrl+F",
                      "fit the visible model into the view"},
    input::KeyBinding{input::digit_key(1), false, false, command_of(ViewCommand::front), input::Menu::view, "1", "view from the front"},
    input::KeyBinding{input::digit_key(2), false, false, command_of(ViewCommand::back), input::Menu::view, "2", "view from behind"},
    input::KeyBinding{input::digit_key(3), false, false, command_of(ViewCommand::left), input::Menu::view, "3", "view from the left"},
    input::KeyBinding{input::digit_key(4), false, false, command_of(ViewCommand::right), input::Menu::view, "4", "view from the right"},
    input::KeyBinding{input::digit_key(5), false, false, command_of(ViewCommand::top), input::Menu::view, "5", "view from above"},
    input::KeyBinding{input::digit_key(6), false, false, command_of(ViewCommand::bottom), input::Menu::view, "6", "view from below"},
    input::KeyBinding{input::digit_key(7), false, false, command_of(ViewCommand::oblique), input::Menu::view, "7", "oblique view"},
    input::KeyBinding{display::letter('Q'), false, false, command_of(ViewCommand::colour_mode), input::Menu::view, "Q",
                      "colour by part, by quality, or parts by their state"},
    input::KeyBinding{display::letter('Y'), false, false, command_of(ViewCommand::shadows), input::Menu::view, "Y",
                      "shadows of the pulled surface beside the model, or none"},
    input::KeyBinding{display::letter('Q'), false, true, command_of(ViewCommand::thickness), input::Menu::view, "Shift+Q",
                      "draw shells with their thickness, as plates, or as surfaces"},
    input::KeyBinding{display::letter('P'), false, false, command_of(ViewCommand::next_profile), input::Menu::display, "P",
                      "next display profile"},
    input::KeyBinding{display::letter('Z'), false, false, command_of(ViewCommand::selection_to_plane), input::Menu::display, "Z",
                      "bring the selection into the plane of the screen"},
    input::KeyBinding{display::letter('X'), false, false, command_of(ViewCommand::keep_selection_in_plane), input::Menu::display, "X",
                      "keep every new selection there, or not"},
    input::KeyBinding{display::Key::page_up, false, false, command_of(ViewCommand::more_depth), input::Menu::display, "PgUp", "more depth",
                      input::kRepeats},
    input::KeyBinding{display::Key::page_down, false, false, command_of(ViewCommand::less_depth), input::Menu::display, "PgDn",
                      "less depth", input::kRepeats},
    input::KeyBinding{display::Key::page_up, true, false, command_of(ViewCommand::wider_comfort), input::Menu::display, "Ctrl+PgUp",
                      "let a model reach farther out of and into the screen", input::kRepeats},
    input::KeyBinding{display::Key::page_down, true, false, command_of(ViewCommand::narrower_comfort), input::Menu::display, "Ctrl+PgDn",
                      "less far: easier on the eyes", input::kRepeats},
};

}  // namespace prismesh::kiosk::tools::view
