// Weighing a Falcon whose true force is known and not what the driver asks for, by its simulator, in virtual time.
#include "drivers/haptic_pen/weighing.h"

#include <memory>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/haptic_pen/falcon/falcon_pen.h"
#include "drivers/haptic_pen/falcon/simulated_falcon.h"

namespace prismesh::drivers::haptic_pen {
namespace {

constexpr std::int64_t kWeighTickNs = 1'000'000;

/// A device that makes `true_force` newtons for one that is asked for. Its arms weigh something, and so may what hangs on it.
class WeighingRig {
 public:
  explicit WeighingRig(double true_force, WeighingOptions options = {.grams = 100, .max_newton = 3})
      : true_force_(true_force),
        // The driver asks for its newtons; that they are others is its `force_scale` set wrong.
        pen_(*port_, {.force_scale = options.force_scale / true_force}),
        weighing_(options) {}

  void tick() {
    for (int part = 0; part < 4; ++part) {
      clock_.advance_ns(kWeighTickNs / 4);
      cable_.run();
    }
    const Eigen::Vector3d newton = weighing_.tick(pen_.read(clock_.now_ns()), clock_.now_ns());
    largest_ = std::max(largest_, newton.norm());
    last_ = newton;
    pen_.send(clock_.now_ns(), {newton, clock_.now_ns() + 3 * kWeighTickNs});
  }
  /// Does what a user is asked for, until the end.
  WeighingStep weigh(double hung_grams) {
    for (int i = 0; i < 200'000 && weighing_.step() != WeighingStep::done && weighing_.step() != WeighingStep::failed; ++i) {
      tick();
      if (weighing_.step() == WeighingStep::ask_weight) *load_ = arms_newton_ + hung_grams * 1e-3 * kStandardGravity;
      if (weighing_.step() == WeighingStep::ask_empty || weighing_.step() == WeighingStep::ask_weight) {
        for (int rest = 0; rest < 500; ++rest) tick();
        weighing_.go_on(clock_.now_ns());
      }
    }
    return weighing_.step();
  }
  bool until(WeighingStep step) {
    for (int i = 0; i < 60'000; ++i) {
      if (weighing_.step() == step) return true;
      tick();
      if (weighing_.step() == WeighingStep::ask_empty && step != WeighingStep::ask_empty) weighing_.go_on(clock_.now_ns());
    }
    return false;
  }

  double true_force_;
  double arms_newton_ = 0.4;
  std::shared_ptr<double> load_ = std::make_shared<double>(arms_newton_);
  std::shared_ptr<double> throw_ = std::make_shared<double>(0);
  ManualClock clock_;
  falcon::SimulatedFalcon device_{
      {.pen = {.friction_newton = 0.15, .quantum_mm = 0, .max_newton = 12, .workspace_mm = 42}, .runs = true, .homed = true},
      [load = load_, thrown = throw_](double) {
        SimulatedHand hand;
        hand.stiffness_newton_m = 0;  // nobody holds it
        hand.damping_newton_s_m = 0;
        hand.push_newton = {*thrown, -*load, 0};
        return hand;
      }};
  port::MemoryUsb cable_{clock_, device_};
  std::unique_ptr<port::UsbPort> port_ = cable_.open();
  falcon::FalconPen pen_;
  Weighing weighing_;
  double largest_ = 0;
  Eigen::Vector3d last_;
};

TEST(WeighingTest, finds_the_scale_of_a_device_that_is_weaker_or_stronger_than_asked_for) {
  for (const double true_force : {0.7, 1.0, 1.3}) {
    WeighingRig rig(true_force);
    ASSERT_EQ(rig.weigh(100), WeighingStep::done) << words_of(rig.weighing_.fault());
    EXPECT_NEAR(rig.weighing_.force_scale(), true_force, 0.03 * true_force);
    EXPECT_LE(rig.largest_, 3 + 1e-9);
    EXPECT_EQ(rig.last_, Eigen::Vector3d::Zero());
  }
}

TEST(WeighingTest, finds_the_same_whatever_scale_is_set_already) {
  WeighingRig rig(0.8, {.grams = 150, .max_newton = 4, .force_scale = 1.25});
  ASSERT_EQ(rig.weigh(150), WeighingStep::done) << words_of(rig.weighing_.fault());
  EXPECT_NEAR(rig.weighing_.force_scale(), 0.8, 0.03) << "the device's own, not a correction of what was set";
}

TEST(WeighingTest, tells_friction_and_damping_from_the_weight) {
  WeighingRig rig(1);
  ASSERT_EQ(rig.weigh(100), WeighingStep::done) << words_of(rig.weighing_.fault());
  EXPECT_NEAR(rig.weighing_.asked_newton(), 0.98, 0.03);
  EXPECT_NEAR(rig.weighing_.friction_newton(), 0.156, 0.04) << "0.15 N, and 1 N s/m at 6 mm/s";
}

TEST(WeighingTest, sends_no_force_before_the_user_goes_on) {
  WeighingRig rig(1);
  ASSERT_TRUE(rig.until(WeighingStep::ask_empty));
  for (int i = 0; i < 2000; ++i) rig.tick();
  EXPECT_EQ(rig.largest_, 0);
  rig.weighing_.go_on(rig.clock_.now_ns());
  ASSERT_TRUE(rig.until(WeighingStep::ask_weight));
  EXPECT_GT(rig.largest_, 0.3);
  rig.tick();
  EXPECT_EQ(rig.last_, Eigen::Vector3d::Zero()) << "the user's hands are at the grip now";
}

TEST(WeighingTest, a_pen_that_falls_silent_or_is_unplugged_gets_no_force) {
  WeighingRig silent(1);
  ASSERT_TRUE(silent.until(WeighingStep::empty));
  for (int i = 0; i < 2500; ++i) silent.tick();
  EXPECT_GT(silent.last_.norm(), 0.1);
  silent.device_.be_deaf(true);
  for (int i = 0; i < 30; ++i) silent.tick();
  EXPECT_EQ(silent.last_, Eigen::Vector3d::Zero());
  EXPECT_EQ(silent.weighing_.step(), WeighingStep::empty) << "it may be heard again";
  for (int i = 0; i < 180; ++i) silent.tick();
  EXPECT_EQ(silent.weighing_.fault(), WeighingFault::pen_lost);
  EXPECT_EQ(silent.last_, Eigen::Vector3d::Zero());
  silent.device_.be_deaf(false);
  for (int i = 0; i < 200; ++i) silent.tick();
  EXPECT_EQ(silent.last_, Eigen::Vector3d::Zero()) << "it stays ended";
}

TEST(WeighingTest, a_short_silence_begins_the_run_anew_and_spoils_nothing) {
  WeighingRig rig(0.7);
  ASSERT_TRUE(rig.until(WeighingStep::empty));
  for (int i = 0; i < 6000; ++i) rig.tick();
  rig.device_.be_deaf(true);
  for (int i = 0; i < 50; ++i) rig.tick();
  rig.device_.be_deaf(false);
  ASSERT_EQ(rig.weigh(100), WeighingStep::done) << words_of(rig.weighing_.fault());
  EXPECT_NEAR(rig.weighing_.force_scale(), 0.7, 0.02);
}

TEST(WeighingTest, a_grip_that_is_thrown_gets_no_force) {
  WeighingRig rig(1);
  ASSERT_TRUE(rig.until(WeighingStep::empty));
  for (int i = 0; i < 2500; ++i) rig.tick();
  *rig.throw_ = 6;
  for (int i = 0; i < 200 && rig.weighing_.step() == WeighingStep::empty; ++i) rig.tick();
  EXPECT_EQ(rig.weighing_.fault(), WeighingFault::too_fast);
  rig.tick();
  EXPECT_EQ(rig.last_, Eigen::Vector3d::Zero());
}

TEST(WeighingTest, a_weight_that_wasnt_hung_or_is_too_heavy_is_told) {
  WeighingRig none(1);
  EXPECT_EQ(none.weigh(0), WeighingStep::failed);
  EXPECT_EQ(none.weighing_.fault(), WeighingFault::no_answer);
  WeighingRig heavy(1, {.grams = 100, .max_newton = 2});
  EXPECT_EQ(heavy.weigh(300), WeighingStep::failed);
  EXPECT_EQ(heavy.weighing_.fault(), WeighingFault::not_lifted);
}

TEST(WeighingTest, checks_the_weight_before) {
  EXPECT_TRUE(check({.grams = 100, .max_newton = 2}));
  EXPECT_THAT(check({.grams = 5, .max_newton = 2}).error().text(), testing::HasSubstr("at least 20 g"));
  EXPECT_THAT(check({.grams = 200, .max_newton = 2}).error().text(),
              testing::HasSubstr("200 g need 1.96 N, and at most 1.40 N are used of haptic_pen.max_newton = 2"));
  EXPECT_FALSE(check({.grams = std::nan(""), .max_newton = 2}));
}

}  // namespace
}  // namespace prismesh::drivers::haptic_pen
