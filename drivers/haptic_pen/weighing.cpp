#include "drivers/haptic_pen/weighing.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace prismesh::drivers::haptic_pen {
namespace {

constexpr double kLeastGrams = 20;
constexpr double kShareOfLargest = 0.7;
constexpr double kDampingNewtonSM = 1;
constexpr std::int64_t kRiseNs = 1'500'000'000;  ///< the force comes in softly
constexpr std::int64_t kLongestRunNs = 60'000'000'000;
constexpr double kLeastAnswerNewton = 0.05;
constexpr double kSpeedSmoothingS = 0.01;

}  // namespace

Result<void> check(const WeighingOptions& options) {
  if (!(options.grams >= kLeastGrams)) return fail("--weigh", fmt::format("needs a weight of at least {} g", kLeastGrams));
  if (options.newton() > kShareOfLargest * options.max_newton)
    return fail("--weigh",
                fmt::format("{:g} g need {:.2f} N, and at most {:.2f} N are used of haptic_pen.max_newton = {:g}: take a lighter "
                            "weight, or raise the setting",
                            options.grams, options.newton(), kShareOfLargest * options.max_newton, options.max_newton));
  return {};
}

std::string words_of(WeighingFault fault) {
  switch (fault) {
    case WeighingFault::none: break;
    case WeighingFault::pen_lost: return "the pen stopped answering, so its force was ended: check its plugs and begin again";
    case WeighingFault::too_fast:
      return "the grip moved too fast, so its force was ended: fasten the weight, keep hands away, and begin again";
    case WeighingFault::not_lifted:
      return "the largest force doesn't carry the grip over the middle 24 mm: free its way, take a lighter weight or raise "
             "haptic_pen.max_newton, and begin again";
    case WeighingFault::no_answer: return "the weight changed nothing: does it hang on the grip, and free?";
  }
  return {};
}

Eigen::Vector3d Weighing::tick(const PenReading& reading, std::int64_t now_ns) {
  if (step_ == WeighingStep::done || step_ == WeighingStep::failed) return Eigen::Vector3d::Zero();
  if (!follow(reading, now_ns)) return Eigen::Vector3d::Zero();
  if (step_ == WeighingStep::empty || step_ == WeighingStep::loaded) return carry(now_ns);
  return Eigen::Vector3d::Zero();
}

/// False: nothing may be sent but zero.
bool Weighing::follow(const PenReading& reading, std::int64_t now_ns) {
  const bool ready = reading.phase == PenPhase::ready && reading.trouble != PenTrouble::io_error;
  if (reading.fresh) {
    const double seconds = static_cast<double>(reading.pose.measured_ns - pose_.measured_ns) * 1e-9;
    if (pose_.measured_ns != 0 && seconds > 0) {
      const double share = std::min(1.0, seconds / kSpeedSmoothingS);
      speed_mm_s_ += share * ((reading.pose.position_mm - pose_.position_mm) / seconds - speed_mm_s_);
    }
    pose_ = reading.pose;
    heard_ns_ = now_ns;
  }
  const bool silent = heard_ns_ == 0 || now_ns - heard_ns_ > kSilenceNs;
  const bool lost = !ready || heard_ns_ == 0 || now_ns - heard_ns_ > kLostNs;
  if (step_ == WeighingStep::wait_for_pen) {
    if (!lost && !silent) step_ = WeighingStep::ask_empty;
    return false;
  }
  if (lost) {
    fail_with(WeighingFault::pen_lost);
    return false;
  }
  const bool carries = step_ == WeighingStep::empty || step_ == WeighingStep::loaded;
  if (silent) {
    paused_ = true;
    return false;
  }
  if (std::exchange(paused_, false) && carries) begin(step_, now_ns);
  if (carries && speed_mm_s_.norm() > kMaxSpeedMmS) {
    fail_with(WeighingFault::too_fast);
    return false;
  }
  return true;
}

void Weighing::go_on(std::int64_t now_ns) {
  if (step_ != WeighingStep::ask_empty && step_ != WeighingStep::ask_weight) return;
  run_ns_ = now_ns;
  begin(step_ == WeighingStep::ask_empty ? WeighingStep::empty : WeighingStep::loaded, now_ns);
}

void Weighing::begin(WeighingStep step, std::int64_t now_ns) {
  step_ = step;
  way_ = Way::rise;
  begun_ns_ = stepped_ns_ = now_ns;
  goal_mm_ = pose_.position_mm.y();
  last_height_mm_ = goal_mm_;
  up_ = down_ = {};
}

void Weighing::fail_with(WeighingFault fault) {
  fault_ = fault;
  step_ = WeighingStep::failed;
}

Eigen::Vector3d Weighing::carry(std::int64_t now_ns) {
  const double seconds = static_cast<double>(std::clamp<std::int64_t>(now_ns - stepped_ns_, 0, kSilenceNs)) * 1e-9;
  stepped_ns_ = now_ns;
  const double height_mm = pose_.position_mm.y();
  // The goal runs ahead of the grip until the spring carries the load; it never runs farther than the largest force.
  const double reach_mm = options_.max_newton / kSpringNewtonM * 1e3;
  const double wanted = goal_mm_ + (way_ == Way::down ? -1 : 1) * kSpeedMmS * seconds;
  goal_mm_ = std::clamp(wanted, height_mm - reach_mm, height_mm + reach_mm);
  const Eigen::Vector3d goal(0, goal_mm_, 0);
  Eigen::Vector3d newton = (goal - pose_.position_mm) * 1e-3 * kSpringNewtonM - speed_mm_s_ * 1e-3 * kDampingNewtonSM;
  const double since = static_cast<double>(now_ns - begun_ns_);
  newton.x() *= std::min(1.0, since / kRiseNs);
  newton.z() *= std::min(1.0, since / kRiseNs);
  if (const double length = newton.norm(); length > options_.max_newton) newton *= options_.max_newton / length;
  if (!newton.allFinite()) {
    fail_with(WeighingFault::pen_lost);
    return Eigen::Vector3d::Zero();
  }
  measure(height_mm, newton.y());
  if (step_ == WeighingStep::empty || step_ == WeighingStep::loaded)
    if (now_ns - run_ns_ > kLongestRunNs) fail_with(WeighingFault::not_lifted);
  const bool carries = step_ == WeighingStep::empty || step_ == WeighingStep::loaded;
  return carries ? newton : Eigen::Vector3d::Zero();
}

void Weighing::measure(double height_mm, double newton) {
  constexpr double kTurnMm = 3;  ///< beyond the heights, so that it moves evenly when it comes to them
  const double moved = height_mm - last_height_mm_;
  last_height_mm_ = height_mm;
  const bool within = height_mm > kLowMm && height_mm < kHighMm;
  switch (way_) {
    case Way::rise:  // to below the heights first, wherever the grip hangs or lies
      if (height_mm > kHighMm + kTurnMm)
        way_ = Way::down;
      else if (height_mm < kLowMm - kTurnMm)
        way_ = Way::up;
      break;
    case Way::up:
      if (within) {
        up_.newton += newton * moved;
        up_.millimetres += moved;
      }
      if (height_mm > kHighMm + kTurnMm) way_ = Way::down;
      break;
    case Way::down:
      if (within) {
        down_.newton -= newton * moved;
        down_.millimetres -= moved;
      }
      if (height_mm < kLowMm - kTurnMm) {
        if (up_.millimetres > 0)
          end_run();
        else
          way_ = Way::up;
        down_ = {};
      }
      break;
  }
}

void Weighing::end_run() {
  const bool loaded = step_ == WeighingStep::loaded;
  loads_[loaded ? 1 : 0] = (up_.mean() + down_.mean()) / 2;
  friction_ = (up_.mean() - down_.mean()) / 2;
  if (!loaded) {
    step_ = WeighingStep::ask_weight;
    return;
  }
  if (asked_newton() < kLeastAnswerNewton) return fail_with(WeighingFault::no_answer);
  step_ = WeighingStep::done;
}

}  // namespace prismesh::drivers::haptic_pen
