#include "mesh/quality/metrics.h"

#include <bit>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "mesh/quality/measure.h"
#include "mesh/quality/shell_batch.h"
#include "mesh/quality/shell_kernels.h"
#include "tests/mesh/quality/mixed_grid.h"

namespace prismesh::mesh::quality {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

struct Shape {
  const char* name;
  std::vector<Vec3> corners;
  Values expected;  ///< warpage aspect skew jacobian taper | min max angle quad | min max angle tri | min max length
};

// Every figure is worked out by hand from the definitions in docs/quality/metrics.md.
const std::vector<Shape>& shapes() {
  static const std::vector<Shape> all = {
      {"unit square", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 0, 1, 0, 90, 90, kNone, kNone, 1, 1}},
      {"rectangle 3 x 1", {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0}}, {0, 3, 0, 1, 0, 90, 90, kNone, kNone, 1, 3}},
      {"rhombus of 60 degrees",
       {{0, 0, 0}, {1, 0, 0}, {1.5, std::sqrt(0.75), 0}, {0.5, std::sqrt(0.75), 0}},
       {0, 1, 30, 1, 0, 60, 120, kNone, kNone, 1, 1}},
      {"trapezoid 4 / 2, height 2",
       {{0, 0, 0}, {4, 0, 0}, {3, 2, 0}, {1, 2, 0}},
       {0, 2, 0, 0.677218f, 1.0f / 3, 63.43495f, 116.56505f, kNone, kNone, 2, 4}},
      {"arrowhead: one corner turned in",
       {{0, 0, 0}, {3, -3, 0}, {1, 0, 0}, {3, 3, 0}},
       {180, 1.1766968f, 71.07536f, -0.485431f, 2, 11.309932f, 247.380135f, kNone, kNone, 3.6055513f, 4.2426407f}},
      {"warped: one corner up 1 in 10",
       {{0, 0, 0}, {10, 0, 0}, {10, 10, 1}, {0, 10, 0}},
       {8.069301f, 1.0049876f, 0.142882f, 0.9942717f, 0.0024907f, 89.432706f, 90, kNone, kNone, 10, 10.0498756f}},
      {"right triangle 3/4/5",
       {{0, 0, 0}, {4, 0, 0}, {0, 3, 0}},
       {kNone, 5.0f / 3, 33.690068f, kNone, kNone, kNone, kNone, 36.869898f, 90, 2.4f, 5}},
      {"equilateral triangle",
       {{0, 0, 0}, {2, 0, 0}, {1, std::sqrt(3.0), 0}},
       {kNone, 1, 0, kNone, kNone, kNone, kNone, 60, 60, 1.7320508f, 2}},
      {"flat triangle 5/5/9.9: edge 5, height 0.7",
       {{0, 0, 0}, {9.9, 0, 0}, {4.95, std::sqrt(25 - 4.95 * 4.95), 0}},
       {kNone, 1.98f, 79.1707f, kNone, kNone, kNone, kNone, 8.109614f, 163.78077f, 0.7053368f, 9.9f}},
  };
  return all;
}

void expect_near(const Values& values, const Values& expected, double tolerance, const std::string& what) {
  for (int m = 0; m < kMetricCount; ++m) {
    const std::string which = what + ", " + std::string(name(static_cast<Metric>(m)));
    EXPECT_EQ(std::isnan(values[m]), std::isnan(expected[m])) << which;
    if (!std::isnan(expected[m])) {
      EXPECT_NEAR(values[m], expected[m], tolerance * std::max(1.0f, std::abs(expected[m]))) << which;
    }
  }
}

TEST(Metrics, shapes_have_the_values_of_the_definitions) {
  for (const Shape& shape : shapes()) expect_near(measure(shape.corners), shape.expected, 1e-5, shape.name);
}

TEST(Metrics, flat_squares_are_exactly_flat_and_square) {
  for (const double size : {1e-6, 1.0, 5.0, 1e6}) {
    const Values values = measure(std::vector<Vec3>{{0, 0, 0}, {size, 0, 0}, {size, size, 0}, {0, size, 0}});
    EXPECT_EQ(values[int(Metric::warpage)], 0);
    EXPECT_EQ(values[int(Metric::skew)], 0);
    EXPECT_EQ(values[int(Metric::min_angle_quad)], 90);
    EXPECT_EQ(values[int(Metric::max_angle_quad)], 90);
    EXPECT_EQ(values[int(Metric::jacobian)], 1);
  }
}

TEST(Metrics, degenerate_shapes_give_the_worst_value) {
  struct Degenerate {
    std::vector<Vec3> corners;
    bool has_area;
  };
  const std::vector<Degenerate> all = {
      {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, false},  // a point
      {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, false},  // a line
      {{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, true},   // a triangle in disguise
      {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, false},
      {{{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}, false},
  };
  for (const Degenerate& one : all) {
    const Values values = measure(one.corners);
    const bool is_quad = one.corners.size() == 4;
    for (int m = 0; m < kMetricCount; ++m) {
      const auto metric = static_cast<Metric>(m);
      const bool only_quads = metric == Metric::warpage || metric == Metric::jacobian || metric == Metric::taper ||
                              metric == Metric::min_angle_quad || metric == Metric::max_angle_quad;
      const bool only_triangles = metric == Metric::min_angle_tri || metric == Metric::max_angle_tri;
      EXPECT_EQ(std::isnan(values[m]), is_quad ? only_triangles : only_quads) << name(metric);
      EXPECT_FALSE(std::isinf(values[m])) << name(metric);
    }
    if (!one.has_area) {
      EXPECT_EQ(values[int(Metric::skew)], 90);
      if (is_quad) {
        EXPECT_EQ(values[int(Metric::warpage)], 180);
        EXPECT_EQ(values[int(Metric::jacobian)], -1);
        EXPECT_EQ(values[int(Metric::taper)], 2);
      } else {
        EXPECT_NEAR(values[int(Metric::min_length)], 0, 1e-12);
        EXPECT_EQ(values[int(Metric::min_angle_tri)], 0);
        EXPECT_EQ(values[int(Metric::max_angle_tri)], 180);
      }
    }
  }
  const Values disguised = measure(all[2].corners);
  EXPECT_EQ(disguised[int(Metric::aspect)], 1e9f);
  EXPECT_EQ(disguised[int(Metric::min_angle_quad)], 0);
  EXPECT_EQ(disguised[int(Metric::max_angle_quad)], 360);
  EXPECT_EQ(disguised[int(Metric::min_length)], 0);
}

std::vector<Vec3> random_corners(std::mt19937& random, std::size_t count) {
  std::uniform_real_distribution<double> away(-0.3, 0.3);
  const std::vector<Vec3> plain = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  std::vector<Vec3> corners(plain.begin(), plain.begin() + static_cast<std::ptrdiff_t>(count));
  for (Vec3& corner : corners) corner += Vec3(away(random), away(random), away(random));
  return corners;
}

TEST(Metrics, turning_moving_and_renumbering_change_nothing) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 200; ++trial) {
    const std::vector<Vec3> corners = random_corners(random, trial % 2 == 0 ? 4 : 3);
    const Values plain = measure(corners);
    const Eigen::AngleAxisd turn(0.1 * trial, Vec3(1, trial % 5, -2).normalized());
    std::vector<Vec3> changed;
    for (const Vec3& corner : corners) changed.push_back(turn * corner + Vec3(3, -5, 8));
    expect_near(measure(changed), plain, 1e-5, "turned");
    std::vector<Vec3> rotated = corners;
    for (std::size_t start = 1; start < corners.size(); ++start) {
      std::rotate(rotated.begin(), rotated.begin() + 1, rotated.end());
      expect_near(measure(rotated), plain, 1e-5, "renumbered");
    }
    std::reverse(rotated.begin(), rotated.end());
    expect_near(measure(rotated), plain, 1e-5, "turned over");
  }
}

TEST(Metrics, size_scales_the_lengths_only) {
  std::mt19937 random(12);
  for (int trial = 0; trial < 100; ++trial) {
    const std::vector<Vec3> corners = random_corners(random, trial % 2 == 0 ? 4 : 3);
    for (const double scale : {1e-5, 1e4}) {
      Values expected = measure(corners);
      expected[int(Metric::min_length)] *= static_cast<float>(scale);
      expected[int(Metric::max_length)] *= static_cast<float>(scale);
      std::vector<Vec3> scaled;
      for (const Vec3& corner : corners) scaled.push_back(corner * scale);
      expect_near(measure(scaled), expected, 1e-5, "scaled");
    }
  }
}

/// Interior angles and warpage by the library's arc cosine.
TEST(Metrics, angles_agree_with_the_plain_formulas) {
  const auto degrees_between = [](const Vec3& a, const Vec3& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / 3.14159265358979323846;
  };
  std::mt19937 random(13);
  for (int trial = 0; trial < 500; ++trial) {
    const std::vector<Vec3> p = random_corners(random, 4);
    const auto normal = [&](int a, int b, int c) { return (p[b] - p[a]).cross(p[c] - p[b]); };
    const double warpage = std::max(degrees_between(normal(0, 1, 2), normal(2, 3, 0)), degrees_between(normal(1, 2, 3), normal(3, 0, 1)));
    const Values values = measure(p);
    EXPECT_NEAR(values[int(Metric::warpage)], warpage, 1e-5 * (1 + warpage));
    double least = 360;
    for (int i = 0; i < 4; ++i) least = std::min(least, degrees_between(p[(i + 1) % 4] - p[i], p[(i + 3) % 4] - p[i]));
    EXPECT_NEAR(values[int(Metric::min_angle_quad)], least, 1e-4);
    const std::vector<Vec3> t(p.begin(), p.begin() + 3);
    double widest = 0;
    for (int i = 0; i < 3; ++i) widest = std::max(widest, degrees_between(t[(i + 1) % 3] - t[i], t[(i + 2) % 3] - t[i]));
    EXPECT_NEAR(measure(t)[int(Metric::max_angle_tri)], widest, 1e-4);
  }
}

bool same_bits(const Values& a, const Values& b) {
  for (int m = 0; m < kMetricCount; ++m)
    if (std::bit_cast<std::uint32_t>(a[m]) != std::bit_cast<std::uint32_t>(b[m]) && !(std::isnan(a[m]) && std::isnan(b[m]))) return false;
  return true;
}

TEST(Metrics, one_by_one_in_ranges_and_in_lists_give_the_same_bits) {
  const Model model = test::mixed_grid(40, 0.3, false, 14);
  std::vector<Values> range(model.shell_count() - 7), list;
  measure_range(model, 7, model.shell_count(), range);
  std::vector<ShellIndex> shells;
  for (std::size_t s = 0; s < model.shell_count(); s += 3) shells.emplace_back(s);
  list.resize(shells.size());
  measure_shells(model, shells, list);
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    std::vector<Vec3> corners;
    for (int c = 0; c < model.shell_nodes[s].corners(); ++c) corners.push_back(model.position(model.shell_nodes[s].node[c]));
    const Values alone = measure(corners);
    if (s >= 7) {
      EXPECT_TRUE(same_bits(range[s - 7], alone)) << s;
    }
    if (s % 3 == 0) {
      EXPECT_TRUE(same_bits(list[s / 3], alone)) << s;
    }
  }
}

/// The kernels as this file compiles them: for the plain processor, without the clones.
TEST(Metrics, vector_code_gives_the_bits_of_plain_code) {
  std::mt19937 random(15);
  for (int trial = 0; trial < 100; ++trial) {
    ShellBatch batch;
    batch.count = kLanes;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::vector<Vec3> p = random_corners(random, 4);
      for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t axis = 0; axis < 3; ++axis) batch.p[c][axis][lane] = p[c][static_cast<Eigen::Index>(axis)] * 7 + 1000;
    }
    BatchValues chosen, plain;
    measure_quads(batch, chosen);
    kernels::quads(batch, plain);
    for (std::size_t lane = 0; lane < kLanes; ++lane) EXPECT_TRUE(same_bits(chosen.at(lane), plain.at(lane)));
    measure_triangles(batch, chosen);
    kernels::triangles(batch, plain);
    for (std::size_t lane = 0; lane < kLanes; ++lane) EXPECT_TRUE(same_bits(chosen.at(lane), plain.at(lane)));
  }
}

TEST(Metrics, have_the_units_of_what_they_measure) {
  EXPECT_EQ(unit_of(Metric::max_length, "in"), "in");
  EXPECT_EQ(unit_of(Metric::taper, "in"), "");
  EXPECT_EQ(unit_of(Metric::min_angle_tri, "in"), "deg");
  for (int m = 0; m < kMetricCount; ++m) {
    const auto metric = static_cast<Metric>(m);
    EXPECT_EQ(is_of_triangles(metric), name(metric).ends_with("_tri")) << name(metric);
    EXPECT_EQ(unit_of(metric, "mm") == "mm", name(metric).ends_with("_length")) << name(metric);
  }
}

}  // namespace
}  // namespace prismesh::mesh::quality
