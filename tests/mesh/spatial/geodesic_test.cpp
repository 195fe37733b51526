#include "mesh/spatial/geodesic.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/support/make_model.h"

namespace prismesh::mesh::spatial {
namespace {

using test::grid_node;
using test::make_grid;
using test::make_model;

constexpr double kPiValue = 3.14159265358979323846;

/// A number in -1..1 that looks random and is the same in every run.
double noise(int i, int j, int which) {
  std::uint32_t h =
      static_cast<std::uint32_t>(i) * 73856093u ^ static_cast<std::uint32_t>(j) * 19349663u ^ static_cast<std::uint32_t>(which) * 83492791u;
  h ^= h >> 13;
  h *= 0x5bd1e995u;
  h ^= h >> 15;
  return static_cast<double>(h % 200001u) / 100000.0 - 1.0;
}

/// Where node (i, j) of a grid of unit squares stands in the plane, moved by up to `jitter` both ways.
std::array<double, 2> jittered(int i, int j, double jitter) { return {i + jitter * noise(i, j, 1), j + jitter * noise(i, j, 2)}; }

ShellSet all_shells(const Model& model) {
  ShellSet shells(model.shell_count());
  for (std::size_t i = 0; i < shells.size(); ++i) shells[i] = ShellIndex(i);
  return shells;
}

struct Errors {
  double mean = 0;
  double max = 0;
};

/// Errors of the distances from `source` within `radius`, as shares of the radius.
Errors compare(const Model& model, NodeIndex source, double radius, const std::function<double(NodeIndex)>& exact) {
  const Patch patch = cut_patch(model, all_shells(model));
  const std::vector<std::uint32_t> sources{
      static_cast<std::uint32_t>(std::lower_bound(patch.nodes.begin(), patch.nodes.end(), source) - patch.nodes.begin())};
  const std::vector<double> distance = geodesic_distance(patch, sources);
  Errors errors;
  std::size_t count = 0;
  for (std::size_t i = 0; i < distance.size(); ++i) {
    const double truth = exact(patch.nodes[i]);
    if (truth > radius) continue;
    const double error = std::abs(distance[i] - truth) / radius;
    errors.mean += error;
    errors.max = std::max(errors.max, error);
    ++count;
  }
  errors.mean /= static_cast<double>(count);
  EXPECT_GT(count, 100u);
  return errors;
}

void expect_within_aim(const Errors& errors) {
  EXPECT_LE(errors.mean, 0.003);
  EXPECT_LE(errors.max, 0.01);
  ::testing::Test::RecordProperty("mean_percent", std::to_string(100 * errors.mean));
  ::testing::Test::RecordProperty("max_percent", std::to_string(100 * errors.max));
}

TEST(Geodesic, is_straight_in_a_jittered_plane) {
  const Model model = make_grid(60, 60, [](int i, int j) {
    const auto [x, y] = jittered(i, j, 0.3);
    return Vec3(x, y, 0);
  });
  const NodeIndex source = grid_node(60, 30, 30);
  const Errors errors = compare(model, source, 25, [&](NodeIndex n) { return (model.position(n) - model.position(source)).norm(); });
  EXPECT_LE(errors.max, 1e-9);
}

TEST(Geodesic, is_straight_from_a_corner_and_a_side_of_a_plane) {
  const Model model = make_grid(50, 50, [](int i, int j) {
    const auto [x, y] = jittered(i, j, i % 50 == 0 || j % 50 == 0 ? 0.0 : 0.3);
    return Vec3(x, y, 0);
  });
  for (const NodeIndex source : {grid_node(50, 0, 0), grid_node(50, 25, 0)}) {
    const Errors errors = compare(model, source, 45, [&](NodeIndex n) { return (model.position(n) - model.position(source)).norm(); });
    EXPECT_LE(errors.max, 1e-9);
  }
}

/// Triangles cut from each square, obtuse where `stretch` is far from 1.
Model triangle_sheet(int columns, int rows, double stretch, double shear) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  const int stride = columns + 1;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const auto [x, y] = jittered(i, j, 0.25);
      nodes.push_back({1 + i + j * stride, Vec3(stretch * x + shear * y, y, 0)});
    }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const std::int64_t a = 1 + i + j * stride;
      const std::int64_t id = 1 + 2 * (i + j * columns);
      shells.push_back({id, 1, {a, a + 1, a + 1 + stride}});
      shells.push_back({id + 1, 1, {a, a + 1 + stride, a + stride}});
    }
  return make_model(nodes, shells);
}

TEST(Geodesic, is_straight_over_obtuse_triangles) {
  for (const auto& [stretch, shear] : {std::pair{1.0, 0.0}, {2.0, 0.0}, {1.0, 1.2}, {1.5, 2.0}}) {
    const Model model = triangle_sheet(60, 60, stretch, shear);
    const NodeIndex source = grid_node(60, 30, 30);
    const Errors errors = compare(model, source, 20, [&](NodeIndex n) { return (model.position(n) - model.position(source)).norm(); });
    expect_within_aim(errors);
  }
}

TEST(Geodesic, unrolls_a_cylinder) {
  constexpr double kRadius = 20;
  const auto flat = [](int i, int j) { return jittered(i, j, 0.3); };
  const Model model = make_grid(50, 50, [&](int i, int j) {
    const auto [u, v] = flat(i, j);
    return Vec3(kRadius * std::cos(u / kRadius), kRadius * std::sin(u / kRadius), v);
  });
  const Errors errors = compare(model, grid_node(50, 25, 25), 24, [&](NodeIndex n) {
    const auto [u0, v0] = flat(25, 25);
    const auto [u, v] = flat(static_cast<int>(n.value % 51), static_cast<int>(n.value / 51));
    return std::hypot(u - u0, v - v0);
  });
  expect_within_aim(errors);
}

TEST(Geodesic, unrolls_a_cone) {
  constexpr double kSlope = 0.6;  // sine of the half opening angle: a turn of the cone is 0.6 turns unrolled
  const auto polar = [](int i, int j) {
    const auto [u, v] = jittered(i, j, 0.3);
    return std::array<double, 2>{u / 60, 30 + v};  // angle in the unrolled plane, distance from the apex
  };
  const Model model = make_grid(60, 50, [&](int i, int j) {
    const auto [angle, r] = polar(i, j);
    return Vec3(r * kSlope * std::cos(angle / kSlope), r * kSlope * std::sin(angle / kSlope), r * std::sqrt(1 - kSlope * kSlope));
  });
  const Errors errors = compare(model, grid_node(60, 30, 25), 20, [&](NodeIndex n) {
    const auto [a0, r0] = polar(30, 25);
    const auto [a, r] = polar(static_cast<int>(n.value % 61), static_cast<int>(n.value / 61));
    return std::sqrt(r * r + r0 * r0 - 2 * r * r0 * std::cos(a - a0));
  });
  expect_within_aim(errors);
}

TEST(Geodesic, follows_great_circles_on_a_sphere) {
  constexpr double kRadius = 40;
  const Model model = make_grid(80, 80, [&](int i, int j) {
    const auto [u, v] = jittered(i, j, 0.3);
    return Vec3(kRadius * Vec3(std::tan((u - 40) / 60), std::tan((v - 40) / 60), 1).normalized());
  });
  const NodeIndex source = grid_node(80, 40, 40);
  const Errors errors = compare(model, source, 24, [&](NodeIndex n) {
    const Vec3 a = model.position(source);
    const Vec3 b = model.position(n);
    return kRadius * std::atan2(a.cross(b).norm(), a.dot(b));
  });
  expect_within_aim(errors);
}

}  // namespace
}  // namespace prismesh::mesh::spatial
