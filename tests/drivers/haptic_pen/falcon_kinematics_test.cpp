// The Falcon's kinematics, against equations of another form and by differences.
#include "drivers/haptic_pen/falcon/kinematics.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace prismesh::drivers::haptic_pen::falcon {
namespace {

/// An arm's angle by the half-angle form of the closed chain [Stamper 1997, section 3.2], in which each length has its name of that text.
double half_angle_solution(const Eigen::Vector3d& grip, double phi) {
  const double a = 0.060, b = 0.1025, c = 0.01443, d = 0.01125, e = 0.01125, f = -0.025, r = 0.040, s = -0.02309;
  const double pu = std::cos(phi) * grip.x() + std::sin(phi) * grip.y() - r;
  const double pv = -std::sin(phi) * grip.x() + std::cos(phi) * grip.y() - s;
  const double pw = grip.z();
  const double theta3 = std::acos((pv + f) / b);
  const double along = d + e + b * std::sin(theta3);
  const double base = pw * pw + (pu + c) * (pu + c) + a * a - along * along;
  const double l0 = base - 2 * a * (pu + c), l1 = -4 * a * pw, l2 = base + 2 * a * (pu + c);
  return 2 * std::atan((-l1 - std::sqrt(l1 * l1 - 4 * l0 * l2)) / (2 * l2));
}

std::vector<Eigen::Vector3d> places_in_reach() {
  std::vector<Eigen::Vector3d> places;
  for (double x = -0.04; x <= 0.0401; x += 0.02)
    for (double y = -0.04; y <= 0.0401; y += 0.02)
      for (double z = -0.04; z <= 0.0401; z += 0.02) places.push_back(kMiddle + Eigen::Vector3d(x, y, z));
  return places;
}

TEST(FalconKinematics, agree_with_the_half_angle_form) {
  for (const Eigen::Vector3d& place : places_in_reach()) {
    const auto angles = inverse_kinematics(place);
    ASSERT_TRUE(angles) << place.transpose();
    for (int arm = 0; arm < 3; ++arm) {
      const double phi = std::numbers::pi / 2 + std::numbers::pi / 12 - arm * 2 * std::numbers::pi / 3;
      EXPECT_NEAR((*angles)[arm], half_angle_solution(place, phi), 1e-9) << place.transpose() << " arm " << arm;
    }
  }
}

TEST(FalconKinematics, lead_back_to_the_place_from_anywhere_in_reach) {
  const std::vector<Eigen::Vector3d> places = places_in_reach();
  for (const Eigen::Vector3d& place : places)
    for (const Eigen::Vector3d& near : {kMiddle, places.front(), places.back()}) {
      const auto found = forward_kinematics(*inverse_kinematics(place), near);
      ASSERT_TRUE(found) << place.transpose() << " from " << near.transpose();
      EXPECT_LT((found->position - place).norm(), 1e-9);
    }
}

TEST(FalconKinematics, jacobian_is_that_of_differences) {
  constexpr double kStep = 1e-6;
  for (const Eigen::Vector3d& place : places_in_reach()) {
    const Eigen::Vector3d angles = *inverse_kinematics(place);
    const auto found = forward_kinematics(angles, place);
    ASSERT_TRUE(found);
    for (int arm = 0; arm < 3; ++arm) {
      const Eigen::Vector3d turn = Eigen::Vector3d::Unit(arm) * kStep;
      const Eigen::Vector3d slope =
          (forward_kinematics(angles + turn, place)->position - forward_kinematics(angles - turn, place)->position) / (2 * kStep);
      EXPECT_LT((found->jacobian.col(arm) - slope).norm(), 1e-6 * (1 + slope.norm())) << place.transpose();
    }
  }
}

TEST(FalconKinematics, torques_do_the_work_of_the_force) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(-1, 1);
  for (const Eigen::Vector3d& place : places_in_reach()) {
    const Eigen::Vector3d force = 8 * Eigen::Vector3d(part(random), part(random), part(random));
    const Eigen::Vector3d way = 1e-6 * Eigen::Vector3d(part(random), part(random), part(random));
    const Eigen::Vector3d before = *inverse_kinematics(place), after = *inverse_kinematics(place + way);
    const auto found = forward_kinematics(before, place);
    ASSERT_TRUE(found);
    EXPECT_NEAR(torques(*found, force).dot(after - before), force.dot(way), 1e-9);
  }
}

TEST(FalconKinematics, moves_the_way_that_the_user_sees) {
  // Arms that swing out push the grip toward the user; the top arm alone tips it down.
  const Eigen::Vector3d angles = *inverse_kinematics(kMiddle);
  EXPECT_GT(forward_kinematics(angles + Eigen::Vector3d::Constant(0.1))->position.z(), kMiddle.z() + 0.003);
  const double side = forward_kinematics(angles + Eigen::Vector3d(0, 0.1, 0))->position.x() - kMiddle.x();
  const double other = forward_kinematics(angles + Eigen::Vector3d(0, 0, 0.1))->position.x() - kMiddle.x();
  EXPECT_LT(side * other, 0);
}

TEST(FalconKinematics, refuse_what_the_mechanism_cannot_do) {
  EXPECT_FALSE(inverse_kinematics(kMiddle + Eigen::Vector3d(0.2, 0, 0)));
  EXPECT_FALSE(inverse_kinematics({0, 0, 0.5}));
  EXPECT_FALSE(forward_kinematics(Eigen::Vector3d::Constant(std::nan(""))));
  EXPECT_FALSE(forward_kinematics({angle_of_count(32767), angle_of_count(-32768), angle_of_count(32767)}));
  std::mt19937 random(5);
  for (int i = 0; i < 20'000; ++i) {
    Eigen::Vector3d angles;
    for (int arm = 0; arm < 3; ++arm) angles[arm] = angle_of_count(static_cast<std::int16_t>(random()));
    const auto place = forward_kinematics(angles);
    if (!place) continue;
    EXPECT_TRUE(place->position.allFinite() && place->jacobian.allFinite());
    const auto back = inverse_kinematics(place->position);
    ASSERT_TRUE(back);
    EXPECT_LT((*back - angles).norm(), 1e-6);
  }
}

TEST(FalconKinematics, a_count_is_as_fine_as_the_maker_says) {
  // 400 a inch.
  const Eigen::Vector3d angles = *inverse_kinematics(kMiddle);
  const double step_mm = forward_kinematics(angles)->jacobian.col(0).norm() * (angle_of_count(1) - angle_of_count(0)) * 1e3;
  EXPECT_GT(step_mm, 0.02);
  EXPECT_LT(step_mm, 0.0635);
  EXPECT_NEAR(count_of_angle(angle_of_count(-777)), -777, 1e-9);
}

}  // namespace
}  // namespace prismesh::drivers::haptic_pen::falcon
