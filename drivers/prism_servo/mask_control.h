// Controls the mask's position and decides when stereo may be shown: follows the eyes within the mask's travel, moves back by
// whole or half periods, stops safely when eyes or motor are lost, and detects a stuck mask. Pure: the time is passed in, no ports, no
// allocation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "drivers/display/optics.h"
#include "drivers/eye_tracker/filter.h"
#include "drivers/prism_servo/prism_servo.h"

namespace prismesh::drivers::prism_servo {

enum class MaskPhase : std::uint8_t {
  absent,       ///< no motor
  homing,       ///< finds its zero
  following,    ///< follows the eyes: stereo may be shown
  flying_back,  ///< moves to an equivalent position: mono meanwhile
  frozen,       ///< eyes lost: stands still until the picture is mono
  parking,      ///< moves to the middle
  parked,       ///< in the middle with torque off; continues when eyes are seen
  held,         ///< at the position that the calibration requests
  stuck,        ///< doesn't follow its command: torque off; latched until rearmed
  alarm,        ///< the motor's own fault: latched until rearmed
};

/// The mask's state for the picture; published in each tick.
struct MaskState {
  std::int64_t time_ns = 0;      ///< time of this state
  std::int64_t measured_ns = 0;  ///< when `position_mm` was measured; 0: never
  double position_mm = 0;
  double velocity_mm_s = 0;
  double goal_mm = 0;
  double goal_velocity_mm_s = 0;   ///< expected velocity of the goal from the head's motion, also while the command is still catching up
  std::int64_t lag_ns = 0;         ///< time by which the mask lags behind its goal
  std::int32_t half_periods = 0;   ///< goal = ideal position - half_periods * P / 2; if odd, a weave of fixed columns swaps the eyes
  std::int64_t mono_from_ns = 0;   ///< a scheduled move back: pictures that light up from here
  std::int64_t mono_until_ns = 0;  ///< to here must be mono; both are 0 if none is scheduled
  MaskPhase phase = MaskPhase::absent;
  bool stereo_allowed = false;  ///< at present, apart from a scheduled move back
};

/// Returns the mask's position at a time: from the measured position it approaches the moving goal with its lag. Extrapolates by max. 100
/// ms. Doesn't use the measured velocity, because each new head measurement changes it for a short time only.
double mask_position_at(const MaskState& state, std::int64_t time_ns);

/// Thresholds; initial values.
struct MaskLimits {
  double travel_mm = 2.0;                      ///< max. travel to either side
  double return_share = 0.9;                   ///< share of the travel at which a move back is planned
  bool half_period_returns = true;             ///< moves back by the min. number of half periods; false: whole periods only
  std::int64_t return_notice_ns = 60'000'000;  ///< a move back is announced so long before, so that the picture can change to mono
  std::int64_t eyes_lost_ns = 100'000'000;     ///< time without a measurement until `frozen`
  std::int64_t park_after_ns = 250'000'000;    ///< max. time in `frozen` if the picture doesn't report mono
  double stuck_mm = 0.05;                      ///< a difference between command and feedback of more than this
  std::int64_t stuck_after_ns = 300'000'000;   ///< for so long, although the motor should have arrived, means stuck
  double speed_mm_s = 5.0;                     ///< max. speed of the motor; limits the goal's speed too
  double settle_mm = 0.03;                     ///< max. distance at which the mask counts as arrived
  std::int64_t picture_ns = 17'000'000;        ///< a picture that lit up before a move back stays visible for so long
  std::int64_t rearm_ns = 3'000'000'000;       ///< max. time for a motor to answer again after rearming
  std::int64_t reading_old_ns = 100'000'000;   ///< time without an answer until `absent`
};

/// Call `step` once per tick, at any rate up to 1 kHz. Ignores values that aren't finite.
///
/// An absolute encoder measures the mask's position, so homing is only a short move to the middle that verifies that the motor follows
/// commands.
class MaskControl {
 public:
  MaskControl(const display::MaskOptics& optics, const MaskLimits& limits);

  struct Input {
    std::int64_t now_ns = 0;
    eye_tracker::HeadState head;  ///< extrapolated here by the motor's lag
    bool head_seen = false;       ///< measurements arrive
    PrismServo::Tick servo;
    std::int64_t servo_lag_ns = 0;
    bool picture_mono = false;        ///< the kiosk has reported that it shows a mono picture
    const double* hold_mm = nullptr;  ///< the position that the calibration requests; null: none
    bool rearm = false;               ///< the user asks for another attempt after `stuck` or `alarm`; also homes
  };
  struct Output {
    double goal_mm = 0;
    bool powered = false;
    MaskState state;
  };
  Output step(const Input& input);
  /// Moves the mask to the position for these optics; mono until it has arrived.
  void set_optics(const display::MaskOptics& optics);

 private:
  /// The command, and the positions of a quick and a slow motor; a healthy motor is between these.
  struct Trace {
    std::int64_t time_ns = 0;
    double command_mm = 0, quick_mm = 0, slow_mm = 0;
  };

  bool read_sensors(const Input& input);
  void decide(const Input& input, bool servo_ready);
  void rearm(const Input& input);
  void home(const Input& input);
  void follow(const Input& input);
  void plan_return(const Input& input);
  void fly_back(const Input& input);
  void freeze(const Input& input);
  void park();
  void hold(const Input& input);
  void enter(MaskPhase phase);
  void start_following(std::int32_t half_periods);
  void latch(MaskPhase fault);

  double ideal_mm(const Input& input, std::int64_t ahead_ns) const;
  void update_target(const Input& input);
  double half_period_mm() const;
  double return_mm() const { return limits_.return_share * limits_.travel_mm; }
  std::int32_t periods_back(double ideal_mm, std::int32_t now) const;
  std::int32_t middle_periods(double ideal_mm) const;
  std::int64_t flight_ns(double distance_mm) const;
  double in_travel(double mm) const;

  void set_powered(bool powered);
  void move_command(double seconds);
  void watch_motor(const Input& input);
  const Trace& trace_at(std::int64_t time_ns) const;
  void record_trace();
  void reset_command();

  display::MaskOptics optics_;
  MaskLimits limits_;
  MaskState state_;
  std::int64_t lag_ns_ = 0;
  std::int64_t phase_since_ns_ = 0;
  MaskPhase fault_ = MaskPhase::absent;  ///< `stuck` or `alarm` while latched
  std::int64_t rearming_until_ns_ = 0;
  bool powered_ = false, head_seen_ = false, caught_up_ = false, started_ = false;

  double target_mm_ = 0;   ///< where the mask should be
  double command_mm_ = 0;  ///< the commanded position: limited to the motor's speed
  double quick_mm_ = 0, slow_mm_ = 0, slow_profile_mm_ = 0;
  double target_velocity_mm_s_ = 0;
  bool arrived_ = false;  ///< the measurement agrees with the command, and the command has reached the target
  std::int64_t on_target_since_ns_ = 0;
  std::int64_t deviating_since_ns_ = 0;
  std::array<Trace, 256> traces_{};
  std::size_t newest_trace_ = 0, trace_count_ = 0;
};

}  // namespace prismesh::drivers::prism_servo
