// Runs the safety again on a record of the haptic loop, and compares what it decides now with what was decided then.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/haptics/pen_record.h"
#include "drivers/haptics/safety.h"

namespace prismesh::drivers::haptics {

struct ReplayReport {
  /// A tick in which the recorded phase or fault changed, and the first one.
  struct Change {
    std::size_t tick = 0;
    SafetyPhase phase = SafetyPhase::disarmed;
    SafetyFault fault = SafetyFault::none;
  };
  std::vector<Change> changes;
  double seconds = 0;             ///< from the first tick to the last
  double max_newton = 0;          ///< sent
  double max_speed_mm_s = 0;      ///< as the safety measures it
  std::int64_t worst_gap_ns = 0;  ///< between two ticks
  std::uint64_t lost_replies = 0;
  std::size_t limited_ticks = 0;  ///< that the energy tank has shortened

  std::size_t decisions_compared = 0;  ///< ticks whose phase and fault were compared
  std::size_t forces_compared = 0;     ///< ticks whose force was
  std::size_t differing = 0;           ///< of both
  std::optional<std::size_t> first_difference;
};

/// The energy that the safety had in store at the record's beginning isn't known. So forces are compared bit for bit from where the loop
/// began, or where the pen was armed after half a second at rest. Before that, in a record that begins while the pen is armed, the safety
/// is armed a little later than it was: its faults are compared from there, its forces aren't.
ReplayReport replay(const PenRecord& record);

}  // namespace prismesh::drivers::haptics
