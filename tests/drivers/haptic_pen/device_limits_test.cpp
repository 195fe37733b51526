#include "drivers/haptic_pen/device_limits.h"

#include <limits>

#include <gtest/gtest.h>

namespace prismesh::drivers::haptic_pen {
namespace {

TEST(DeviceLimits, come_from_the_table) {
  EXPECT_EQ(figures_of("falcon")->device, "Novint Falcon");
  EXPECT_EQ(figures_of("simulated"), nullptr);
  EXPECT_EQ(figures_of("none"), nullptr);
  for (const DeviceFigures& one : kDeviceFigures) {
    EXPECT_EQ(figures_of(one.driver), &one);
    EXPECT_FALSE(one.source.empty());
    EXPECT_TRUE(one.peak_newton == 0 || one.peak_newton >= one.max_newton);
    const PenLimits limits = limits_of(one, 0.7, 0.2, 1'000'000);
    EXPECT_EQ(limits.max_newton, one.max_newton);
    EXPECT_EQ(limits.max_stiffness_newton_m, one.max_stiffness_newton_m);
    EXPECT_EQ(limits.degrees_in, one.degrees_in);
    EXPECT_EQ(limits.damping_newton_s_m, 0.7);
    EXPECT_EQ(limits.workspace_max_mm.y(), one.workspace_mm[1] / 2);
    EXPECT_EQ(limits.workspace_min_mm, -limits.workspace_max_mm);
  }
}

TEST(DeviceLimits, shorten_a_force_and_keep_its_direction) {
  PenLimits limits;
  limits.max_newton = 4;
  const PenCommand bounded = within({{30, -40, 0}, 77, {1, 0, 0}}, limits);
  EXPECT_TRUE(bounded.newton.isApprox(Eigen::Vector3d(2.4, -3.2, 0)));
  EXPECT_EQ(bounded.valid_until_ns, 77);
  EXPECT_EQ(within({{1, 2, -3}, 0}, limits).newton, Eigen::Vector3d(1, 2, -3));
  EXPECT_TRUE(within({{1, std::numeric_limits<double>::quiet_NaN(), 0}, 0}, limits).newton.isZero(0));
}

TEST(DeviceLimits, give_a_torque_only_where_six_degrees_go_out) {
  PenLimits limits;
  limits.max_newton = 4;
  limits.max_newton_metre = 0.1;
  const PenCommand asked{{1, 0, 0}, 0, {0, 0.3, -0.4}};
  EXPECT_TRUE(within(asked, limits).newton_metre.isZero(0));
  limits.degrees_out = 6;
  EXPECT_TRUE(within(asked, limits).newton_metre.isApprox(Eigen::Vector3d(0, 0.06, -0.08)));
  EXPECT_EQ(within(asked, limits).newton, asked.newton);
}

}  // namespace
}  // namespace prismesh::drivers::haptic_pen
