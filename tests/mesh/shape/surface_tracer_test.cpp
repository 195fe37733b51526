#include "mesh/shape/surface_tracer.h"

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/shape/normals.h"
#include "mesh/spatial/closest_point.h"
#include "tests/support/make_model.h"
#include "tests/support/whole_model.h"

namespace prismesh::mesh::shape {
namespace {

using test::all_nodes;
using test::all_shells;

/// All nodes slid as `by` leads at `grab`.
std::vector<Vec3> slid(const Model& model, NodeIndex grab, const Vec3& by, std::optional<double> max_move = std::nullopt) {
  const NodeSet nodes = all_nodes(model);
  const std::vector<Vec3> normals = oriented_normals(model, nodes, grab);
  std::vector<Vec3> displacement;
  for (const Eigen::Quaterniond& turn : turns_along(model, nodes, normals, grab)) displacement.push_back(turn * by);
  std::vector<Vec3> out(nodes.size());
  SurfaceTracer(model, nodes, normals).positions(displacement, max_move, out);
  return out;
}

double farthest_off(const Model& model, const std::vector<Vec3>& positions) {
  const spatial::ShellTree tree(model, all_shells(model));
  double farthest = 0;
  for (const Vec3& position : positions) farthest = std::max(farthest, tree.closest(position)->distance);
  return farthest;
}

/// Two plates of 10 x 10 quads of 5 mm at a right angle: z = 0 up to x = 50, then x = 50 downwards. Some shells run the other way.
Model edge_of_a_box() {
  std::vector<Vec3> points;
  std::vector<std::array<int, 4>> shells;
  for (int j = 0; j <= 10; ++j)
    for (int i = 0; i <= 20; ++i) points.emplace_back(5.0 * std::min(i, 10), 5.0 * j, -5.0 * std::max(i - 10, 0));
  for (int j = 0; j < 10; ++j)
    for (int i = 0; i < 20; ++i) {
      const int a = i + 21 * j;
      if ((i * 5 + j * 3) % 7 == 0)
        shells.push_back({a, a + 21, a + 22, a + 1});
      else
        shells.push_back({a, a + 1, a + 22, a + 21});
    }
  return test::make_shells(points, shells);
}

/// The plates unrolled: how far along, across.
Vec3 rolled(double along, double across) { return Vec3(std::min(along, 50.0), across, -std::max(along - 50, 0.0)); }

TEST(Slide, on_a_plane_it_is_the_part_in_the_plane) {
  const Model model = test::make_grid(10, 10, [](int i, int j) { return Vec3(5.0 * i + 0.3 * (j % 3), 5.0 * j + 0.2 * (i % 4), 7); });
  const std::vector<Vec3> out = slid(model, test::grid_node(10, 5, 5), Vec3(3.3, -8.1, 40));
  for (int j = 3; j <= 7; ++j)
    for (int i = 3; i <= 7; ++i) {
      const NodeIndex node = test::grid_node(10, i, j);
      EXPECT_LT((out[node.value] - (model.position(node) + Vec3(3.3, -8.1, 0))).norm(), 1e-12);
    }
}

TEST(Slide, walks_round_a_crease) {
  const Model model = edge_of_a_box();
  // straight over the crease, along lines of nodes and askew; from the first plate, from the crease, and by a grab on the other plate
  for (const Vec3& by : {Vec3(17, 0, 0), Vec3(12.5, 7.3, 0), Vec3(-13.1, 4.9, 0)}) {
    const std::vector<Vec3> out = slid(model, test::grid_node(20, 5, 5), by);
    for (int j = 3; j <= 7; ++j)
      for (int i = 4; i <= 16; ++i) {
        const Vec3 expected = rolled(5.0 * i + by.x(), 5.0 * j + by.y());
        EXPECT_LT((out[test::grid_node(20, i, j).value] - expected).norm(), 1e-9) << i << ' ' << j;
      }
  }
  const std::vector<Vec3> out = slid(model, test::grid_node(20, 15, 5), Vec3(0, 2, 21));
  EXPECT_LT((out[test::grid_node(20, 13, 5).value] - rolled(65 - 21, 27)).norm(), 1e-9);
  EXPECT_LT((out[test::grid_node(20, 6, 5).value] - rolled(30 - 21, 27)).norm(), 1e-9);
}

TEST(Slide, on_a_cylinder_it_turns_the_sheet_about_its_axis) {
  constexpr int kAround = 40;
  const double angle = M_PI / kAround;  // half a turn
  const double chord = 2 * 30 * std::sin(angle / 2);
  const Model model =
      test::make_grid(kAround, 12, [&](int i, int j) { return Vec3(30 * std::cos(angle * i), 5.0 * j, 30 * std::sin(angle * i)); });
  const NodeIndex grab = test::grid_node(kAround, 20, 6);  // its tangent is -x
  const double by = 9.7;
  const std::vector<Vec3> out = slid(model, grab, Vec3(-by, 3.1, 0));
  EXPECT_LT(farthest_off(model, out), 1e-12);
  for (int j = 1; j <= 10; ++j)
    for (int i = 1; i <= 34; ++i) {
      const double facets = i + by / chord;
      const int facet = static_cast<int>(facets);
      const Vec3 a = model.position(test::grid_node(kAround, facet, j));
      const Vec3 b = model.position(test::grid_node(kAround, facet + 1, j));
      const Vec3 expected = a + (facets - facet) * (b - a) + Vec3(0, 3.1, 0);
      ASSERT_LT((out[test::grid_node(kAround, i, j).value] - expected).norm(), 1e-9) << i << ' ' << j;
    }
}

TEST(Slide, on_a_cone_it_goes_straight) {
  // in the unrolled cone a path at right angles to the generator ends at sqrt(r^2 + l^2) from the apex, one along it at r - l
  constexpr int kAround = 30;
  const double angle = M_PI / kAround;
  const auto place = [&](int i, int j) {
    const double slant = 40 + 4.0 * j;
    return Vec3(0.6 * slant * std::cos(angle * i), 0.6 * slant * std::sin(angle * i), -0.8 * slant);
  };
  const Model model = test::make_grid(kAround, 20, place);
  const NodeIndex grab = test::grid_node(kAround, 15, 8);
  const double slant = model.position(grab).norm();
  const std::vector<Vec3> round = slid(model, grab, Vec3(11.3, 0, 0));
  EXPECT_LT(farthest_off(model, round), 1e-12);
  EXPECT_NEAR(round[grab.value].norm(), std::sqrt(slant * slant + 11.3 * 11.3), 1e-9);
  const std::vector<Vec3> up = slid(model, grab, -model.position(grab).normalized() * 13.7);
  EXPECT_LT((up[grab.value] - model.position(grab) * (1 - 13.7 / slant)).norm(), 1e-9);
}

TEST(Slide, stays_on_faces_that_bend_every_way) {
  const Model model = test::make_grid(40, 40, [](int i, int j) {
    return Vec3(5.0 * i + 0.8 * std::sin(7.0 * i + j), 5.0 * j + 0.8 * std::cos(3.0 * i + 5 * j),
                12 * std::sin(i / 6.0) * std::cos(j / 7.0));
  });
  const double by = 23.7;
  for (const double way : {0.0, 1.1, 2.9, 4.4}) {
    const std::vector<Vec3> out = slid(model, test::grid_node(40, 20, 20), Vec3(by * std::cos(way), by * std::sin(way), 0));
    EXPECT_LT(farthest_off(model, out), 1e-11);
    for (int j = 10; j <= 30; ++j)
      for (int i = 10; i <= 30; ++i) {
        const NodeIndex node = test::grid_node(40, i, j);
        const double gone = (out[node.value] - model.position(node)).norm();
        EXPECT_LT(gone, by + 1e-9);
        EXPECT_GT(gone, 0.75 * by);
      }
  }
}

TEST(Slide, never_jumps_to_a_sheet_close_by) {
  // a second sheet a tenth of a millimetre beneath, tilted so that it cuts through where nodes pass
  std::vector<Vec3> points;
  std::vector<std::array<int, 4>> shells;
  for (int sheet = 0; sheet < 2; ++sheet)
    for (int j = 0; j <= 10; ++j)
      for (int i = 0; i <= 10; ++i) points.emplace_back(5.0 * i, 5.0 * j, sheet == 0 ? 0 : -0.1 + 0.004 * 5 * i);
  for (int sheet = 0; sheet < 2; ++sheet)
    for (int j = 0; j < 10; ++j)
      for (int i = 0; i < 10; ++i) {
        const int a = 121 * sheet + i + 11 * j;
        shells.push_back({a, a + 1, a + 12, a + 11});
      }
  const Model model = test::make_shells(points, shells);
  const std::vector<Vec3> out = slid(model, test::grid_node(10, 5, 5), Vec3(13, 6, 0.5));
  for (std::size_t i = 0; i < 121; ++i) EXPECT_EQ(out[i].z(), 0);
}

TEST(Slide, straight_on_where_three_sheets_meet) {
  // a plane with a rib standing on it at x = 25
  std::vector<Vec3> points;
  std::vector<std::array<int, 4>> shells;
  for (int j = 0; j <= 10; ++j)
    for (int i = 0; i <= 10; ++i) points.emplace_back(5.0 * i, 5.0 * j, 0);
  for (int j = 0; j <= 10; ++j) points.emplace_back(25, 5.0 * j, 5);
  for (int j = 0; j < 10; ++j) shells.push_back({5 + 11 * j, 5 + 11 * (j + 1), 121 + j + 1, 121 + j});
  for (int j = 0; j < 10; ++j)
    for (int i = 0; i < 10; ++i) shells.push_back({i + 11 * j, i + 1 + 11 * j, i + 12 + 11 * j, i + 11 + 11 * j});
  const Model model = test::make_shells(points, shells);
  const std::vector<Vec3> out = slid(model, test::grid_node(10, 3, 5), Vec3(14, 1, 0));
  EXPECT_LT((out[test::grid_node(10, 3, 5).value] - Vec3(29, 26, 0)).norm(), 1e-12);
  EXPECT_LT((out[test::grid_node(10, 4, 4).value] - Vec3(34, 21, 0)).norm(), 1e-12);
}

TEST(Slide, the_border_keeps_its_line_and_its_corners) {
  const Model model = test::make_grid(10, 10, [](int i, int j) { return Vec3(5.0 * i, 5.0 * j, 0); });
  const std::vector<Vec3> out = slid(model, test::grid_node(10, 5, 5), Vec3(7, 12, 0));
  const auto at = [&](int i, int j) { return out[test::grid_node(10, i, j).value]; };
  EXPECT_LT((at(4, 0) - Vec3(27, 0, 0)).norm(), 1e-12);
  EXPECT_LT((at(10, 3) - Vec3(50, 27, 0)).norm(), 1e-12);
  EXPECT_EQ(at(10, 9), Vec3(50, 50, 0));  // as far as the corner
  for (const int i : {0, 10})
    for (const int j : {0, 10}) EXPECT_EQ(at(i, j), Vec3(5.0 * i, 5.0 * j, 0));
  EXPECT_LT((at(9, 5) - Vec3(50, 25 + 12 * 5 / 7.0, 0)).norm(), 1e-9);  // a path from within ends at the border
}

TEST(Slide, the_border_goes_round_a_crease_too) {
  const std::vector<Vec3> out = slid(edge_of_a_box(), test::grid_node(20, 5, 5), Vec3(17, 3, 0));
  EXPECT_LT((out[test::grid_node(20, 8, 0).value] - rolled(57, 0)).norm(), 1e-9);
  EXPECT_LT((out[test::grid_node(20, 8, 10).value] - rolled(57, 50)).norm(), 1e-9);
}

TEST(Slide, a_limit_stops_on_the_surface) {
  const Model model = edge_of_a_box();
  const std::vector<Vec3> out = slid(model, test::grid_node(20, 5, 5), Vec3(17, 2, 0), 11.0);
  EXPECT_LT(farthest_off(model, out), 1e-12);
  for (int j = 3; j <= 7; ++j)
    for (int i = 4; i <= 16; ++i) {
      const NodeIndex node = test::grid_node(20, i, j);
      EXPECT_LT((out[node.value] - model.position(node)).norm(), 11 + 1e-12);
    }
  EXPECT_NEAR((out[test::grid_node(20, 4, 5).value] - Vec3(20, 25, 0)).norm(), 11, 1e-12);
}

TEST(Slide, a_quad_that_names_a_corner_twice_is_a_triangle) {
  // the plane's middle column: each quad cut in two, one half a triangle, the other written as a quad with its first corner twice
  std::vector<Vec3> points;
  std::vector<std::array<int, 4>> shells;
  for (int j = 0; j <= 4; ++j)
    for (int i = 0; i <= 6; ++i) points.emplace_back(5.0 * i, 5.0 * j, 0);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 6; ++i) {
      const int a = i + 7 * j;
      if (i != 3) {
        shells.push_back({a, a + 1, a + 8, a + 7});
      } else {
        shells.push_back({a, a, a + 1, a + 8});
        shells.push_back({a, a + 8, a + 7, a + 7});
      }
    }
  const Model model = test::make_shells(points, shells);
  for (const Vec3& by : {Vec3(13, 1, 0), Vec3(13, 0, 0), Vec3(12, -3, 0)}) {
    const std::vector<Vec3> out = slid(model, test::grid_node(6, 1, 2), by);
    EXPECT_LT((out[test::grid_node(6, 1, 2).value] - (Vec3(5, 10, 0) + by)).norm(), 1e-12);
    EXPECT_LT((out[test::grid_node(6, 2, 2).value] - (Vec3(10, 10, 0) + by)).norm(), 1e-12);
  }
}

TEST(Slide, nothing_is_asked_of_nodes_without_a_shell_or_of_collapsed_shells) {
  std::vector<Vec3> points{{0, 0, 0}, {5, 0, 0}, {5, 5, 0}, {0, 5, 0}, {99, 0, 0}, {10, 0, 0}, {10, 5, 0}};
  // a quad, one without area, a lone node
  const Model model = test::make_shells(points, {{0, 1, 2, 3}, {1, 1, 2, 2}, {1, 5, 6, 2}});
  const std::vector<Vec3> out = slid(model, NodeIndex(std::size_t{1}), Vec3(2, 1, 0));
  EXPECT_EQ(out[4], points[4]);
  for (const Vec3& position : out) EXPECT_TRUE(position.allFinite());
  EXPECT_LT(farthest_off(model, {out[0], out[1], out[2], out[3], out[5], out[6]}), 1e-12);
}

/// Two flat faces of 12 x 10 shells that meet in a line askew to the rows, x = 30 + y / 2: z = 0 before it, falling by 1 : 1 in x beyond.
/// From the fifth column on the rows lie 1.3 higher, so that no row leads to a node of the line.
Model slanted_roof() {
  return test::make_grid(12, 10, [](int i, int j) {
    const double y = 5.0 * j + (i >= 4 ? 1.3 : 0);
    return Vec3(5.0 * i + 0.5 * y, y, -5.0 * std::max(i - 6, 0));
  });
}

TEST(Slide, in_a_plane_it_stays_there_where_straight_on_would_leave_it) {
  const Model model = slanted_roof();
  const NodeSet nodes{test::grid_node(12, 2, 5), test::grid_node(12, 3, 5)};  // at (22.5, 25) and (27.5, 25)
  const std::vector<Vec3> by(2, Vec3(30, 0, 0));
  SurfaceTracer tracer(model, nodes, std::vector<Vec3>(2, Vec3::UnitZ()));
  tracer.keep_in_plane(Vec3::UnitY(), {1, 0});
  std::vector<Vec3> out(2);
  EXPECT_EQ(tracer.positions(by, std::nullopt, out), 0u);
  const Vec3 crossing(42.5, 25, 0);
  EXPECT_LT((out[0] - (crossing + 10 * Vec3(1, 0, -1).normalized())).norm(), 1e-9);
  // the other keeps its angle to the line in which the faces meet
  const Vec3 along = Vec3(0.5, 1, 0).normalized();
  const Vec3 down = Vec3(Vec3(-1, 0.5, -1).cross(along)).normalized();
  EXPECT_LT((out[1] - (crossing + 15 * (along.x() * along + std::sqrt(1 - along.x() * along.x()) * down))).norm(), 1e-9);
}

TEST(Slide, an_edge_out_of_the_plane_holds_its_nodes) {
  const Model model = test::make_grid(10, 10, [](int i, int j) { return Vec3(5.0 * i, 5.0 * j, 0); });
  const NodeSet nodes{test::grid_node(10, 4, 0), test::grid_node(10, 6, 0)};
  for (const auto& [normal, moves] : {std::pair(Vec3(Vec3::UnitX()), false), std::pair(Vec3(Vec3::UnitY()), true)}) {
    SurfaceTracer tracer(model, nodes, std::vector<Vec3>(2, Vec3::UnitZ()));
    tracer.keep_in_plane(normal, {1, 0});
    std::vector<Vec3> out(2);
    tracer.positions(std::vector<Vec3>(2, Vec3(7, 0, 0)), std::nullopt, out);
    EXPECT_EQ(out[0], Vec3(moves ? 27 : 20, 0, 0));
    EXPECT_EQ(out[1], Vec3(37, 0, 0)) << "it keeps to no plane";
  }
}

TEST(Slide, the_border_leads_on_over_many_nodes_both_ways) {
  const Model model = test::make_grid(10, 10, [](int i, int j) { return Vec3(5.0 * i, 5.0 * j, 0); });
  for (const double by : {12.0, -12.0}) {
    const std::vector<Vec3> out = slid(model, test::grid_node(10, 5, 5), Vec3(by, by, 0));
    for (const int far : {0, 10})
      for (int i = 3; i <= 7; ++i) {
        EXPECT_LT((out[test::grid_node(10, i, far).value] - Vec3(5.0 * i + by, 5.0 * far, 0)).norm(), 1e-12) << i;
        EXPECT_LT((out[test::grid_node(10, far, i).value] - Vec3(5.0 * far, 5.0 * i + by, 0)).norm(), 1e-12) << i;
      }
  }
}

TEST(Slide, tells_how_many_the_limit_stopped) {
  const Model model = test::make_grid(10, 10, [](int i, int j) { return Vec3(5.0 * i, 5.0 * j, 0); });
  const NodeSet nodes = all_nodes(model);
  const SurfaceTracer tracer(model, nodes, std::vector<Vec3>(nodes.size(), Vec3::UnitZ()));
  const std::vector<Vec3> by(nodes.size(), Vec3(7, 0, 0));
  std::vector<Vec3> out(nodes.size());
  EXPECT_EQ(tracer.positions(by, 3.0, out), 81u + 2 * 9) << "all inside, and those of the two edges along the way";
  for (int i = 1; i <= 9; ++i)
    for (const int j : {0, 4, 10}) {
      const NodeIndex node = test::grid_node(10, i, j);
      EXPECT_LT((out[node.value] - (model.position(node) + Vec3(3, 0, 0))).norm(), 1e-12) << i << ' ' << j;
    }
  EXPECT_EQ(tracer.positions(by, 7.001, out), 0u);
}

}  // namespace
}  // namespace prismesh::mesh::shape
