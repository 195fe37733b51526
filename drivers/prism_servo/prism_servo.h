// The motor that moves the prism mask, whatever its bytes. Called from the device loop once a tick: nothing blocks, allocates or logs.
#pragma once

#include <cstdint>

#include "drivers/port/byte_port.h"

namespace prismesh::drivers::prism_servo {

/// Where the mask was measured to be.
struct MaskReading {
  std::int64_t measured_ns = 0;  ///< 0: never
  double position_mm = 0;        ///< mask travel from the homed zero, to the right
  double velocity_mm_s = 0;
};

enum class ServoPhase : std::uint8_t {
  absent,      ///< nothing answers
  setting_up,  ///< registers are read and written, one a tick
  ready,       ///< takes goals
  alarm,       ///< the servo reports a hardware error (named by `alarm_bits`): torque is off until `powered` was false and is true again
};

/// Why a servo that should be `ready` isn't.
enum class ServoTrouble : std::uint8_t {
  none,
  no_answer,    ///< at none of the line's speeds
  other_model,  ///< one whose registers aren't known: nothing is written to it
  refused,      ///< a register doesn't take what it is given
  too_slow,     ///< the servo's own limit is below the speed that is asked for
};

class PrismServo {
 public:
  virtual ~PrismServo() = default;
  struct Tick {
    ServoPhase phase = ServoPhase::absent;
    bool fresh = false;  ///< `reading` is new
    MaskReading reading;
    std::uint8_t alarm_bits = 0;
    ServoTrouble trouble = ServoTrouble::none;
    std::uint16_t trouble_number = 0;                ///< the model, or the register's address
    port::PortStatus status = port::PortStatus::ok;  ///< gone: a new servo needs a new port
  };
  /// Takes in answers, sends this tick's goal (mask millimetres; ignored unless `ready`) and the question for the position.
  /// `powered` false lets the motor go.
  virtual Tick tick(std::int64_t now_ns, double goal_mm, bool powered) = 0;
  struct Counts {
    std::uint64_t answers = 0, bad_packets = 0, timeouts = 0, watchdog_trips = 0;
  };
  virtual const Counts& counts() const = 0;
  /// How the motor follows: what the goal has to lead by.
  virtual std::int64_t lag_ns() const = 0;
};

}  // namespace prismesh::drivers::prism_servo
