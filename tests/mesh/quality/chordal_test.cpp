#include "mesh/quality/chordal.h"

#include <cmath>

#include <gtest/gtest.h>

#include "mesh/model/topology_change.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::quality {
namespace {

constexpr double kRadius = 50, kStep = 0.1;

Model cylinder() {
  return test::make_grid(6, 4, [](int i, int j) { return Vec3(kRadius * std::cos(kStep * i), kRadius * std::sin(kStep * i), 5 * j); });
}

std::optional<Vec3> on_cylinder(ShellIndex, const Vec3& p) {
  const double to = kRadius / std::hypot(p.x(), p.y());
  return Vec3(p.x() * to, p.y() * to, p.z());
}

TEST(Chordal, of_a_cylinder_is_the_sagitta) {
  const std::vector<float> deviations = chordal_deviations(cylinder(), nullptr, on_cylinder);
  ASSERT_EQ(deviations.size(), 24u);
  for (const float deviation : deviations) EXPECT_NEAR(deviation, kRadius * (1 - std::cos(kStep / 2)), 1e-6);
}

TEST(Chordal, of_a_flat_sheet_is_nothing) {
  const Model flat = test::make_grid(3, 3, [](int i, int j) { return Vec3(i, j, 0); });
  const auto plane = [](ShellIndex, const Vec3& p) { return std::optional(Vec3(p.x(), p.y(), 0)); };
  for (const float deviation : chordal_deviations(flat, nullptr, plane)) EXPECT_EQ(deviation, 0);
}

TEST(Chordal, is_unknown_where_there_is_nothing_to_compare_with) {
  Model model = cylinder();
  remove_shell(model, ShellIndex(std::size_t{1}));
  model.positions.set(0, Vec3(std::nan(""), 0, 0));
  const ShellSet some = {ShellIndex(std::size_t{0}), ShellIndex(std::size_t{1}), ShellIndex(std::size_t{2}), ShellIndex(std::size_t{3})};
  const auto but_the_third = [](ShellIndex shell, const Vec3& p) {
    return shell == ShellIndex(std::size_t{2}) ? std::nullopt : on_cylinder(shell, p);
  };
  const std::vector<float> deviations = chordal_deviations(model, &some, but_the_third);
  ASSERT_EQ(deviations.size(), 4u);
  EXPECT_TRUE(std::isnan(deviations[0]) && std::isnan(deviations[1]) && std::isnan(deviations[2]));
  EXPECT_GT(deviations[3], 0);
}

}  // namespace
}  // namespace prismesh::mesh::quality
