// Where the mask should go and what the picture may rely on: follows the eyes within the mask's travel, goes back by whole or half
// periods, stops safely when eyes or motor are lost, finds a stuck mask. Pure and on a clock that is passed in: no ports, no allocation.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "drivers/display/optics.h"
#include "drivers/eye_tracker/filter.h"
#include "drivers/prism_servo/prism_servo.h"

namespace prismesh::drivers::prism_servo {

enum class MaskPhase : std::uint8_t {
  absent,       ///< no motor
  homing,       ///< finding its zero
  following,    ///< moves with the eyes: stereo may be shown
  flying_back,  ///< on the way to an equivalent place: mono meanwhile
  frozen,       ///< eyes lost: stands still until the picture is mono
  parking,      ///< on the way to the middle
  parked,       ///< in the middle, motor at rest; goes on when eyes come
  held,         ///< where calibration asked for
  stuck,        ///< doesn't go where it is told: motor let go; latched until rearmed
  alarm,        ///< the motor's own fault: latched until rearmed
};

/// What the picture needs to know of the mask; published each tick.
struct MaskState {
  std::int64_t time_ns = 0;      ///< of this state
  std::int64_t measured_ns = 0;  ///< when `position_mm` was measured; 0: never
  double position_mm = 0;
  double velocity_mm_s = 0;
  double goal_mm = 0;
  std::int32_t half_periods = 0;   ///< goal = ideal position - half_periods * P / 2; odd: a weave of fixed columns swaps the eyes
  std::int64_t mono_from_ns = 0;   ///< a scheduled move back: pictures that light up from here ...
  std::int64_t mono_until_ns = 0;  ///< ... to here must be mono; both 0: none is scheduled
  MaskPhase phase = MaskPhase::absent;
  bool stereo_allowed = false;  ///< now, but for a scheduled move back
};

/// Where the mask will be: measured place and velocity, never beyond the goal nor further than 100 ms ahead.
double mask_position_at(const MaskState& state, std::int64_t time_ns);

/// Thresholds in one place; starting values.
struct MaskLimits {
  double travel_mm = 2.0;                      ///< the mask may go so far to either side
  double return_share = 0.9;                   ///< of the travel: where a move back is planned
  bool half_period_returns = true;             ///< by the smallest number of half periods; false: whole periods only
  std::int64_t return_notice_ns = 60'000'000;  ///< a move back is announced so long before, so that the picture can be mono by then
  std::int64_t eyes_lost_ns = 100'000'000;     ///< no measurement for so long: frozen
  std::int64_t park_after_ns = 250'000'000;    ///< frozen so long without the picture saying that it is mono: park all the same
  double stuck_mm = 0.05;                      ///< command and feedback apart by more ...
  std::int64_t stuck_after_ns = 300'000'000;   ///< ... for so long, while the motor should have been there: stuck
  double speed_mm_s = 5.0;                     ///< what the motor can do
  std::int64_t reading_old_ns = 100'000'000;   ///< no answer for so long: absent
};

class MaskControl {
 public:
  MaskControl(const display::MaskOptics& optics, const MaskLimits& limits);

  struct Input {
    std::int64_t now_ns = 0;
    eye_tracker::HeadState head;  ///< extrapolated inside by the motor's lag
    bool head_seen = false;       ///< measurements arrive
    PrismServo::Tick servo;
    std::int64_t servo_lag_ns = 0;
    bool picture_mono = false;        ///< the kiosk has said that what it shows is mono
    const double* hold_mm = nullptr;  ///< calibration asks for this place
    bool rearm = false;               ///< the user has asked to try again after `stuck` or `alarm`; also homes
  };
  struct Output {
    double goal_mm = 0;
    bool powered = false;
    MaskState state;
  };
  Output step(const Input& input);
  void set_optics(const display::MaskOptics& optics);

 private:
  display::MaskOptics optics_;
  MaskLimits limits_;
  MaskState state_;
};

}  // namespace prismesh::drivers::prism_servo
