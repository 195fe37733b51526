// Each part of the force by itself.
#include "drivers/haptics/forces.h"

#include <limits>
#include <memory>

#include <gtest/gtest.h>

namespace prismesh::drivers::haptics {
namespace {

Eigen::Vector3d newton(const std::array<ForcePart, kForceKinds>& parts, ForceKind kind) {
  return parts[static_cast<std::size_t>(kind)].newton;
}

TEST(forces, contact_and_friction_are_the_spring_to_the_proxy) {
  auto field = std::make_unique<HapticField>();
  field->time_ns = 77;
  ProxyContact contact;
  contact.touching = true;
  contact.proxy_mm = {1, 0, 2};
  contact.normal = {0, 0, 1};
  const auto parts = force_parts({}, contact, {.field = field.get()}, {.stiffness_newton_m = 500});
  EXPECT_NEAR((newton(parts, ForceKind::contact) - Eigen::Vector3d(0, 0, 1)).norm(), 0, 1e-12);
  EXPECT_NEAR((newton(parts, ForceKind::friction) - Eigen::Vector3d(0.5, 0, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(parts[0].from_ns, 77);
  EXPECT_EQ(parts[1].from_ns, 77);
  contact.touching = false;
  EXPECT_EQ(newton(force_parts({}, contact, {.field = field.get()}, {}), ForceKind::contact).norm(), 0);
}

TEST(forces, damping_opposes_the_velocity_and_has_no_age) {
  const auto parts = force_parts({.velocity_mm_s = {100, -50, 0}}, {}, {}, {.damping_newton_s_m = 0.4});
  EXPECT_NEAR((newton(parts, ForceKind::damping) - Eigen::Vector3d(-0.04, 0.02, 0)).norm(), 0, 1e-12);
  EXPECT_TRUE(parts[static_cast<std::size_t>(ForceKind::damping)].damping);
  EXPECT_EQ(parts[static_cast<std::size_t>(ForceKind::damping)].from_ns, 0);
}

struct PullRig {
  Eigen::Vector3d at(const Eigen::Vector3d& pen_mm) const {
    return newton(force_parts({.position_mm = pen_mm}, {}, {.guides = guides.get(), .placement = 3}, feel), ForceKind::pull);
  }
  std::unique_ptr<HapticGuides> guides = std::make_unique<HapticGuides>();
  Feel feel;
};

TEST(forces, a_pull_leads_to_the_nearest_node_or_line_and_is_gentle) {
  PullRig rig;
  rig.guides->placement = 3;
  rig.guides->count = 2;
  rig.guides->guides[0] = {{0, 0, 0}, {0, 0, 0}};
  rig.guides->guides[1] = {{10, -5, 0}, {10, 5, 0}};
  EXPECT_NEAR((rig.at({2, 0, 0}) - Eigen::Vector3d(-0.3, 0, 0)).norm(), 0, 1e-12) << "largest in the middle of the reach";
  EXPECT_NEAR((rig.at({8, 3, 0}) - Eigen::Vector3d(0.3, 0, 0)).norm(), 0, 1e-12) << "toward the line's nearest point";
  EXPECT_EQ(rig.at({0, 0, 0}).norm(), 0);
  EXPECT_EQ(rig.at({0, 4.001, 0}).norm(), 0);
  EXPECT_NEAR(rig.at({0, 3.999, 0}).norm(), 0, 1e-3) << "no step at the reach";
  // It gives back what it took: the work around a closed way is zero.
  double joule = 0;
  const int n = 20'000;
  const auto place = [&](int i) {
    return Eigen::Vector3d(1.5 + std::cos(2 * 3.14159265358979 * i / n), 0.7 * std::sin(2 * 3.14159265358979 * i / n), 0.2);
  };
  for (int i = 0; i < n; ++i) joule += rig.at((place(i) + place(i + 1)) / 2).dot(place(i + 1) - place(i)) * 1e-3;
  EXPECT_NEAR(joule, 0, 1e-9);
}

TEST(forces, guides_of_another_placement_or_without_numbers_do_not_pull) {
  PullRig rig;
  rig.guides->placement = 2;
  rig.guides->count = 1;
  EXPECT_EQ(rig.at({2, 0, 0}).norm(), 0);
  rig.guides->placement = 3;
  EXPECT_GT(rig.at({2, 0, 0}).norm(), 0);
  rig.guides->guides[0].from_mm[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(rig.at({2, 0, 0}).norm(), 0);
  rig.guides->count = 1'000'000'000;
  rig.at({2, 0, 0});
  rig.guides->count = -1;
  EXPECT_EQ(rig.at({2, 0, 0}).norm(), 0);
}

}  // namespace
}  // namespace prismesh::drivers::haptics
