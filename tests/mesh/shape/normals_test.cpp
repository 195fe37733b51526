#include "mesh/shape/normals.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/shape/move.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::shape {
namespace {

NodeSet all_nodes(const Model& model) {
  NodeSet nodes(model.node_count());
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = NodeIndex(i);
  return nodes;
}

/// A flat grid with some shells' nodes in the opposite order.
Model disordered_grid(bool first_up) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int j = 0; j <= 6; ++j)
    for (int i = 0; i <= 6; ++i) nodes.push_back({1 + i + j * 7, Vec3(i, j, 0)});
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 6; ++i) {
      const std::int64_t a = 1 + i + j * 7;
      const bool up = i + j == 0 ? first_up : (i * 5 + j * 3) % 4 != 0;
      shells.push_back(
          {1 + i + j * 6, 1, up ? std::vector<std::int64_t>{a, a + 1, a + 8, a + 7} : std::vector<std::int64_t>{a, a + 7, a + 8, a + 1}});
    }
  return test::make_model(nodes, shells);
}

TEST(Normals, agree_with_the_first_shell_at_the_reference) {
  for (const bool up : {true, false}) {
    const Model model = disordered_grid(up);
    for (const Vec3& normal : oriented_normals(model, all_nodes(model), NodeIndex(0))) EXPECT_EQ(normal, Vec3(0, 0, up ? 1 : -1));
  }
}

TEST(Normals, weigh_shells_by_area) {
  // a unit square in the plane and one of twice the area standing on its edge
  const Model model = test::make_model({{1, {0, 0, 0}}, {2, {1, 0, 0}}, {3, {1, 1, 0}}, {4, {0, 1, 0}}, {5, {1, 0, 2}}, {6, {1, 1, 2}}},
                                       {{1, 1, {1, 2, 3, 4}}, {2, 1, {2, 5, 6, 3}}});
  const std::vector<Vec3> normals = oriented_normals(model, all_nodes(model), NodeIndex(0));
  EXPECT_EQ(normals[0], Vec3(0, 0, 1));
  EXPECT_LE((normals[1] - Vec3(-2, 0, 1).normalized()).norm(), 1e-15);
  EXPECT_EQ(normals[4], Vec3(-1, 0, 0));
}

TEST(Normals, are_zero_without_shells) {
  const Model model = test::make_model({{1, {0, 0, 0}}, {2, {1, 0, 0}}, {3, {1, 1, 0}}, {4, {9, 9, 9}}}, {{1, 1, {1, 2, 3}}});
  const std::vector<Vec3> normals = oriented_normals(model, all_nodes(model), NodeIndex(3));
  EXPECT_EQ(normals[0], Vec3(0, 0, 1));
  EXPECT_EQ(normals[3], Vec3(0, 0, 0));
}

TEST(Normals, spread_over_a_junction_and_to_every_piece) {
  const Model model = test::make_model({{1, {0, 0, 0}},
                                        {2, {1, 0, 0}},
                                        {3, {1, 1, 0}},
                                        {4, {0, 1, 0}},
                                        {5, {2, 0, 0}},
                                        {6, {2, 1, 0}},
                                        {7, {1, 0, 1}},
                                        {8, {1, 1, 1}},
                                        {9, {5, 0, 0}},
                                        {10, {6, 0, 0}},
                                        {11, {6, 1, 0}}},
                                       {{1, 1, {1, 2, 3, 4}}, {2, 1, {2, 3, 6, 5}}, {3, 1, {2, 7, 8, 3}}, {4, 2, {9, 10, 11}}});
  const std::vector<Vec3> normals = oriented_normals(model, all_nodes(model), NodeIndex(0));
  EXPECT_EQ(normals[4], Vec3(0, 0, 1));
  EXPECT_NEAR(normals[6].norm(), 1, 1e-15);
  EXPECT_EQ(normals[8], Vec3(0, 0, 1));
}

TEST(Move, translates_and_lifts_by_weight) {
  const std::array<Vec3, 3> start{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)};
  const std::array<double, 3> weight{0, 0.5, 1};
  std::array<Vec3, 3> out;
  translate(start, weight, Vec3(2, 4, 6), out);
  EXPECT_EQ(out[0], start[0]);
  EXPECT_EQ(out[1], Vec3(2, 2, 3));
  EXPECT_EQ(out[2], Vec3(4, 4, 6));
  const std::array<Vec3, 1> up{Vec3(0, 0, 1)};
  lift(start, weight, up, -3, out);
  EXPECT_EQ(out[1], Vec3(1, 0, -1.5));
  const std::array<Vec3, 3> each{Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  lift(start, weight, each, 2, out);
  EXPECT_EQ(out[1], Vec3(1, 1, 0));
  EXPECT_EQ(out[2], Vec3(2, 0, 2));
}

}  // namespace
}  // namespace prismesh::mesh::shape
