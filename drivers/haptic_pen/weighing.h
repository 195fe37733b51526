// Weighs a pen: finds the true force of a device for a force that was asked for, with a known weight that hangs on its grip. Pure: the
// caller reads the pen and sends what this asks for, once a tick. Neither blocks nor allocates in `tick`.
//
// A soft spring carries the grip slowly up and down again over the same heights. While it moves slowly, the force is the load plus friction
// on the way up and the load minus friction on the way down: their mean over the same heights is the load. The same is done without the
// weight, which takes away what the arms and the grip weigh themselves. What is left is the weight's force, as asked for.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "base/error.h"
#include "drivers/haptic_pen/pen.h"

namespace prismesh::drivers::haptic_pen {

inline constexpr double kStandardGravity = 9.80665;  ///< m/s^2

struct WeighingOptions {
  double grams = 0;
  double max_newton = 2;   ///< no force is longer
  double force_scale = 1;  ///< that the driver corrects its forces by now

  double newton() const { return grams * 1e-3 * kStandardGravity; }
};
/// Errors: a weight below 20 g, or one that needs more than 70 % of the largest force.
Result<void> check(const WeighingOptions& options);

enum class WeighingStep : std::uint8_t {
  wait_for_pen,  ///< it isn't ready
  ask_empty,     ///< the user lets go of the empty grip: call `go_on`
  empty,
  ask_weight,  ///< the user hangs the weight on it: call `go_on`
  loaded,
  done,
  failed,
};

enum class WeighingFault : std::uint8_t {
  none,
  pen_lost,    ///< no pose for 200 ms, or the device left its readiness
  too_fast,    ///< the grip moved at more than 250 mm/s: the weight fell off, or a hand is in the way
  not_lifted,  ///< the largest force doesn't carry it over the heights
  no_answer,   ///< the weight changed nothing
};
/// A sentence.
std::string words_of(WeighingFault fault);

class Weighing {
 public:
  /// Without a pose for so long there is no force, and the run begins anew with the next one.
  static constexpr std::int64_t kSilenceNs = 20'000'000;
  static constexpr std::int64_t kLostNs = 200'000'000;
  static constexpr double kLowMm = -12, kHighMm = 12;  ///< of these heights the force is taken
  static constexpr double kSpringNewtonM = 150;        ///< far below what a Falcon's delay allows
  static constexpr double kSpeedMmS = 6;
  static constexpr double kMaxSpeedMmS = 250;

  explicit Weighing(const WeighingOptions& options) : options_(options) {}

  /// The force for now; zero in all steps but `empty` and `loaded`.
  Eigen::Vector3d tick(const PenReading& reading, std::int64_t now_ns);
  void go_on(std::int64_t now_ns);

  WeighingStep step() const { return step_; }
  WeighingFault fault() const { return fault_; }
  /// After `done`. What was asked for to carry the weight alone, newtons.
  double asked_newton() const { return loads_[1] - loads_[0]; }
  /// The setting haptic_pen.force_scale that makes forces true.
  double force_scale() const { return options_.force_scale * options_.newton() / asked_newton(); }
  /// Half of the difference between up and down, newtons as asked for: friction and damping at this speed.
  double friction_newton() const { return friction_; }

 private:
  enum class Way : std::uint8_t { rise, up, down };
  struct Sum {
    double newton = 0;
    double millimetres = 0;  ///< summed by the way, so that each height counts alike
    double mean() const { return millimetres > 0 ? newton / millimetres : 0; }
  };

  void fail_with(WeighingFault fault);
  void begin(WeighingStep step, std::int64_t now_ns);
  void measure(double height_mm, double newton);
  void end_run();
  Eigen::Vector3d carry(std::int64_t now_ns);
  bool follow(const PenReading& reading, std::int64_t now_ns);

  WeighingOptions options_;
  WeighingStep step_ = WeighingStep::wait_for_pen;
  WeighingFault fault_ = WeighingFault::none;
  PenPose pose_;
  Eigen::Vector3d speed_mm_s_ = Eigen::Vector3d::Zero();  ///< smoothed
  std::int64_t heard_ns_ = 0;
  bool paused_ = false;      ///< for silence
  std::int64_t run_ns_ = 0;  ///< when the run was asked for
  std::int64_t begun_ns_ = 0, stepped_ns_ = 0;
  Way way_ = Way::rise;
  double goal_mm_ = 0;
  double last_height_mm_ = 0;
  Sum up_, down_;
  std::array<double, 2> loads_{};
  double friction_ = 0;
};

}  // namespace prismesh::drivers::haptic_pen
