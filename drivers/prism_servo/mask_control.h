// Where the mask should go and what the picture may rely on: follows the eyes within the mask's travel, goes back by whole or half
// periods, stops safely when eyes or motor are lost, finds a stuck mask. Pure and on a clock that is passed in: no ports, no allocation.
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
  double goal_velocity_mm_s = 0;   ///< how fast the goal goes: as the head is expected to, however it is being caught up with
  std::int64_t lag_ns = 0;         ///< by which the mask follows its goal
  std::int32_t half_periods = 0;   ///< goal = ideal position - half_periods * P / 2; odd: a weave of fixed columns swaps the eyes
  std::int64_t mono_from_ns = 0;   ///< a scheduled move back: pictures that light up from here ...
  std::int64_t mono_until_ns = 0;  ///< ... to here must be mono; both 0: none is scheduled
  MaskPhase phase = MaskPhase::absent;
  bool stereo_allowed = false;  ///< now, but for a scheduled move back
};

/// Where the mask will be: from the measured place it falls in behind the goal (which itself goes on), by its lag. Not further than
/// 100 ms ahead. A velocity that was measured isn't asked: each new measurement of the head changes it, and that soon passes.
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
  double speed_mm_s = 5.0;                     ///< what the motor can do; the goal goes no faster
  double settle_mm = 0.03;                     ///< so near to where it should be, a mask has arrived
  std::int64_t picture_ns = 17'000'000;        ///< a picture that lit up before a move back stays on so long
  std::int64_t rearm_ns = 3'000'000'000;       ///< a motor may take so long to come back after rearming
  std::int64_t reading_old_ns = 100'000'000;   ///< no answer for so long: absent
};

/// Called once a tick, at any rate up to 1 kHz; holds back what isn't finite before anything else.
///
/// An absolute encoder knows where the mask stands, so homing is a short drive to the middle that shows that the motor obeys.
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
  /// The mask goes to where these optics want it; mono until it's there.
  void set_optics(const display::MaskOptics& optics);

 private:
  /// Where the mask was told to be, and where a quick and a slow motor would have been: the real one is between.
  struct Trace {
    std::int64_t time_ns = 0;
    double command_mm = 0, quick_mm = 0, slow_mm = 0;
  };

  bool look(const Input& input);
  void decide(const Input& input, bool there);
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
  void wish_to_follow(const Input& input);
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
  void remember();
  void forget();

  display::MaskOptics optics_;
  MaskLimits limits_;
  MaskState state_;
  std::int64_t lag_ns_ = 0;
  std::int64_t phase_since_ns_ = 0;
  MaskPhase fault_ = MaskPhase::absent;  ///< `stuck` or `alarm` while latched
  std::int64_t rearming_until_ns_ = 0;
  bool powered_ = false, seen_ = false, caught_up_ = false, started_ = false;

  double wish_mm_ = 0;     ///< where the mask should be
  double command_mm_ = 0;  ///< where it is told to be: no faster than the motor
  double quick_mm_ = 0, slow_mm_ = 0, slow_profile_mm_ = 0;
  double wish_velocity_mm_s_ = 0;
  bool arrived_ = false;  ///< measured where the command has led it, and the command is at the wish
  std::int64_t on_wish_since_ns_ = 0;
  std::int64_t astray_since_ns_ = 0;
  std::array<Trace, 256> traces_{};
  std::size_t newest_ = 0, remembered_ = 0;
};

}  // namespace prismesh::drivers::prism_servo
