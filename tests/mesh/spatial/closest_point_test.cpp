#include "mesh/spatial/closest_point.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "mesh/model/topology_change.h"
#include "tests/support/make_model.h"
#include "tests/support/whole_model.h"

namespace prismesh::mesh::spatial {
namespace {

using test::all_shells;
using test::make_model;

/// A bumpy sheet of n x n quads, every third of which is two triangles.
Model bumpy_sheet(int n) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) nodes.push_back({1 + i + (n + 1) * j, Vec3(i, j, 0.7 * ((i * 7 + j * 5) % 4))});
  std::int64_t id = 1;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const std::int64_t a = 1 + i + (n + 1) * j, b = a + 1, c = b + n + 1, d = a + n + 1;
      if ((i + j) % 3 == 0) {
        shells.push_back({id++, 1, {a, b, c}});
        shells.push_back({id++, 1, {a, c, d}});
      } else {
        shells.push_back({id++, 1, {a, b, c, d}});
      }
    }
  return make_model(nodes, shells);
}

TEST(ShellTreeTest, finds_points_over_face_side_and_corner_of_a_square) {
  const Model model = make_model({{1, {0, 0, 0}}, {2, {2, 0, 0}}, {3, {2, 2, 0}}, {4, {0, 2, 0}}}, {{1, 1, {1, 2, 3, 4}}});
  const ShellTree tree(model, all_shells(model));
  const auto over_face = tree.closest(Vec3(1.5, 0.5, 3));
  ASSERT_TRUE(over_face);
  EXPECT_LT((over_face->point - Vec3(1.5, 0.5, 0)).norm(), 1e-14);
  EXPECT_DOUBLE_EQ(over_face->distance, 3);
  const auto beside = tree.closest(Vec3(1, -4, 0));
  EXPECT_LT((beside->point - Vec3(1, 0, 0)).norm(), 1e-14);
  const auto corner = tree.closest(Vec3(5, 6, 0));
  EXPECT_LT((corner->point - Vec3(2, 2, 0)).norm(), 1e-14);
  EXPECT_DOUBLE_EQ(corner->distance, 5);
  EXPECT_NEAR(corner->share[2], 1, 1e-15);
}

TEST(ShellTreeTest, keeps_to_the_radius) {
  const Model model = make_model({{1, {0, 0, 0}}, {2, {2, 0, 0}}, {3, {2, 2, 0}}}, {{1, 1, {1, 2, 3}}});
  const ShellTree tree(model, all_shells(model));
  EXPECT_FALSE(tree.closest(Vec3(1, 0.5, 1), 0.999));
  EXPECT_TRUE(tree.closest(Vec3(1, 0.5, 1), 1.001));
  EXPECT_FALSE(ShellTree(model, {}).closest(Vec3::Zero()));
  EXPECT_TRUE(tree.within(Vec3(1, 0.5, 1), 0.5).empty());
}

TEST(ShellTreeTest, counts_shells_at_the_radius_as_within_it) {
  const Model model = bumpy_sheet(6);
  const ShellTree tree(model, all_shells(model));
  std::mt19937 random(11);
  std::uniform_real_distribution<double> anywhere(-3, 9);
  for (int trial = 0; trial < 500; ++trial) {
    const Vec3 point(anywhere(random), anywhere(random), anywhere(random));
    const auto found = tree.closest(point);
    ASSERT_TRUE(found);
    const auto again = tree.closest(point, found->distance);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->shell, found->shell);
    EXPECT_FALSE(tree.within(point, found->distance).empty());
    EXPECT_FALSE(tree.closest(point, found->distance * (1 - 1e-9)));
  }
  EXPECT_FALSE(tree.closest(Vec3(3, 3, 0), -1));
  EXPECT_FALSE(tree.closest(Vec3(3, 3, 0), std::nan("")));
  EXPECT_TRUE(tree.within(Vec3(3, 3, 0), -5).empty());
  const Vec3 on = model.position(NodeIndex(10));
  ASSERT_TRUE(tree.closest(on, 0));
  EXPECT_EQ(tree.closest(on, 0)->distance, 0);
}

TEST(ShellTreeTest, passes_over_what_is_no_number) {
  Model model = bumpy_sheet(9);
  const double odd[] = {std::nan(""), std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (std::size_t n = 0; n < model.node_count(); n += 3) {
    Vec3 place = model.positions[n];
    place[static_cast<int>(n % 2)] = odd[n % 5 % 3];
    model.positions.set(n, place);
  }
  const ShellTree tree(model, all_shells(model));
  for (const double number : odd) {
    EXPECT_FALSE(tree.closest(Vec3(1, number, 1)));
    EXPECT_TRUE(tree.within(Vec3(number, 0, 0), 5).empty());
  }
  const auto found = tree.closest(Vec3(4, 4, 9));
  if (found) {
    EXPECT_TRUE(found->point.allFinite() && std::isfinite(found->distance));
  }
  for (const SurfacePoint& point : tree.within(Vec3(4, 4, 0), 100)) EXPECT_TRUE(point.point.allFinite());
  // nothing finite at all
  for (std::size_t n = 0; n < model.node_count(); ++n) model.positions.set(n, Vec3(odd[n % 3], 0, 0));
  EXPECT_TRUE(ShellTree(model, all_shells(model)).empty());
}

TEST(ShellTreeTest, passes_over_what_was_removed) {
  Model model = make_model({{1, {0, 0, 0}}, {2, {2, 0, 0}}, {3, {2, 2, 0}}, {4, {0, 0, 5}}, {5, {0, 0, 9}}}, {{1, 1, {1, 2, 3}}});
  remove_node(model, NodeIndex(3));
  const NodeSet nodes{NodeIndex(3), NodeIndex(4)};
  EXPECT_DOUBLE_EQ(ShellTree(model, {}, nodes).closest(Vec3(0, 0, 4))->distance, 5);
  EXPECT_DOUBLE_EQ(ShellTree(model, all_shells(model), nodes).closest(Vec3(0, 0, 4))->distance, 4);
  remove_shell(model, ShellIndex(0));
  EXPECT_DOUBLE_EQ(ShellTree(model, {ShellIndex(0)}, nodes).closest(Vec3(0, 0, 4))->distance, 5);
}

TEST(ShellTreeTest, measures_slivers_and_points) {
  // a needle 1e-12 high, one without any height, and shells whose corners are one point
  const Model model =
      make_model({{1, {0, 0, 0}}, {2, {10, 0, 0}}, {3, {4, 1e-12, 0}}, {4, {0, 5, 0}}, {5, {10, 5, 0}}, {6, {4, 5, 0}}, {7, {3, 9, 0}}},
                 {{1, 1, {1, 2, 3}}, {2, 1, {4, 5, 6}}, {3, 1, {7, 7, 7}}, {4, 1, {7, 7, 7, 7}}});
  const ShellTree tree(model, all_shells(model));
  for (double x = 0.5; x < 10; x += 0.83) {
    EXPECT_NEAR(tree.closest(Vec3(x, -1, 1))->distance, std::sqrt(2.0), 1e-11);
    EXPECT_NEAR(tree.closest(Vec3(x, 4.5, 0))->distance, 0.5, 1e-12);
    EXPECT_NEAR((tree.closest(Vec3(x, 4.5, 0))->point - Vec3(x, 5, 0)).norm(), 0, 1e-12);
  }
  EXPECT_EQ(tree.closest(Vec3(3, 9, 2))->distance, 2);
  EXPECT_EQ(tree.closest(Vec3(3, 9, 2))->shell, ShellIndex(2));
  EXPECT_EQ(tree.within(Vec3(3, 9, 2), 2).size(), 2u);
}

TEST(ShellTreeTest, divides_where_all_middles_coincide) {
  // 5,000 equal triangles: no axis tells them apart
  std::vector<test::NodeSpec> nodes{{1, {0, 0, 0}}, {2, {1, 0, 0}}, {3, {0, 1, 0}}};
  std::vector<test::ShellSpec> shells;
  for (int s = 1; s <= 5000; ++s) shells.push_back({s, 1, {1, 2, 3}});
  const Model model = make_model(nodes, shells);
  const ShellTree tree(model, all_shells(model));
  EXPECT_EQ(tree.closest(Vec3(0.2, 0.2, 3))->shell, ShellIndex(0));
  EXPECT_EQ(tree.within(Vec3(0.2, 0.2, 3), 3).size(), 5000u);
}

TEST(ShellTreeTest, agrees_with_dense_samples_of_every_shell) {
  const Model model = bumpy_sheet(9);
  const ShellTree tree(model, all_shells(model));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-3, 12);
  constexpr int kSamples = 40;
  for (int trial = 0; trial < 60; ++trial) {
    const Vec3 point(anywhere(random), anywhere(random), anywhere(random) - 4);
    double sampled = std::numeric_limits<double>::infinity();
    for (std::size_t s = 0; s < model.shell_count(); ++s) {
      const ShellNodes& shell = model.shell(ShellIndex(s));
      for (int half = 0; half < (shell.is_triangle() ? 1 : 2); ++half) {
        const Vec3 a = model.position(shell.node[0]);
        const Vec3 b = model.position(shell.node[half == 0 ? 1 : 2]);
        const Vec3 c = model.position(shell.node[half == 0 ? 2 : 3]);
        for (int i = 0; i <= kSamples; ++i)
          for (int j = 0; j + i <= kSamples; ++j)
            sampled = std::min(sampled, (a + (b - a) * i / kSamples + (c - a) * j / kSamples - point).norm());
      }
    }
    const auto found = tree.closest(point);
    ASSERT_TRUE(found);
    EXPECT_LE(found->distance, sampled + 1e-12);
    EXPECT_GE(found->distance, sampled - 0.06);
    const ShellNodes& shell = model.shell(found->shell);
    Vec3 mixed = Vec3::Zero();
    double sum = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      mixed += found->share[c] * model.position(shell.node[c]);
      sum += found->share[c];
      EXPECT_GE(found->share[c], 0);
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_LT((mixed - found->point).norm(), 1e-12);
    const auto around = tree.within(point, found->distance * 1.2);
    const auto same = std::find_if(around.begin(), around.end(), [&](const SurfacePoint& p) { return p.shell == found->shell; });
    ASSERT_NE(same, around.end());
    EXPECT_DOUBLE_EQ(same->distance, found->distance);
  }
}

/// The diagonal from the first corner to the third is a valley at z = 0; the other one would be a ridge at z = 2.
Model bent_quad() { return make_model({{1, {0, 0, 0}}, {2, {2, 0, 2}}, {3, {2, 2, 0}}, {4, {0, 2, 2}}}, {{1, 1, {1, 2, 3, 4}}}); }

TEST(ShellTreeTest, takes_a_bent_quad_along_the_diagonal_from_its_first_corner) {
  const Model model = bent_quad();
  const ShellTree tree(model, all_shells(model));
  const auto below = tree.closest(Vec3(1.5, 1.5, -1));
  ASSERT_TRUE(below);
  EXPECT_DOUBLE_EQ(below->distance, 1);
  const std::array<double, 4> shares{0.25, 0, 0.75, 0};
  for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(below->share[c], shares[c], 1e-15) << c;
  // on each half: the second one's shares are of the first, third and fourth corner
  const auto first = tree.closest(Vec3(1.25, 0.5, 0.75)), second = tree.closest(Vec3(0.5, 1.25, 0.75));
  EXPECT_NEAR(first->distance, 0, 1e-15);
  EXPECT_NEAR(second->distance, 0, 1e-15);
  EXPECT_NEAR(first->share[1], 0.375, 1e-15);
  EXPECT_NEAR(second->share[3], 0.375, 1e-15);
  EXPECT_EQ(first->share[3], 0);
  EXPECT_EQ(second->share[1], 0);
  EXPECT_NEAR(second->share[2], 0.25, 1e-15);
}

TEST(ShellTreeTest, of_equally_close_shells_takes_the_first) {
  // numbered in stripes across, so that the tree's order isn't theirs
  const Model model = test::make_grid(8, 8, [](int i, int j) { return Vec3(i, j, 0); });
  const ShellTree tree(model, all_shells(model));
  for (std::size_t n = 0; n < model.node_count(); ++n) {
    const ShellIndex first = model.adjacency->shells_of(NodeIndex(n)).front();
    const auto found = tree.closest(model.position(NodeIndex(n)) + Vec3(0, 0, 2));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->shell, first) << n;
    EXPECT_EQ(tree.within(model.position(NodeIndex(n)) + Vec3(0, 0, 2), 2).size(), model.adjacency->shells_of(NodeIndex(n)).size()) << n;
  }
}

}  // namespace
}  // namespace prismesh::mesh::spatial
