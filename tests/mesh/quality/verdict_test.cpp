#include "mesh/quality/verdict.h"

#include <array>
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "mesh/quality/measure.h"
#include "mesh/quality/metrics.h"
#include "tests/support/verdict_library.h"

namespace prismesh::mesh::quality {
namespace {

using test::VerdictLibrary;

constexpr double kDegree = 3.14159265358979323846 / 180;

TEST(Verdict, variants_have_the_values_of_their_definitions) {
  const VerdictValues square = measure_verdict(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  EXPECT_DOUBLE_EQ(square.verdict_aspect, 1);
  EXPECT_DOUBLE_EQ(square.verdict_skew, 0);
  EXPECT_DOUBLE_EQ(square.verdict_warpage, 1);
  EXPECT_DOUBLE_EQ(square.verdict_taper, 0);
  EXPECT_DOUBLE_EQ(square.verdict_scaled_jacobian, 1);
  const VerdictValues wide = measure_verdict(std::vector<Vec3>{{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0}});
  EXPECT_DOUBLE_EQ(wide.verdict_aspect, 2);  // not the 3 of aspect
  const VerdictValues slanted =
      measure_verdict(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1.5, std::sqrt(0.75), 0}, {0.5, std::sqrt(0.75), 0}});
  EXPECT_NEAR(slanted.verdict_skew, 0.5, 1e-15);
  EXPECT_NEAR(slanted.verdict_scaled_jacobian, std::sqrt(0.75), 1e-15);
  const VerdictValues trapezoid = measure_verdict(std::vector<Vec3>{{0, 0, 0}, {4, 0, 0}, {3, 2, 0}, {1, 2, 0}});
  EXPECT_NEAR(trapezoid.verdict_taper, 0.5, 1e-15);
  EXPECT_NEAR(measure_verdict(std::vector<Vec3>{{0, 0, 0}, {2, 0, 0}, {1, std::sqrt(3.0), 0}}).verdict_aspect, 1, 1e-15);
  EXPECT_TRUE(std::isnan(measure_verdict(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).verdict_aspect));
}

/// What Verdict says of shapes, against what it has to be by our own figures.
struct Comparison {
  const char* verdict;
  std::function<double(const std::vector<Vec3>& corners)> ours;
};

double our_metric(const std::vector<Vec3>& corners, Metric which) { return measure(corners)[static_cast<std::size_t>(which)]; }

/// Shapes from nearly ideal to strongly bent, without corners turned in: Verdict has other ideas of those.
std::vector<std::vector<Vec3>> shapes(std::size_t corners) {
  const std::vector<Vec3> plain = corners == 4 ? std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}
                                               : std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}};
  std::mt19937 random(31);
  std::vector<std::vector<Vec3>> all;
  for (int trial = 0; trial < 3000; ++trial) {
    std::uniform_real_distribution<double> away(-0.0001 * trial, 0.0001 * trial), stretch(0.2, 5);
    std::vector<Vec3> shape = plain;
    const double by = stretch(random);
    for (Vec3& p : shape) {
      p += Vec3(away(random), away(random), away(random));
      p.x() *= by;
    }
    if (corners == 3 || our_metric(shape, Metric::max_angle_quad) < 175) all.push_back(shape);
  }
  return all;
}

void compare(std::size_t corners, const std::vector<Comparison>& comparisons) {
  const VerdictLibrary& library = VerdictLibrary::get();
  if (!library.is_there()) GTEST_SKIP() << VerdictLibrary::how_to_get();
  for (const Comparison& comparison : comparisons) {
    const VerdictLibrary::Metric verdict = library.metric(comparison.verdict);
    ASSERT_NE(verdict, nullptr) << comparison.verdict;
    for (const std::vector<Vec3>& shape : shapes(corners)) {
      double coordinates[4][3];
      for (std::size_t c = 0; c < corners; ++c)
        for (int axis = 0; axis < 3; ++axis) coordinates[c][axis] = shape[c][axis];
      const double theirs = verdict(static_cast<int>(corners), coordinates);
      const double ours = comparison.ours(shape);
      ASSERT_NEAR(ours, theirs, 2e-5 * std::max(1.0, std::abs(theirs))) << comparison.verdict;
    }
  }
}

TEST(VerdictOracle, agrees_about_quads) {
  compare(4, {{"quad_edge_ratio", [](const auto& p) { return our_metric(p, Metric::aspect); }},
              {"quad_minimum_angle", [](const auto& p) { return our_metric(p, Metric::min_angle_quad); }},
              {"quad_maximum_angle", [](const auto& p) { return our_metric(p, Metric::max_angle_quad); }},
              // the same angles, otherwise expressed
              {"quad_warpage", [](const auto& p) { return std::pow(std::cos(our_metric(p, Metric::warpage) * kDegree), 3); }},
              {"quad_skew", [](const auto& p) { return std::sin(our_metric(p, Metric::skew) * kDegree); }},
              {"quad_aspect_ratio", [](const auto& p) { return measure_verdict(p).verdict_aspect; }},
              {"quad_skew", [](const auto& p) { return measure_verdict(p).verdict_skew; }},
              {"quad_warpage", [](const auto& p) { return measure_verdict(p).verdict_warpage; }},
              {"quad_taper", [](const auto& p) { return measure_verdict(p).verdict_taper; }},
              {"quad_scaled_jacobian", [](const auto& p) { return measure_verdict(p).verdict_scaled_jacobian; }}});
}

TEST(VerdictOracle, has_the_same_figures_in_one_call) {
  const VerdictLibrary& library = VerdictLibrary::get();
  if (!library.is_there()) GTEST_SKIP() << VerdictLibrary::how_to_get();
  const auto all = library.all_of_quad();
  ASSERT_NE(all, nullptr);
  constexpr std::array<const char*, 9> kNames = {"quad_skew",          "quad_taper",           "quad_warpage",
                                                 "quad_area",          "quad_stretch",         "quad_minimum_angle",
                                                 "quad_maximum_angle", "quad_scaled_jacobian", "quad_max_edge_ratio"};
  double coordinates[4][3] = {{0, 0, 0}, {5, 0.3, 0}, {6, 4, 1}, {0, 5, 0.2}};
  const VerdictLibrary::QuadValues together = all(coordinates);
  for (std::size_t m = 0; m < kNames.size(); ++m) EXPECT_NEAR(together[m], library.metric(kNames[m])(4, coordinates), 1e-9) << kNames[m];
}

TEST(VerdictOracle, agrees_about_triangles) {
  compare(3, {{"tri_edge_ratio", [](const auto& p) { return our_metric(p, Metric::aspect); }},
              {"tri_minimum_angle", [](const auto& p) { return our_metric(p, Metric::min_angle_tri); }},
              {"tri_maximum_angle", [](const auto& p) { return our_metric(p, Metric::max_angle_tri); }},
              {"tri_area", [](const auto& p) { return 0.5 * our_metric(p, Metric::min_length) * our_metric(p, Metric::max_length); }},
              {"tri_aspect_ratio", [](const auto& p) { return measure_verdict(p).verdict_aspect; }}});
}

}  // namespace
}  // namespace prismesh::mesh::quality
