// The interface of the motor that moves the prism mask. The device loop calls it once per tick; it doesn't block, allocate or log.
#pragma once

#include <cstdint>

#include "drivers/port/byte_port.h"

namespace prismesh::drivers::prism_servo {

/// A measurement of the mask's position.
struct MaskReading {
  std::int64_t measured_ns = 0;  ///< 0: never
  double position_mm = 0;        ///< mask travel to the right from the homed zero
  double velocity_mm_s = 0;
};

enum class ServoPhase : std::uint8_t {
  absent,      ///< no answer
  setting_up,  ///< reads and writes registers, one per tick
  ready,       ///< accepts goals
  alarm,       ///< the servo reports a hardware error (in `alarm_bits`): torque is off until `powered` was false and is true again
};

/// Why a servo isn't `ready`.
enum class ServoTrouble : std::uint8_t {
  none,
  no_answer,    ///< at any baud rate
  other_model,  ///< a model with unknown registers; nothing is written to it
  refused,      ///< the servo refuses a register's value
  too_slow,     ///< the servo's own limit is below the required speed
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
    port::PortStatus status = port::PortStatus::ok;  ///< gone: a new port needs a new servo
  };
  /// Reads answers, then sends this tick's goal (mask millimetres; ignored unless `ready`) and the request for the position. `powered`
  /// false switches the torque off.
  virtual Tick tick(std::int64_t now_ns, double goal_mm, bool powered) = 0;
  struct Counts {
    std::uint64_t answers = 0, bad_packets = 0, timeouts = 0, watchdog_trips = 0;
  };
  virtual const Counts& counts() const = 0;
  /// Returns the time by which the motor lags behind its goal; the goal has to lead by it.
  virtual std::int64_t lag_ns() const = 0;
};

}  // namespace prismesh::drivers::prism_servo
