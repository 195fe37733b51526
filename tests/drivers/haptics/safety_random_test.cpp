// Ten million random ticks with every fault (PRISMESH_SAFETY_TICKS: another number), read by the independent checker.
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "drivers/haptics/safety.h"
#include "tests/drivers/haptics/force_checker.h"
#include "tests/support/seed.h"

namespace prismesh::drivers::haptics {
namespace {

constexpr double kMotorNewton = 6;

/// SplitMix64, for it is quick and the same everywhere.
class QuickRandom {
 public:
  explicit QuickRandom(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15u + 1) {}
  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  bool one_in(double count) { return unit() * count < 1; }
  Eigen::Vector3d vector(double length) { return {between(-length, length), between(-length, length), between(-length, length)}; }

 private:
  std::uint64_t state_;
};

enum class HandMode { spring, along, against, random, still, count };

/// Plays hand, device, loop and faults.
class RandomLoop {
 public:
  explicit RandomLoop(std::uint64_t seed) : random_(seed), safety_(HapticLimits{}, Eigen::Vector3d::Constant(kMotorNewton)) {}

  const test::RecordedTick& tick() {
    if (random_.one_in(500)) {
      mode_ = static_cast<HandMode>(random_.next() % static_cast<int>(HandMode::count));
      strength_ = random_.between(0, random_.one_in(4) ? 30 : 3);
      speed_ = random_.vector(random_.one_in(20) ? 1.4 : 0.3);
    }
    now_ns_ += random_.one_in(2000) ? static_cast<std::int64_t>(random_.between(1e6, 15e6))
                                    : 1'000'000 + static_cast<std::int64_t>(random_.between(-2e5, 2e5));
    if (random_.one_in(300'000)) now_ns_ -= 20'000'000;
    move();
    SafetyInput input;
    input.now_ns = now_ns_;
    read_pose(input);
    want();
    input.ready = !random_.one_in(50'000);
    input.io_error = random_.one_in(50'000);
    input.lost_replies = random_.one_in(50'000) ? 1 : 0;
    input.rearm = random_.one_in(rearm_before_ ? 2 : 200);
    rearm_before_ = input.rearm;
    if (random_.one_in(50'000)) parts_[random_.next() % 4].newton[static_cast<int>(random_.next() % 3)] = bad_number();
    input.parts = parts_;
    const SafetyOutput output = safety_.step(input);
    last_force_ = output.newton;
    record(input, output);
    // The program dies now and then; what it stored comes back.
    if (random_.one_in(100'000)) restart();
    return record_;
  }
  std::uint64_t restarts() const { return restarts_; }

 private:
  double bad_number() {
    return random_.one_in(2) ? std::numeric_limits<double>::quiet_NaN()
                             : std::numeric_limits<double>::infinity() * (random_.one_in(2) ? 1 : -1);
  }
  void move() {
    if (random_.one_in(10)) velocity_ += random_.vector(0.2);
    velocity_ += 0.05 * (speed_ - velocity_);
    if (mode_ == HandMode::still) velocity_ *= 0.9;
    const double edge = position_.norm();
    if (edge > 60) velocity_ -= 0.02 * (edge - 60) / edge * position_;
    position_ += velocity_;
    if (random_.one_in(20'000)) position_ += random_.vector(random_.one_in(2) ? 3 : 100);
  }
  /// Replies come late, in pairs, or not at all.
  void read_pose(SafetyInput& input) {
    if (missing_ > 0) {
      --missing_;
    } else if (random_.one_in(50)) {
      missing_ = random_.one_in(50) ? 12 : static_cast<int>(random_.next() % 5);
    } else {
      const std::int64_t measured = now_ns_ - static_cast<std::int64_t>(random_.between(0, 4e5));
      if (measured > measured_ns_ || random_.one_in(100)) {
        measured_ns_ = measured;
        reported_ = position_;
        if (random_.one_in(100'000)) measured_ns_ += 5'000'000;
      }
    }
    input.measured_ns = measured_ns_;
    input.position_mm = reported_;
    if (random_.one_in(50'000)) input.position_mm[static_cast<int>(random_.next() % 3)] = bad_number();
  }
  void want() {
    const Eigen::Vector3d direction = velocity_.normalized();
    Eigen::Vector3d contact = Eigen::Vector3d::Zero();
    switch (mode_) {
      case HandMode::spring: contact = Eigen::Vector3d(0, std::max(0.0, -position_.y()) * 0.1 * strength_, 0); break;
      case HandMode::along: contact = strength_ * direction; break;
      case HandMode::against: contact = -strength_ * direction; break;
      case HandMode::random: contact = random_.vector(strength_); break;
      case HandMode::still: contact = last_force_ + random_.vector(1); break;
      case HandMode::count: break;
    }
    // In free space now and then, so that arming succeeds.
    if (random_.one_in(400)) free_ticks_ = 300;
    if (free_ticks_ > 0) --free_ticks_, contact.setZero();
    if (field_stays_ > 0)
      --field_stays_;
    else
      field_ns_ = now_ns_ - static_cast<std::int64_t>(random_.between(0, 5e6));
    if (random_.one_in(5000)) field_stays_ = static_cast<int>(random_.next() % 400);
    parts_[0] = {contact, field_ns_, false};
    parts_[1] = {0.2 * contact.cross(Eigen::Vector3d::UnitX()), field_ns_, false};
    parts_[2] = {-1.5 * velocity_, 0, true};
    parts_[3] = {mode_ == HandMode::along ? random_.vector(0.1) : Eigen::Vector3d::Zero(), now_ns_ + (random_.one_in(1000) ? 3'000'000 : 0),
                 false};
  }
  void record(const SafetyInput& input, const SafetyOutput& output) {
    record_.now_ns = input.now_ns;
    record_.measured_ns = input.measured_ns;
    record_.ready = input.ready;
    record_.io_error = input.io_error;
    record_.lost_replies = input.lost_replies;
    record_.rearm = input.rearm;
    record_.part_count = static_cast<std::uint32_t>(parts_.size());
    for (int i = 0; i < 3; ++i) {
      record_.position_mm[i] = input.position_mm[i];
      record_.force_newton[i] = output.newton[i];
      for (std::size_t p = 0; p < parts_.size(); ++p) record_.parts[p].newton[i] = parts_[p].newton[i];
    }
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      record_.parts[p].from_ns = parts_[p].from_ns;
      record_.parts[p].damping = parts_[p].damping;
    }
    record_.valid_until_ns = output.valid_until_ns;
  }
  void restart() {
    const SafetyRecord stored = safety_.record();
    Safety fresh(HapticLimits{}, Eigen::Vector3d::Constant(kMotorNewton), stored);
    EXPECT_NE(fresh.record().phase, SafetyPhase::armed);
    EXPECT_EQ(fresh.record().phase, stored.phase == SafetyPhase::disarmed ? SafetyPhase::disarmed : SafetyPhase::latched);
    ++restarts_;
  }

  QuickRandom random_;
  Safety safety_;
  test::RecordedTick record_;
  std::array<ForcePart, 4> parts_;
  HandMode mode_ = HandMode::spring;
  double strength_ = 1;
  std::int64_t now_ns_ = 1'000'000'000, measured_ns_ = 0, field_ns_ = 0;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero(), reported_ = Eigen::Vector3d::Zero(), velocity_ = Eigen::Vector3d::Zero(),
                  speed_ = Eigen::Vector3d::Zero(), last_force_ = Eigen::Vector3d::Zero();
  int missing_ = 0, free_ticks_ = 0, field_stays_ = 0;
  bool rearm_before_ = false;
  std::uint64_t restarts_ = 0;
};

void check_random_ticks(std::uint64_t ticks) {
  RandomLoop loop(test::seed(1));
  test::ForceChecker checker(kMotorNewton);
  for (std::uint64_t i = 0; i < ticks; ++i) ASSERT_TRUE(checker.take(loop.tick())) << checker.fault();
  const test::ForceChecker::Figures& figures = checker.figures();
  std::cout << figures.ticks << " ticks: " << figures.with_force << " with force, " << figures.arms << " arms, " << figures.latches
            << " latches, " << figures.late << " late, " << figures.faded << " faded parts, " << loop.restarts() << " restarts, max. force "
            << figures.max_newton << " N, work into the hand " << figures.given_joule << " J, out of it " << figures.taken_joule
            << " J, least allowance left " << figures.min_spare_joule * 1e3 << " mJ\n";
  EXPECT_GT(figures.with_force, ticks / 10);
  EXPECT_GT(figures.latches, ticks / 20'000);
  EXPECT_GT(figures.late, ticks / 100'000);
  EXPECT_GT(figures.faded, ticks / 1'000);
  EXPECT_LT(figures.min_spare_joule, 0.002) << "the tank was nearly empty";
  EXPECT_GT(figures.max_newton, 7);
}

TEST(SafetyRandom, ticks_keep_every_promise) { check_random_ticks(200'000); }

TEST(SafetyRandomLong, ticks_keep_every_promise) {
  const char* const wanted = std::getenv("PRISMESH_SAFETY_TICKS");
  check_random_ticks(wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : 10'000'000);
}

}  // namespace
}  // namespace prismesh::drivers::haptics
