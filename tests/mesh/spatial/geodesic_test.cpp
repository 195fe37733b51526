#include "mesh/spatial/geodesic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "mesh/spatial/cut_patch.h"
#include "tests/mesh/spatial/trial_sheets.h"
#include "tests/support/make_model.h"
#include "tests/support/whole_model.h"

namespace prismesh::mesh::spatial {
namespace {

using test::all_shells;
using test::grid_node;
using test::make_grid;
using test::make_model;
using test::noise;

constexpr double kPiValue = 3.14159265358979323846;

/// Where node (i, j) of a grid of unit squares stands in the plane, moved by up to `jitter` in each direction.
std::array<double, 2> jittered(int i, int j, double jitter) { return {i + jitter * noise(i, j, 1), j + jitter * noise(i, j, 2)}; }

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
  EXPECT_GT(count, 10u);
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

/// A surface z = f(x, y) with its slopes, and geodesics on it by integration of their equation.
struct Graph {
  std::function<double(double, double)> z;
  std::function<std::array<double, 2>(double, double)> slope;      ///< f_x, f_y
  std::function<std::array<double, 3>(double, double)> curvature;  ///< f_xx, f_xy, f_yy

  using State = Eigen::Vector4d;  ///< x, y, dx/ds, dy/ds

  State rate(const State& at) const {
    const auto [p, q] = slope(at[0], at[1]);
    const auto [r, m, t] = curvature(at[0], at[1]);
    const double bend = (r * at[2] * at[2] + 2 * m * at[2] * at[3] + t * at[3] * at[3]) / (1 + p * p + q * q);
    return {at[2], at[3], -p * bend, -q * bend};
  }

  /// Where a geodesic from (x, y) in the direction `angle` (in the tangent plane's shadow) is after a length.
  std::array<double, 2> shoot(double x, double y, double angle, double length) const {
    const auto [p, q] = slope(x, y);
    const double climb = p * std::cos(angle) + q * std::sin(angle);
    const double shadow = 1 / std::sqrt(1 + climb * climb);
    State at(x, y, shadow * std::cos(angle), shadow * std::sin(angle));
    constexpr int kSteps = 24;
    const double h = length / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const State a = rate(at);
      const State b = rate(at + 0.5 * h * a);
      const State c = rate(at + 0.5 * h * b);
      const State d = rate(at + h * c);
      at += h / 6 * (a + 2 * b + 2 * c + d);
    }
    return {at[0], at[1]};
  }

  /// The length of the geodesic between two points, by Newton's method from the straight line.
  double distance(double x0, double y0, double x1, double y1) const {
    double angle = std::atan2(y1 - y0, x1 - x0);
    double length = std::hypot(x1 - x0, y1 - y0, z(x1, y1) - z(x0, y0));
    if (length == 0) return 0;
    for (int i = 0; i < 8; ++i) {
      const auto at = shoot(x0, y0, angle, length);
      const auto turned = shoot(x0, y0, angle + 1e-6, length);
      const auto longer = shoot(x0, y0, angle, length + 1e-6);
      Eigen::Matrix2d slopes;
      slopes << (turned[0] - at[0]) / 1e-6, (longer[0] - at[0]) / 1e-6, (turned[1] - at[1]) / 1e-6, (longer[1] - at[1]) / 1e-6;
      const Eigen::Vector2d step = slopes.inverse() * Eigen::Vector2d(x1 - at[0], y1 - at[1]);
      angle += step[0];
      length += step[1];
    }
    return length;
  }
};

void expect_distances_on(const Graph& graph) {
  const Model model = make_grid(40, 40, [&](int i, int j) {
    const auto [x, y] = jittered(i, j, 0.3);
    return Vec3(x - 20, y - 20, graph.z(x - 20, y - 20));
  });
  for (const NodeIndex source : {grid_node(40, 20, 20), grid_node(40, 13, 24)}) {
    const Vec3 from = model.position(source);
    const Errors errors = compare(model, source, 14, [&](NodeIndex n) {
      const Vec3& to = model.position(n);
      if ((to - from).norm() > 15) return 1e9;
      return graph.distance(from.x(), from.y(), to.x(), to.y());
    });
    expect_within_aim(errors);
  }
}

TEST(Geodesic, crosses_a_saddle) {
  constexpr double kR = 40;
  expect_distances_on({[](double x, double y) { return (x * x - y * y) / (2 * kR); },
                       [](double x, double y) {
                         return std::array{x / kR, -y / kR};
                       },
                       [](double, double) {
                         return std::array{1 / kR, 0.0, -1 / kR};
                       }});
}

TEST(Geodesic, crosses_a_beaded_panel) {
  constexpr double kA = 0.8, kW = 0.35;
  expect_distances_on({[](double x, double y) { return kA * std::sin(kW * x) * std::cos(kW * y); },
                       [](double x, double y) {
                         return std::array{kA * kW * std::cos(kW * x) * std::cos(kW * y), -kA * kW * std::sin(kW * x) * std::sin(kW * y)};
                       },
                       [](double x, double y) {
                         const double zz = -kA * kW * kW * std::sin(kW * x) * std::cos(kW * y);
                         return std::array{zz, -kA * kW * kW * std::cos(kW * x) * std::sin(kW * y), zz};
                       }});
}

using Point = Eigen::Vector2d;

/// Whether the straight path between two points keeps out of a convex polygon (counter-clockwise).
bool keeps_out(const std::vector<Point>& polygon, const Point& a, const Point& b) {
  double enter = 0;
  double leave = 1;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point side = polygon[(i + 1) % polygon.size()] - polygon[i];
    const Point inward(-side.y(), side.x());
    const double at_a = inward.dot(a - polygon[i]) - 1e-9 * side.squaredNorm();
    const double at_b = inward.dot(b - polygon[i]) - 1e-9 * side.squaredNorm();
    if (at_a <= 0 && at_b <= 0) return true;
    if (at_a < 0) enter = std::max(enter, at_a / (at_a - at_b));
    if (at_b < 0) leave = std::min(leave, at_a / (at_a - at_b));
  }
  return enter >= leave;
}

/// The shortest path around a convex hole: straight pieces between its corners.
double around_hole(const std::vector<Point>& hole, const Point& from, const Point& to) {
  if (keeps_out(hole, from, to)) return (to - from).norm();
  std::vector<double> reached(hole.size(), kUnreached);
  for (std::size_t i = 0; i < hole.size(); ++i)
    if (keeps_out(hole, from, hole[i])) reached[i] = (hole[i] - from).norm();
  for (std::size_t round = 0; round < hole.size(); ++round)
    for (std::size_t i = 0; i < hole.size(); ++i) {
      const std::size_t next = (i + 1) % hole.size();
      const double side = (hole[i] - hole[next]).norm();
      reached[next] = std::min(reached[next], reached[i] + side);
      reached[i] = std::min(reached[i], reached[next] + side);
    }
  double shortest = kUnreached;
  for (std::size_t i = 0; i < hole.size(); ++i)
    if (keeps_out(hole, hole[i], to)) shortest = std::min(shortest, reached[i] + (to - hole[i]).norm());
  return shortest;
}

TEST(Geodesic, goes_around_a_square_hole) {
  const auto in_hole = [](int i, int j) { return i >= 20 && i < 32 && j >= 15 && j < 35; };
  const Model model = make_grid(
      50, 50,
      [&](int i, int j) {
        const bool on_hole = i >= 19 && i <= 33 && j >= 14 && j <= 36;
        const auto [x, y] = jittered(i, j, on_hole ? 0.0 : 0.3);
        return Vec3(x, y, 0);
      },
      [&](int i, int j) { return !in_hole(i, j); });
  const std::vector<Point> hole{{20, 15}, {32, 15}, {32, 35}, {20, 35}};
  const NodeIndex source = grid_node(50, 8, 22);
  const Errors errors = compare(
      model, source, 50, [&](NodeIndex n) { return around_hole(hole, model.position(source).head<2>(), model.position(n).head<2>()); });
  EXPECT_LE(errors.mean, 0.0005);
  EXPECT_LE(errors.max, 0.005);
}

/// Errors around a hole of `around` nodes in a plate of rings of squares, from a node of a ring.
Errors errors_around_hole(int around, int rings, int source_ring) {
  const auto place = [&](int ring, int k) {
    const double angle = 2 * kPiValue * (k + (ring == 0 ? 0.0 : 0.25 * noise(ring, k % around, 3))) / around;
    const double r = 8 * std::pow(1 + 2 * kPiValue / around, ring);
    return Vec3(r * std::cos(angle), r * std::sin(angle), 0);
  };
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int ring = 0; ring <= rings; ++ring)
    for (int k = 0; k < around; ++k) nodes.push_back({1 + k + ring * around, place(ring, k)});
  for (int ring = 0; ring < rings; ++ring)
    for (int k = 0; k < around; ++k) {
      const int a = 1 + k + ring * around;
      const int b = 1 + (k + 1) % around + ring * around;
      shells.push_back({a, 1, {a, b, b + around, a + around}});
    }
  const Model model = make_model(nodes, shells);
  std::vector<Point> hole;
  for (int k = 0; k < around; ++k) hole.push_back(place(0, k).head<2>());
  const NodeIndex source(static_cast<std::size_t>(source_ring * around));
  return compare(model, source, 40,
                 [&](NodeIndex n) { return around_hole(hole, model.position(source).head<2>(), model.position(n).head<2>()); });
}

TEST(Geodesic, goes_around_a_round_hole) {
  for (const int ring : {0, 2, 5}) expect_within_aim(errors_around_hole(48, 12, ring));
}

TEST(Geodesic, goes_around_coarse_holes) {
  for (const int around : {8, 12, 16})
    for (const int ring : {0, 1, 2}) {
      SCOPED_TRACE(testing::Message() << around << " nodes, ring " << ring);
      expect_within_aim(errors_around_hole(around, 8, ring));
    }
}

std::vector<double> distances(const Model& model, std::vector<std::uint32_t> sources, double radius = kUnreached) {
  return geodesic_distance(cut_patch(model, all_shells(model)), sources, radius);
}

Model wavy_grid() {
  return make_grid(30, 30, [](int i, int j) {
    const auto [x, y] = jittered(i, j, 0.3);
    return Vec3(x, y, 2 * std::sin(x / 4) + std::cos(y / 3));
  });
}

TEST(Geodesic, takes_the_nearest_of_many_sources) {
  const Model model = wavy_grid();
  const std::vector<std::uint32_t> sources{5, 400, 777, 777, 99999};
  const std::vector<double> all = distances(model, sources);
  const std::vector<double> a = distances(model, {5});
  const std::vector<double> b = distances(model, {400});
  const std::vector<double> c = distances(model, {777});
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double nearest = std::min({a[i], b[i], c[i]});
    EXPECT_NEAR(all[i], nearest, 0.01 * 20);
    EXPECT_LE(all[i], nearest + 1e-9);
  }
  for (const std::uint32_t source : {5u, 400u, 777u}) EXPECT_EQ(all[source], 0);
}

TEST(Geodesic, is_even_from_a_straight_row_of_sources) {
  const Model model = make_grid(12, 40, [](int i, int j) { return Vec3(i, j, 0); });
  std::vector<std::uint32_t> row(13);
  std::iota(row.begin(), row.end(), 0u);
  const std::vector<double> distance = distances(model, row);
  for (int j = 0; j <= 40; ++j)
    for (int i = 0; i <= 12; ++i) EXPECT_NEAR(distance[grid_node(12, i, j).value], j, 1e-9);
}

TEST(Geodesic, is_the_same_there_and_back) {
  const Model model = wavy_grid();
  const std::vector<std::uint32_t> some{0, 17, 200, 480, 650, 960};
  std::vector<std::vector<double>> from;
  for (const std::uint32_t source : some) from.push_back(distances(model, {source}));
  for (std::size_t a = 0; a < some.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) EXPECT_NEAR(from[a][some[b]] / from[b][some[a]], 1, 0.003);
}

TEST(Geodesic, does_not_change_under_rigid_motion_and_scales) {
  const Model model = wavy_grid();
  Model moved = model;
  const Eigen::AngleAxisd turn(1.1, Vec3(3, -1, 2).normalized());
  for (std::size_t i = 0; i < model.node_count(); ++i) moved.positions.set(i, 1000 * (turn * model.positions[i]) + Vec3(5e3, -2e3, 1e3));
  const std::vector<double> a = distances(model, {300});
  const std::vector<double> b = distances(moved, {300});
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(1000 * a[i], b[i], 1e-6);
}

TEST(Geodesic, is_never_shorter_than_straight_nor_longer_than_the_edges) {
  const Model model = wavy_grid();
  const std::vector<double> distance = distances(model, {480});
  for (std::size_t i = 0; i < distance.size(); ++i) {
    EXPECT_GE(distance[i] * (1 + 1e-9), (model.positions[i] - model.positions[480]).norm());
    for (const ShellIndex shell : model.adjacency->shells_of(NodeIndex(i)))
      for (const NodeIndex other : model.shell(shell).node)
        EXPECT_LE(distance[i], distance[other.value] + (model.positions[i] - model.position(other)).norm() + 1e-9);
  }
}

TEST(Geodesic, ends_at_the_radius) {
  const Model model = wavy_grid();
  const std::vector<double> all = distances(model, {480});
  const std::vector<double> near = distances(model, {480}, 9);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(near[i], all[i] <= 9 ? all[i] : kUnreached);
}

TEST(Geodesic, does_not_reach_other_pieces) {
  const Model model = make_grid(
      9, 3, [](int i, int j) { return Vec3(i, j, 0); }, [](int i, int) { return i != 4; });
  const std::vector<double> distance = distances(model, {0});
  EXPECT_EQ(distance[grid_node(9, 4, 2).value], std::hypot(4.0, 2.0));
  EXPECT_EQ(distance[grid_node(9, 5, 0).value], kUnreached);
  EXPECT_EQ(distances(model, {}), std::vector<double>(40, kUnreached));
}

TEST(Geodesic, spreads_over_every_sheet_at_a_junction) {
  // three sheets of 6 x 10 squares meet along x = y = 0
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int j = 0; j <= 10; ++j) nodes.push_back({1 + j, Vec3(0, 0, j)});
  for (int sheet = 0; sheet < 3; ++sheet) {
    const double angle = 2 * kPiValue * sheet / 3;
    const int base = 100 + 100 * sheet;
    const auto id = [&](int i, int j) { return i == 0 ? 1 + j : base + i + 7 * j; };
    for (int j = 0; j <= 10; ++j)
      for (int i = 1; i <= 6; ++i) nodes.push_back({id(i, j), Vec3(i * std::cos(angle), i * std::sin(angle), j)});
    for (int j = 0; j < 10; ++j)
      for (int i = 0; i < 6; ++i) shells.push_back({base + i + 7 * j, sheet + 1, {id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)}});
  }
  const Model model = make_model(nodes, shells);
  const NodeIndex source = model.find_node(100 + 4 + 7 * 2);
  const std::vector<double> distance = distances(model, {source.value});
  for (int sheet = 1; sheet < 3; ++sheet)
    for (int j = 0; j <= 10; ++j)
      for (int i = 1; i <= 6; ++i) {
        const NodeIndex node = model.find_node(100 + 100 * sheet + i + 7 * j);
        EXPECT_NEAR(distance[node.value], std::hypot(4 + i, j - 2), 1e-9);
      }
}

TEST(Geodesic, crosses_from_quads_to_triangles_and_degenerate_shells) {
  // a band of triangles between quads, and a quad whose second node is named twice
  const Model model = make_model({{1, {0, 0, 0}},
                                  {2, {1, 0, 0}},
                                  {3, {1, 1, 0}},
                                  {4, {0, 1, 0}},
                                  {5, {2, 0, 0}},
                                  {6, {2, 1, 0}},
                                  {7, {3, 0, 0}},
                                  {8, {3, 1, 0}},
                                  {9, {4, 0.5, 0}}},
                                 {{1, 1, {1, 2, 3, 4}}, {2, 1, {2, 5, 3}}, {3, 1, {5, 6, 3}}, {4, 1, {5, 7, 8, 6}}, {5, 1, {7, 7, 9, 8}}});
  const std::vector<double> distance = distances(model, {0});
  for (std::size_t i = 0; i < distance.size(); ++i) EXPECT_NEAR(distance[i], model.positions[i].norm(), 1e-12) << i;
}

TEST(Geodesic, survives_shells_without_area) {
  const Model model = make_model({{1, {0, 0, 0}}, {2, {1, 0, 0}}, {3, {2, 0, 0}}, {4, {3, 0, 0}}, {5, {3, 0, 0}}, {6, {3, 0, 0}}},
                                 {{1, 1, {1, 2, 3, 4}}, {2, 1, {4, 5, 6}}});
  const std::vector<double> distance = distances(model, {0});
  EXPECT_EQ(distance, (std::vector<double>{0, 1, 2, 3, 3, 3}));
}

TEST(PatchBetween, keeps_what_lies_between_the_chosen_nodes) {
  const Model model = make_grid(4, 4, [](int i, int j) { return Vec3(i, j, 0); });
  // an L of three nodes of one square, a node two squares off, and one alone
  const NodeSet nodes{grid_node(4, 0, 0), grid_node(4, 1, 0), grid_node(4, 2, 0), grid_node(4, 1, 1), grid_node(4, 4, 4)};
  const Patch patch = cut_patch_between(model, nodes);
  EXPECT_EQ(patch.nodes, nodes);
  EXPECT_EQ(patch.rim, (std::vector<std::uint8_t>(5, 1)));
  const std::vector<double> distance = geodesic_distance(patch, std::vector<std::uint32_t>{0});
  EXPECT_EQ(distance, (std::vector<double>{0, 1, 2, std::sqrt(2.0), kUnreached}));
}

TEST(PatchBetween, finds_its_numbers_in_wide_and_narrow_ranges_of_nodes) {
  const Model model = make_grid(200, 200, [](int i, int j) { return Vec3(i, j, 0); });
  // two far corners of the model: too few nodes for a table over everything between
  const NodeSet far{grid_node(200, 0, 0), grid_node(200, 1, 0), grid_node(200, 199, 200), grid_node(200, 200, 200)};
  const std::vector<double> distance = geodesic_distance(cut_patch_between(model, far), std::vector<std::uint32_t>{0, 3});
  EXPECT_EQ(distance, (std::vector<double>{0, 1, 1, 0}));
  EXPECT_TRUE(cut_patch_between(model, {}).nodes.empty());
}

}  // namespace
}  // namespace prismesh::mesh::spatial
