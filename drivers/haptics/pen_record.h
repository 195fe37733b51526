// A record of the haptic loop: what its safety saw and what was sent, tick by tick, as text. A record of a fault in the field is run again
// by replay.h.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "drivers/haptics/forces.h"
#include "drivers/haptics/safety.h"

namespace prismesh::drivers::haptics {

/// One tick as plain numbers; may lie in shared memory.
struct PenTick {
  struct Part {
    double newton[3];
    std::int64_t from_ns;  ///< as ForcePart
  };

  // What went in: SafetyInput.
  std::int64_t now_ns;
  double position_mm[3];
  std::int64_t measured_ns;
  Part parts[kForceKinds];  ///< by ForceKind
  std::uint32_t lost_replies;
  std::uint32_t buttons;
  std::int32_t element;  ///< that is touched; -1: none
  std::uint8_t ready, io_error, rearm;
  // The loop begins with this tick, and with this stored state: SafetyRecord.
  std::uint8_t begins, stored_phase, stored_fault;

  // What came out.
  std::uint8_t phase, fault;  ///< SafetyPhase, SafetyFault
  std::uint8_t damping_only, tank_limited, rearm_refused;
  double newton[3];  ///< sent
};

/// What the safety was made with.
struct PenRecordLimits {
  double max_newton = 0;           ///< length of the force
  double max_axis_newton[3] = {};  ///< of the motors
};

struct PenRecord {
  PenRecordLimits limits;
  std::vector<PenTick> ticks;
};

/// The first lines of a record: its form, the limits, the names of the columns.
std::string pen_record_header(const PenRecordLimits& limits);
/// The line of a tick. Numbers are the shortest that read back to the same bits.
std::string pen_record_line(const PenTick& tick);
/// Errors: another form, a line with fewer or more columns or with something else than a number; with its line. A last line that isn't
/// complete is left out.
Result<PenRecord> parse_pen_record(std::string_view text, const std::string& file);

}  // namespace prismesh::drivers::haptics
