#include "drivers/haptics/resistance.h"

#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "drivers/haptics/haptic_loop.h"
#include "tests/drivers/haptics/haptic_rig.h"
#include "tests/support/seed.h"

namespace prismesh::drivers::haptics {
namespace {

constexpr double kMax = 2;

HapticResistance slot_of(double newton, const Eigen::Vector3d& direction) {
  HapticResistance slot{.placement = 0, .time_ns = 55, .newton = newton, .direction = {}};
  Eigen::Map<Eigen::Vector3d>{slot.direction} = direction;
  return slot;
}

/// The force after a way along y, in steps of 0.1 mm.
double pulled(Resistance& resistance, const HapticResistance& slot, double from, double to) {
  double y = 0;
  const int steps = static_cast<int>(std::abs(to - from) / 0.1) + 1;
  for (int i = 0; i <= steps; ++i) y = resistance.step({7, from + (to - from) * i / steps, 0}, &slot, kMax, kFullStretchMm).y();
  return y;
}

TEST(Resistance, rises_with_the_way_in_the_bad_direction_and_falls_on_the_way_back) {
  Resistance resistance;
  const HapticResistance slot = slot_of(1.5, {0, 1, 0});
  EXPECT_EQ(pulled(resistance, slot, 0, 0), 0);
  EXPECT_NEAR(pulled(resistance, slot, 0, 3), -0.75, 1e-9);
  EXPECT_NEAR(pulled(resistance, slot, 3, 50), -1.5, 1e-9) << "no more than full";
  EXPECT_NEAR(pulled(resistance, slot, 50, 48), -1, 1e-9);
  EXPECT_EQ(pulled(resistance, slot, 48, 20), 0) << "free on the way back";
  EXPECT_NEAR(pulled(resistance, slot, 20, 26), -1.5, 1e-9);
}

TEST(Resistance, ways_across_arent_resisted) {
  Resistance resistance;
  const HapticResistance slot = slot_of(2, {0, 1, 0});
  for (int i = 0; i < 100; ++i) EXPECT_EQ(resistance.step({0.3 * i, 0, -0.1 * i}, &slot, kMax, kFullStretchMm).norm(), 0);
}

TEST(Resistance, gives_back_no_more_than_it_took) {
  std::mt19937 random(test::seed(5));
  std::uniform_real_distribution<double> unit(-1, 1);
  Resistance resistance;
  HapticResistance slot = slot_of(2, {0, 1, 0});
  Eigen::Vector3d place(0, 0, 0), velocity(0, 0, 0), before(0, 0, 0);
  double joule = 0, worst = 0;
  for (int i = 0; i < 200'000; ++i) {
    velocity = 0.98 * velocity + 0.02 * Eigen::Vector3d(unit(random), unit(random), unit(random));
    const Eigen::Vector3d next = place + velocity;
    const Eigen::Vector3d force = resistance.step(next, &slot, kMax, kFullStretchMm);
    joule += (force + before).dot(next - place) / 2 * 1e-3;
    worst = std::max(worst, joule);
    place = next;
    before = force;
  }
  EXPECT_LT(worst, 1e-6);
  EXPECT_LT(joule, -0.01);
}

TEST(Resistance, of_nonsense_is_none) {
  Resistance resistance;
  EXPECT_EQ(pulled(resistance, slot_of(std::numeric_limits<double>::quiet_NaN(), {0, 1, 0}), 0, 9), 0);
  EXPECT_EQ(pulled(resistance, slot_of(-1, {0, 1, 0}), 0, 9), 0);
  EXPECT_EQ(pulled(resistance, slot_of(1, {0, 0, 0}), 0, 9), 0);
  EXPECT_EQ(pulled(resistance, slot_of(1, {0, std::numeric_limits<double>::quiet_NaN(), 0}), 0, 9), 0);
  EXPECT_NEAR(pulled(resistance, slot_of(9, {0, 1, 0}), 0, 9), -kMax, 1e-9) << "capped";
  EXPECT_EQ(resistance.step({0, 0, 0}, nullptr, kMax, kFullStretchMm).norm(), 0);
  const HapticResistance slot = slot_of(2, {0, 1, 0});
  EXPECT_EQ(resistance.step({0, 90, 0}, &slot, kMax, kFullStretchMm).norm(), 0) << "it begins anew";
  EXPECT_EQ(resistance.step(Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()), &slot, kMax, kFullStretchMm).norm(), 0);
}

TEST(Resistance, turns_with_its_direction_without_a_jump) {
  Resistance resistance;
  pulled(resistance, slot_of(2, {0, 1, 0}), 0, 20);
  Eigen::Vector3d before(0, -2, 0);
  for (int i = 0; i <= 90; ++i) {
    const double angle = i * M_PI / 180;
    const HapticResistance slot = slot_of(2, {std::sin(angle), std::cos(angle), 0});
    const Eigen::Vector3d force = resistance.step({7, 20, 0}, &slot, kMax, kFullStretchMm);
    EXPECT_LT((force - before).norm(), 0.06);
    before = force;
  }
}

/// What a trembling hand feels while it pulls slowly: a step of the force between two ticks is no more than the tremor's own way times the
/// stiffness. A resistance by speed would switch on and off with each tremor.
TEST(Resistance, doesnt_chatter_under_a_trembling_hand_on_a_coarse_position) {
  const auto hand = [](double s) {
    haptic_pen::SimulatedHand trembling;
    trembling.goal_mm = {0.1 * std::sin(60 * s), 5 * s + 0.1 * std::sin(57 * s), 0};
    return trembling;
  };
  HapticRig rig({}, hand, test::make_field([](const Eigen::Vector3d&) { return 30.0; }, {}));
  rig.resistance = std::make_unique<HapticResistance>(slot_of(1.5, {0, 1, 0}));
  rig.arm();
  rig.run_ms(2500);
  double last = rig.tick().command.newton.y(), worst_step = 0, least = last;
  for (int ms = 0; ms < 2000; ++ms) {
    const double newton = rig.tick().command.newton.y();
    worst_step = std::max(worst_step, std::abs(newton - last));
    least = std::max(least, newton);
    last = newton;
  }
  EXPECT_TRUE(rig.kept) << rig.checker.fault();
  EXPECT_LT(worst_step, 0.02);
  EXPECT_LT(least, -1.3) << "it resists all the time";
}

TEST(Resistance, and_contact_together_keep_to_the_devices_bound) {
  const haptic_pen::PenLimits device = haptic_pen::SimulatedPen({}, [](double) { return haptic_pen::SimulatedHand{}; }).limits();
  HapticLoop loop({}, device);
  HapticTick tick;
  tick.now_ns = 1'000'000'000;
  const double alone = loop.step(tick).stiffness_newton_m;
  const HapticResistance slot = slot_of(2, {0, 1, 0});
  tick.now_ns += 1'000'000;
  tick.sources.resistance = &slot;
  const double beside = loop.step(tick).stiffness_newton_m;
  EXPECT_NEAR(beside, alone / 2, 1e-6);
}

}  // namespace
}  // namespace prismesh::drivers::haptics
