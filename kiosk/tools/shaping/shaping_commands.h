// The commands of shaping.
#pragma once

#include <cstdint>
#include <string_view>

#include "kiosk/input/command.h"

namespace prismesh::kiosk::tools::shaping {

inline constexpr std::string_view kName = "shaping";

enum class ShapingCommand : std::uint8_t {
  type_number,
  next_handle,
  pick_axis,
  axis_edge,
  axis_x,
  axis_y,
  axis_z,
  no_axis,
  panel,
  rigid,
  falloff,
  flatter,
  less_flat,
  along,
  along_nodes,
  along_edge,
  along_view,
  free_ends,
  origin,
  each_normal,
  move_limit,
  symmetry,
  symmetry_place,
  across_welds,
  keep_apart,
};

constexpr input::Command command_of(ShapingCommand command) { return {kName, static_cast<std::uint8_t>(command)}; }

}  // namespace prismesh::kiosk::tools::shaping
