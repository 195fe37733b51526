#include "mesh/select/visible.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "base/deterministic_math.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/open.h"
#include "tests/support/make_model.h"
#include "tests/support/whole_model.h"

namespace prismesh::mesh::select {
namespace {

using test::all_nodes;

using View = std::array<double, 16>;

View as_array(const Eigen::Matrix4d& matrix) {
  View view;
  Eigen::Map<Eigen::Matrix4d>(view.data()) = matrix;
  return view;
}

/// Rows of an orthonormal frame that looks from `eye` to `at`, as a matrix.
Eigen::Matrix4d looking(const Vec3& eye, const Vec3& at) {
  const Vec3 back = (eye - at).normalized();
  const Vec3 right = (std::abs(back.z()) < 0.9 ? Vec3::UnitZ() : Vec3::UnitX()).cross(back).normalized();
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.row(0).head<3>() = right;
  matrix.row(1).head<3>() = back.cross(right);
  matrix.row(2).head<3>() = back;
  matrix.col(3).head<3>() = -matrix.topLeftCorner<3, 3>() * eye;
  return matrix;
}

View perspective(const Vec3& eye, const Vec3& at, double near_plane, double far_plane, double slope = 1) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
  matrix(0, 0) = matrix(1, 1) = 1 / slope;
  matrix(2, 2) = -(far_plane + near_plane) / (far_plane - near_plane);
  matrix(2, 3) = -2 * far_plane * near_plane / (far_plane - near_plane);
  matrix(3, 2) = -1;
  return as_array(matrix * looking(eye, at));
}

View orthographic(const Vec3& eye, const Vec3& at, double half_width, double depth) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix(0, 0) = matrix(1, 1) = 1 / half_width;
  matrix(2, 2) = -2 / depth;
  matrix(2, 3) = -1;
  return as_array(matrix * looking(eye, at));
}

// --- the oracle: a ray in the deck's space for every node, against every triangle ---

/// Where the segment a + s (b - a) meets a triangle; negative: nowhere. Möller and Trumbore, "Fast, minimum storage ray/triangle
/// intersection", 1997.
double meets(const Vec3& a, const Vec3& b, const Vec3& t0, const Vec3& t1, const Vec3& t2) {
  const Vec3 ray = b - a, side_1 = t1 - t0, side_2 = t2 - t0;
  const Vec3 p = ray.cross(side_2);
  const double determinant = side_1.dot(p);
  if (determinant == 0) return -1;
  const Vec3 from = a - t0;
  const double u = from.dot(p) / determinant;
  const Vec3 q = from.cross(side_1);
  const double v = ray.dot(q) / determinant;
  if (u < 0 || v < 0 || u + v > 1) return -1;
  const double s = side_2.dot(q) / determinant;
  return s <= 1 ? s : -1;
}

/// Least distance of a point from a triangle by trying many of the triangle's points, ever finer around the best.
double distance_by_search(const Vec3& point, const Vec3& t0, const Vec3& t1, const Vec3& t2) {
  double best = 1e300, best_u = 1.0 / 3, best_v = 1.0 / 3, width = 0.5;
  for (int round = 0; round < 30; ++round, width *= 0.6) {
    const double middle_u = best_u, middle_v = best_v;
    for (int i = -4; i <= 4; ++i)
      for (int j = -4; j <= 4; ++j) {
        const double u = std::clamp(middle_u + width * i / 4, 0.0, 1.0), v = std::clamp(middle_v + width * j / 4, 0.0, 1.0 - u);
        const double distance = (t0 + u * (t1 - t0) + v * (t2 - t0) - point).norm();
        if (distance < best) best = distance, best_u = u, best_v = v;
      }
  }
  return best;
}

NodeSet visible_by_brute_force(const Model& model, const View& view, const std::vector<std::uint8_t>& out_of_sight = {}) {
  const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix4d>(view.data());
  const Eigen::Matrix4d back = matrix.inverse();
  NodeSet nodes;
  for (std::size_t n = 0; n < model.node_count(); ++n) {
    const Vec3& place = model.positions[n];
    const Eigen::Vector4d clip = matrix * place.homogeneous();
    const Vec3 seen = clip.head<3>() / clip.w();
    if (clip.w() <= 0 || std::abs(seen.z()) > 1) continue;
    const Vec3 start = (back * Eigen::Vector4d(seen.x(), seen.y(), -1, 1)).hnormalized();
    bool hidden = false;
    for (std::size_t s = 0; s < model.shell_count() && !hidden; ++s) {
      const ShellNodes& shell = model.shell_nodes[s];
      if (std::find(shell.node.begin(), shell.node.end(), NodeIndex(n)) != shell.node.end()) continue;
      if (!out_of_sight.empty() && out_of_sight[model.shell_parts[s].value] != 0) continue;
      std::array<Vec3, 4> at;
      for (std::size_t k = 0; k < 4; ++k) at[k] = model.position(shell.node[k]);
      if (meets(start, place, at[0], at[1], at[2]) < 0 && meets(start, place, at[0], at[2], at[3]) < 0) continue;
      double longest = 0;
      for (std::size_t k = 0; k < 4; ++k) longest = std::max(longest, (at[k] - at[(k + 1) % 4]).norm());
      hidden = distance_by_search(place, at[0], at[1], at[2]) > 1e-3 * longest &&
               distance_by_search(place, at[0], at[2], at[3]) > 1e-3 * longest;
    }
    if (!hidden) nodes.emplace_back(n);
  }
  return nodes;
}

/// Compares, and returns how many are visible.
std::size_t expect_as_by_brute_force(const Model& model, const View& view, const std::vector<std::uint8_t>& out_of_sight = {}) {
  const Result<NodeSet> visible = visible_nodes(model, view, all_nodes(model), out_of_sight);
  EXPECT_TRUE(visible.has_value());
  if (!visible) return 0;
  const NodeSet expected = visible_by_brute_force(model, view, out_of_sight);
  EXPECT_EQ(*visible, expected);
  return expected.size();
}

// --- models ---

/// A ball of radius 10 with a smaller, off-centre one inside.
Model two_balls() {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int ball = 0; ball < 2; ++ball) {
    const double radius = ball == 0 ? 10 : 6;
    const std::int64_t first = static_cast<std::int64_t>(nodes.size()) + 1;
    constexpr int kRound = 24, kUp = 15;
    for (int j = 0; j <= kUp; ++j)
      for (int i = 0; i < kRound; ++i) {
        const double a = 15.0 * i + 0.3 * j, b = 12.0 * j;
        nodes.push_back({static_cast<std::int64_t>(nodes.size()) + 1,
                         radius * Vec3(deterministic_cos_degrees(a) * deterministic_sin_degrees(b),
                                       deterministic_sin_degrees(a) * deterministic_sin_degrees(b), deterministic_cos_degrees(b)) +
                             Vec3(ball, 0, 0)});
      }
    for (int j = 0; j < kUp; ++j)
      for (int i = 0; i < kRound; ++i) {
        const auto at = [&](int k, int l) { return first + l * kRound + k % kRound; };
        shells.push_back(
            {static_cast<std::int64_t>(shells.size()) + 1, ball + 1, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}});
      }
  }
  return test::make_model(nodes, shells);
}

/// A floor with a web standing on it, joined along the floor's middle.
Model t_junction() {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  const auto floor_id = [](int i, int j) { return std::int64_t{1 + i + 9 * j}; };
  const auto web_id = [&](int i, int k) { return k == 0 ? floor_id(i, 4) : std::int64_t{1000 + i + 9 * k}; };
  for (int j = 0; j <= 8; ++j)
    for (int i = 0; i <= 8; ++i) nodes.push_back({floor_id(i, j), Vec3(i, j, 0)});
  for (int k = 1; k <= 4; ++k)
    for (int i = 0; i <= 8; ++i) nodes.push_back({web_id(i, k), Vec3(i, 4, k)});
  for (int j = 0; j < 8; ++j)
    for (int i = 0; i < 8; ++i)
      shells.push_back({1 + i + 8 * j, 1, {floor_id(i, j), floor_id(i + 1, j), floor_id(i + 1, j + 1), floor_id(i, j + 1)}});
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < 8; ++i)
      shells.push_back({1000 + i + 8 * k, 2, {web_id(i, k), web_id(i + 1, k), web_id(i + 1, k + 1), web_id(i, k + 1)}});
  return test::make_model(nodes, shells);
}

/// Two sheets of 6 x 6 shells at z = 0 and z = gap, the upper one with a mesh shifted by a third.
Model two_sheets(double gap) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int sheet = 0; sheet < 2; ++sheet) {
    const std::int64_t first = static_cast<std::int64_t>(nodes.size()) + 1;
    for (int j = 0; j <= 6; ++j)
      for (int i = 0; i <= 6; ++i)
        nodes.push_back({static_cast<std::int64_t>(nodes.size()) + 1, Vec3(i + sheet / 3.0, j + sheet / 3.0, sheet * gap)});
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i) {
        const std::int64_t corner = first + i + 7 * j;
        shells.push_back({static_cast<std::int64_t>(shells.size()) + 1, sheet + 1, {corner, corner + 1, corner + 8, corner + 7}});
      }
  }
  return test::make_model(nodes, shells);
}

/// Eyes in all directions that meet nothing by chance.
std::vector<Vec3> eyes(int count, double distance) {
  std::mt19937 random(3);
  const auto coordinate = [&] { return static_cast<double>(random() % 2000003) / 1000001.5 - 1; };
  std::vector<Vec3> all;
  while (static_cast<int>(all.size()) < count) {
    const Vec3 direction(coordinate(), coordinate(), coordinate());
    if (direction.norm() > 0.3) all.emplace_back(distance * direction.normalized());
  }
  return all;
}

// --- tests ---

TEST(Visible, on_a_ball_ends_where_the_tangents_from_the_eye_touch_it) {
  // one ball alone: a node is seen if its facets aren't all turned away; nodes well clear of the tangent circle have an analytic answer
  const Model model = two_balls();
  const Vec3 eye(40, 17, 23);
  const std::vector<std::uint8_t> inner_hidden{0, 1};
  const NodeSet visible = visible_nodes(model, perspective(eye, Vec3::Zero(), 1, 200), all_nodes(model), inner_hidden).value();
  std::size_t clear = 0;
  for (std::size_t i = 0; i < 24 * 16; ++i) {
    const Vec3& p = model.positions[i];
    const double turned = p.dot(eye - p) / (p.norm() * (eye - p).norm());
    if (std::abs(turned) < 0.3) continue;  // within an element of the silhouette
    ++clear;
    EXPECT_EQ(std::binary_search(visible.begin(), visible.end(), NodeIndex(i)), turned > 0) << i;
  }
  EXPECT_GT(clear, 200u);
}

TEST(Visible, agrees_with_rays_on_balls_from_everywhere) {
  const Model model = two_balls();
  for (const Vec3& eye : eyes(6, 40)) {
    const std::size_t seen = expect_as_by_brute_force(model, perspective(eye, Vec3::Zero(), 1, 200));
    EXPECT_GT(seen, 100u);
    EXPECT_LT(seen, 300u);
    expect_as_by_brute_force(model, orthographic(eye, Vec3::Zero(), 15, 200));
    expect_as_by_brute_force(model, perspective(eye, Vec3::Zero(), 1, 200), {1, 0});
  }
}

TEST(Visible, agrees_with_rays_where_the_near_plane_cuts) {
  // the eye inside the outer ball or close to its skin; the near plane slices shells and opens the view inside
  const Model model = two_balls();
  for (const Vec3& eye : eyes(5, 8.5)) {
    EXPECT_GT(expect_as_by_brute_force(model, perspective(eye, Vec3::Zero(), 0.05, 100, 3)), 0u);
    EXPECT_GT(expect_as_by_brute_force(model, perspective(2 * eye, Vec3::Zero(), 9, 24)), 0u);
    EXPECT_GT(expect_as_by_brute_force(model, orthographic(eye, Vec3::Zero(), 12, 12)), 0u);
  }
}

TEST(Visible, agrees_with_rays_at_a_t_junction) {
  const Model model = t_junction();
  for (const Vec3& eye : eyes(12, 30)) {
    const Vec3 middle(4.1, 4.2, 1.3);
    expect_as_by_brute_force(model, perspective(middle + eye, middle, 1, 100));
    expect_as_by_brute_force(model, orthographic(middle + eye, middle, 10, 100));
  }
}

TEST(Visible, of_two_parallel_sheets_the_far_one_shows_beside_the_near_one_only) {
  const Model model = two_sheets(0.5);
  const NodeSet above = visible_nodes(model, orthographic(Vec3(3, 3, 50), Vec3(3, 3, 0), 10, 100), all_nodes(model), {}).value();
  // of the lower sheet the two borders that the shift leaves open: the nodes with i = 0 or j = 0
  EXPECT_EQ(above.size(), 49u + 13u);
  for (const Vec3& eye : eyes(8, 30)) expect_as_by_brute_force(model, perspective(Vec3(3, 3, 0) + eye, Vec3(3.2, 3.1, 0), 1, 100));
}

TEST(Visible, coincident_sheets_do_not_hide_each_other) {
  for (const double gap : {0.0, 1e-12, -1e-9, 0.0005}) {
    const Model model = two_sheets(gap);
    EXPECT_EQ(visible_nodes(model, orthographic(Vec3(3, 3, 50), Vec3(3, 3, 0), 10, 100), all_nodes(model), {}).value().size(), 98u) << gap;
  }
  // beyond a thousandth of an edge they are two sheets
  EXPECT_EQ(visible_nodes(two_sheets(0.002), orthographic(Vec3(3, 3, 50), Vec3(3, 3, 0), 10, 100), all_nodes(two_sheets(0.002)), {})
                .value()
                .size(),
            62u);
}

TEST(Visible, tolerance_scales_with_the_elements) {
  for (const double scale : {1e-3, 1e4}) {
    Model model = two_sheets(0.002);
    for (std::size_t i = 0; i < model.node_count(); ++i) model.positions.set(i, scale * model.positions[i]);
    const View view = orthographic(scale * Vec3(3, 3, 50), scale * Vec3(3, 3, 0), 10 * scale, 100 * scale);
    EXPECT_EQ(visible_nodes(model, view, all_nodes(model), {}).value().size(), 62u) << scale;
  }
}

TEST(Visible, through_a_ray_along_a_shared_side_nothing_shows) {
  // the eye, a node of the far sheet and a side of the near one in one plane, exactly
  std::vector<Vec3> points;
  for (int j = 0; j <= 2; ++j)
    for (int i = 0; i <= 2; ++i) points.emplace_back(i, j, 2);
  for (const Vec3& far : {Vec3(1, 0.5, 0), Vec3(1, 1, 0), Vec3(0.5, 0.5, 0), Vec3(1.5, 1, 0)}) points.push_back(far);
  const Model model = test::make_shells(points, {{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}, {4, 5, 8, 7}});
  const NodeSet visible = visible_nodes(model, orthographic(Vec3(1, 1, 9), Vec3(1, 1, 0), 4, 20), all_nodes(model), {}).value();
  EXPECT_EQ(visible.size(), 9u);
}

TEST(Visible, leaves_out_what_is_beyond_the_planes_and_needs_depth) {
  const Model model = test::make_model({{1, {0, 0, 0}}, {2, {0.1, 0, -5}}, {3, {0.2, 0, 5}}}, {});
  EXPECT_EQ(visible_nodes(model, orthographic(Vec3(0, 0, 2), Vec3(0, 0, 0), 4, 4), all_nodes(model), {}).value(), (NodeSet{NodeIndex(0)}));
  EXPECT_TRUE(visible_nodes(model, orthographic(Vec3(0, 0, 2), Vec3(0, 0, 0), 4, 4), {}, {}).value().empty());
  const View flat{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
  const Result<NodeSet> refused = visible_nodes(model, flat, all_nodes(model), {});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("the view keeps no depth"), std::string::npos);
}

TEST(Visible, a_sheet_hides_in_a_large_model_too) {
  // a quad over four nodes, and thousands of others far to its left
  std::vector<Vec3> points{{-3, -3, 1}, {3, -3, 1}, {3, 3, 1}, {-3, 3, 1}, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  points.resize(2 * kChunkSize, Vec3(-9, 0, 0));
  const Model model = test::make_shells(points, {{0, 1, 2, 3}});
  const NodeSet below{NodeIndex(4), NodeIndex(5), NodeIndex(6), NodeIndex(7)};
  EXPECT_TRUE(visible_nodes(model, orthographic(Vec3(0, 0, 2), Vec3(0, 0, 0), 10, 4), below, {}).value().empty());
  const std::vector<std::uint8_t> hidden{1};
  EXPECT_EQ(visible_nodes(model, orthographic(Vec3(0, 0, 2), Vec3(0, 0, 0), 10, 4), below, hidden).value(), below);
}

TEST(Visible, mid_side_nodes_are_not_hidden_by_their_own_shells) {
  // one quad seen from above, its mid-side nodes sagging below it
  std::vector<Vec3> points{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 0.1, -0.2}, {1.9, 1, -0.2}, {1, 1.9, -0.2}, {0.1, 1, -0.2}};
  Model model = test::make_shells(points, {{0, 1, 2, 3}});
  const View view = orthographic(Vec3(1, 1, 9), Vec3(1, 1, 0), 4, 20);
  EXPECT_EQ(visible_nodes(model, view, all_nodes(model), {}).value().size(), 4u);
  auto midside = std::make_shared<std::vector<MidsideNodes>>();
  midside->push_back({ShellIndex(0), {NodeIndex(4), NodeIndex(5), NodeIndex(6), NodeIndex(7)}});
  model.midside = midside;
  EXPECT_EQ(visible_nodes(model, view, all_nodes(model), {}).value().size(), 8u);
}

TEST(Visible, agrees_with_rays_on_real_decks) {
  const char* models = std::getenv("PRISMESH_MODELS");
  if (models == nullptr) GTEST_SKIP() << "PRISMESH_MODELS isn't set";
  for (const char* file : {"gsa_car6_comma/car6_crash.k", "simplecar_nas/full_car.nas"}) {
    const Result<deck::OpenedDeck> opened = deck::open(std::string(models) + "/" + file);
    ASSERT_TRUE(opened) << file;
    const Model& model = opened->model;
    Vec3 low = model.positions[0], high = low;
    for (std::size_t i = 0; i < model.node_count(); ++i) low = low.cwiseMin(model.positions[i]), high = high.cwiseMax(model.positions[i]);
    const Vec3 middle = 0.5 * (low + high);
    const double size = (high - low).norm();
    const Vec3 eye = middle + size * Vec3(0.813, -0.637, 0.471);
    const std::size_t seen = expect_as_by_brute_force(model, perspective(eye, middle, 0.1 * size, 4 * size));
    EXPECT_GT(seen, model.node_count() / 20) << file;
    EXPECT_LT(seen, model.node_count()) << file;
  }
}

}  // namespace
}  // namespace prismesh::mesh::select
