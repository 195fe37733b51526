// The command of the pen, and its key.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "kiosk/input/command.h"

namespace prismesh::kiosk::tools::pen {

inline constexpr std::string_view kName = "pen";

enum class PenCommand : std::uint8_t { arm };

constexpr input::Command command_of(PenCommand command) { return {kName, static_cast<std::uint8_t>(command)}; }

inline constexpr std::array kKeys = {
    input::KeyBinding{display::letter('P'), true, true, command_of(PenCommand::arm), input::Menu::display, "Ctrl+Shift+P",
                      "arm the haptic pen: forces may come; or disarm it"},
};

}  // namespace prismesh::kiosk::tools::pen
