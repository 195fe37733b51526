// The commands of selecting.
#pragma once

#include <cstdint>
#include <string_view>

#include "kiosk/input/command.h"

namespace prismesh::kiosk::tools::selection {

inline constexpr std::string_view kName = "selection";

enum class SelectionCommand : std::uint8_t {
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
  take_in_hand,
};

constexpr input::Command command_of(SelectionCommand command) { return {kName, static_cast<std::uint8_t>(command)}; }

}  // namespace prismesh::kiosk::tools::selection
