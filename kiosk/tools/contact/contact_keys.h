// The table of keys of seeing where parts touch.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "kiosk/input/command.h"

namespace prismesh::kiosk::tools::contact {

inline constexpr std::string_view kName = "contact";

enum class ContactCommand : std::uint8_t { panel, next, previous, search };

constexpr input::Command command_of(ContactCommand command) { return {kName, static_cast<std::uint8_t>(command)}; }

inline constexpr std::array kKeys = {
    input::KeyBinding{display::letter('K'), true, false, command_of(ContactCommand::panel), input::Menu::mesh, "Ctrl+K",
                      "show or hide where parts cross or are too close"},
    input::KeyBinding{display::Key::right, true, false, command_of(ContactCommand::next), input::Menu::mesh, "Ctrl+Right",
                      "go to the next place where parts touch, worst first", input::kRepeats},
    input::KeyBinding{display::Key::left, true, false, command_of(ContactCommand::previous), input::Menu::mesh, "Ctrl+Left",
                      "back to the place before", input::kRepeats},
    input::KeyBinding{display::letter('K'), true, true, command_of(ContactCommand::search), input::Menu::mesh, "Ctrl+Shift+K",
                      "look again where parts touch"},
};

}  // namespace prismesh::kiosk::tools::contact
