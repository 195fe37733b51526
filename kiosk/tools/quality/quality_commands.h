// The commands of reviewing quality, relaxing and repairing.
#pragma once

#include <cstdint>
#include <string_view>

#include "kiosk/input/command.h"

namespace prismesh::kiosk::tools::quality {

inline constexpr std::string_view kName = "quality";

enum class QualityCommand : std::uint8_t {
  panel,
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
  sheet_limit,
  line_limit,
  relax_threshold,
};

constexpr input::Command command_of(QualityCommand command) { return {kName, static_cast<std::uint8_t>(command)}; }

}  // namespace prismesh::kiosk::tools::quality
