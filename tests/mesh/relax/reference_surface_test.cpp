#include "mesh/relax/reference_surface.h"

#include <gtest/gtest.h>

#include "tests/mesh/relax/relaxing.h"

namespace prismesh::test {

namespace {

using namespace mesh;

TEST(reference_surface, is_near_the_true_surface) {
  for (const KnownSurface& known : {cylinder(), cone(), torus()})
    for (const double jitter : {0.0, 0.15, 0.3}) {
      const Model model = sheet_on(known, 20, 16, jitter);
      const relax::ReferenceSurface surface(model, all_shells(model), 30);
      double farthest = 0;
      for (int i = 0; i <= 200; ++i)
        for (int j = 0; j <= 160; ++j) {
          const std::optional<relax::OnSurface> on = surface.project(known.at(i * 0.1, j * 0.1), kSize);
          ASSERT_TRUE(on);
          farthest = std::max(farthest, known.off(on->point));
        }
      EXPECT_LE(farthest, 0.1 * known.sagitta) << known.name << ", jitter " << jitter;
    }
}

TEST(reference_surface, goes_through_its_nodes_and_stays_on_its_side_of_a_crease) {
  // two quarter pipes that meet at a right angle, in the line x = 0, z = 0
  const Model model = make_grid(16, 8, [](int i, int j) {
    const double angle = (i - 8) * 0.15;
    return Vec3(20 * std::sin(angle), 5 * j, 20 * (1 - std::cos(angle)) + 20 * std::abs(std::sin(angle)));
  });
  const relax::ReferenceSurface surface(model, all_shells(model), 30);
  for (std::size_t n = 0; n < model.node_count(); ++n) {
    const std::optional<relax::OnSurface> on = surface.project(model.position(NodeIndex(n)), 1);
    ASSERT_TRUE(on);
    EXPECT_LT((on->point - model.position(NodeIndex(n))).norm(), 1e-9) << n;
  }
  const auto known = [](double angle) {
    return Vec3(20 * std::sin(angle), 17, 20 * (1 - std::cos(angle)) + 20 * std::abs(std::sin(angle)));
  };
  const double sagitta = 20 * (1 - std::cos(0.075)) * 1.5;
  for (double angle = -1; angle <= 1; angle += 0.01) {
    const std::optional<relax::OnSurface> on = surface.project(known(angle), 1);
    ASSERT_TRUE(on);
    EXPECT_LT(on->distance, 0.1 * sagitta) << angle;
  }
}

TEST(reference_surface, draws_lines_as_arcs_and_keeps_corners) {
  const Model model = make_grid(12, 6, [](int i, int j) {
    const double angle = i * 0.2;
    return Vec3((30 + 5 * j) * std::cos(angle), (30 + 5 * j) * std::sin(angle), 0);
  });
  const relax::ReferenceSurface surface(model, all_shells(model), 30);
  for (double angle = 0.01; angle < 2.39; angle += 0.01) {
    const Vec3 out(std::cos(angle), std::sin(angle), 0);
    const std::optional<Vec3> on = surface.project_on_line(30.3 * out, 2);
    ASSERT_TRUE(on);
    EXPECT_NEAR(on->norm(), 30, 2e-3 * 30 * (1 - std::cos(0.1))) << angle;
    EXPECT_NEAR((*on - 30 * out).norm(), 0, 1e-2) << angle;
  }
  EXPECT_LT((*surface.project_on_line(Vec3(29, -1, 0), 3) - Vec3(30, 0, 0)).norm(), 1e-9);
  EXPECT_FALSE(surface.project_on_line(Vec3(40, 5, 0), 1));
}

TEST(reference_surface, takes_no_shell_that_leans_the_other_way) {
  // a floor, and a wall that stands on nothing just above it
  std::vector<Vec3> points;
  for (int i = 0; i < 9; ++i) points.emplace_back(i % 3, i / 3, 0);
  for (int i = 0; i < 4; ++i) points.emplace_back(1 + i % 2, 1, 0.1 + i / 2);
  const Model model = make_shells(points, {{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}, {4, 5, 8, 7}, {9, 10, 12, 11}});
  const relax::ReferenceSurface surface(model, all_shells(model), 30);
  const Vec3 point(1.5, 1, 0.08);
  EXPECT_EQ(surface.project(point, 1)->shell, ShellIndex(std::size_t{4}));
  EXPECT_NE(surface.project(point, 1, Vec3::UnitZ())->shell, ShellIndex(std::size_t{4}));
  EXPECT_FALSE(surface.project(point, 0.05, Vec3::UnitZ()));
}

}  // namespace

}  // namespace prismesh::test
