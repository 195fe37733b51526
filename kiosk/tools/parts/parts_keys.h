// The commands and keys of parts.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "kiosk/input/command.h"

namespace prismesh::kiosk::tools::parts {

inline constexpr std::string_view kName = "parts";

enum class PartsCommand : std::uint8_t { hide, only, show_all, reverse, lock, unlock, hide_file, only_file, lock_file };

constexpr input::Command command_of(PartsCommand command) { return {kName, static_cast<std::uint8_t>(command)}; }

inline constexpr std::array kKeys = {
    input::KeyBinding{display::letter('H'), false, false, command_of(PartsCommand::hide), input::Menu::parts, "H",
                      "hide the part under the pointer, else the selection's parts", input::kAsksForEdit | input::kAtPointer},
    input::KeyBinding{display::letter('O'), false, false, command_of(PartsCommand::only), input::Menu::parts, "O",
                      "show only that part or those parts", input::kAsksForEdit | input::kAtPointer},
    input::KeyBinding{display::letter('S'), false, false, command_of(PartsCommand::show_all), input::Menu::parts, "S", "show all parts",
                      input::kAsksForEdit},
    input::KeyBinding{display::letter('U'), false, false, command_of(PartsCommand::reverse), input::Menu::parts, "U",
                      "show what is hidden and hide the rest", input::kAsksForEdit},
    input::KeyBinding{display::letter('K'), false, false, command_of(PartsCommand::lock), input::Menu::parts, "K",
                      "lock that part or those parts: their nodes don't move", input::kAsksForEdit | input::kAtPointer},
    input::KeyBinding{display::letter('U'), false, true, command_of(PartsCommand::unlock), input::Menu::parts, "Shift+U",
                      "unlock that part or those parts", input::kAsksForEdit | input::kAtPointer},
    input::KeyBinding{display::letter('H'), false, true, command_of(PartsCommand::hide_file), input::Menu::parts, "Shift+H",
                      "hide all parts of the include file of the part under the pointer", input::kAsksForEdit | input::kAtPointer},
    input::KeyBinding{display::letter('O'), false, true, command_of(PartsCommand::only_file), input::Menu::parts, "Shift+O",
                      "show only the parts of that file", input::kAsksForEdit | input::kAtPointer},
    input::KeyBinding{display::letter('K'), false, true, command_of(PartsCommand::lock_file), input::Menu::parts, "Shift+K",
                      "lock or unlock the parts of that file", input::kAsksForEdit | input::kAtPointer},
};

}  // namespace prismesh::kiosk::tools::parts
