#include "mesh/shape/normals.h"

#include <array>
#include <cmath>
#include <iostream>
#include <vector>

#include <gtest/gtest.h>

#include "base/deterministic_math.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/features.h"
#include "mesh/shape/move.h"
#include "tests/support/make_model.h"
#include "tests/support/real_deck.h"
#include "tests/support/whole_model.h"

namespace prismesh::mesh::shape {
namespace {

using test::all_nodes;

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

/// A band of `count` quads, two wide, whose end is joined to its beginning after `turns` half turns.
Model twisted_band(int count, int turns) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  const auto id = [&](int i, int j) { return i < count ? 1 + 3 * i + j : 1 + (turns % 2 == 0 ? j : 2 - j); };
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < 3; ++j) {
      const double around = 2 * kPi * i / count, twist = turns * around / 2, out = 20 + (j - 1) * std::cos(twist);
      nodes.push_back({id(i, j), {out * std::cos(around), out * std::sin(around), (j - 1) * std::sin(twist)}});
    }
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < 2; ++j) {
      std::vector<std::int64_t> corners{id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)};
      if ((i * 5 + j * 3) % 4 == 0) std::swap(corners[1], corners[3]);
      shells.push_back({1 + 2 * i + j, 1, corners});
    }
  return test::make_model(nodes, shells);
}

TEST(Normals, turn_over_only_on_the_far_side_of_a_moebius_strip) {
  for (const int turns : {1, 2, 3}) {
    const Model model = twisted_band(80, turns);
    const NodeIndex start(3 * 10 + 1);  // in the band's middle
    const std::vector<Vec3> normals = oriented_normals(model, all_nodes(model), start);
    EXPECT_EQ(normals, oriented_normals(model, all_nodes(model), start));
    int turned_at = -1, times = 0;
    for (int i = 0; i < 80; ++i) {
      const Vec3& here = normals[static_cast<std::size_t>(3 * i + 1)];
      const Vec3& next = normals[static_cast<std::size_t>(3 * ((i + 1) % 80) + 1)];
      EXPECT_NEAR(here.norm(), 1, 1e-12);
      if (here.dot(next) < 0) turned_at = i, ++times;
    }
    EXPECT_EQ(times, turns % 2);
    EXPECT_NEAR(turned_at, turns % 2 == 1 ? 50 : -1, 2);
  }
}

TEST(Normals, keep_a_sheet_together_however_its_ribs_run) {
  // a flat sheet of 12 x 12 with three ribs across it, each with a gap at one end; a rib is where the spreading begins
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int j = 0; j <= 12; ++j)
    for (int i = 0; i <= 12; ++i) nodes.push_back({1 + i + 13 * j, Vec3(i, j, 0)});
  for (int j = 0; j < 12; ++j)
    for (int i = 0; i < 12; ++i) {
      const std::int64_t a = 1 + i + 13 * j;
      shells.push_back({1 + i + 12 * j, 1, {a, a + 1, a + 14, a + 13}});
      if ((i + j) % 3 == 0) std::swap(shells.back().nodes[1], shells.back().nodes[3]);
    }
  for (const int row : {3, 6, 9}) {
    for (int i = 0; i < 12; ++i) nodes.push_back({1000 * row + i, Vec3(i, row, 1)});
    for (int i = 0; i < 11; ++i) {
      const std::int64_t a = 1 + i + 13 * row;
      shells.push_back({1000 * row + i, 2, {a, a + 1, 1000 * row + i + 1, 1000 * row + i}});
    }
  }
  const Model model = test::make_model(nodes, shells);
  const std::vector<Vec3> normals = oriented_normals(model, all_nodes(model), model.find_node(6005));
  const double up = normals[0].z();
  EXPECT_EQ(std::abs(up), 1);
  for (std::size_t i = 0; i < 169; ++i)
    if (model.positions[i].y() < 3 || model.positions[i].y() > 9) {
      EXPECT_EQ(normals[i].z(), up) << i;
    }
  for (const int row : {3, 6, 9}) EXPECT_GT(normals[static_cast<std::size_t>(1 + 13 * row + 5)].z() * up, 0.5);
}

TEST(Normals, take_the_first_shell_where_a_folded_sheet_cancels_itself) {
  const Model model =
      test::make_model({{1, {0, 0, 0}}, {2, {1, 0, 0}}, {3, {1, 1, 0}}, {4, {0, 1, 0}}, {5, {0.1, 0, 0}}, {6, {0.1, 1, 0}}, {7, {5, 5, 5}}},
                       {{1, 1, {1, 2, 3, 4}}, {2, 1, {2, 5, 6, 3}}, {3, 1, {7, 7, 7}}, {4, 1, {1, 1, 7, 7}}});
  const std::vector<Vec3> normals = oriented_normals(model, all_nodes(model), NodeIndex(0));
  for (const Vec3& normal : normals) EXPECT_TRUE(normal.allFinite());
  EXPECT_EQ(normals[0], Vec3(0, 0, 1));
  EXPECT_NEAR(std::abs(normals[1].z()), 1, 1e-12);
  EXPECT_EQ(normals[6], Vec3(0, 0, 0));
}

TEST(Normals, of_a_sheet_folded_flat_onto_itself_is_the_first_shells) {
  // as it lies and turned by an angle, where rounding leaves a little of the sum
  for (const double angle : {0.0, 0.7}) {
    const Vec3 along(std::cos(angle), 0.6 * std::sin(angle), 0.8 * std::sin(angle)), across(0, 0.8, -0.6);
    const Model model =
        test::make_shells({Vec3::Zero(), along, along + across, across, Vec3::Zero(), across}, {{0, 1, 2, 3}, {1, 4, 5, 2}});
    const std::vector<Vec3> normals = oriented_normals(model, all_nodes(model), NodeIndex(0));
    for (const std::size_t folded : {1, 2}) EXPECT_NEAR((normals[folded] - along.cross(across)).norm(), 0, 1e-12) << folded;
  }
}

/// Decks whose neighbouring shells disagree. Across smooth edges the normals of the ends have to agree all the same.
TEST(Normals, hang_together_on_real_decks) {
  const auto decks = test::real_decks();
  if (!decks) GTEST_SKIP() << "PRISMESH_MODELS doesn't point to the real decks";
  for (const char* name : {"wing_ferig", "wheel_k", "gsa_car6_comma"}) {
    SCOPED_TRACE(name);
    const Model model = test::open_real(*decks, name);
    const std::vector<Vec3> normals = oriented_normals(model, all_nodes(model), model.shell(ShellIndex(0)).node[0]);
    EXPECT_EQ(normals, oriented_normals(model, all_nodes(model), model.shell(ShellIndex(0)).node[0]));
    const std::vector<EdgeKind> kinds = classify_edges(model, 20);
    const auto inner = [&](NodeIndex node) {  // away from creases and junctions, where a node's normal is a compromise
      for (const ShellIndex shell : model.adjacency->shells_of(node))
        for (int c = 0; c < model.shell(shell).corners(); ++c) {
          const EdgeIndex edge = model.adjacency->find_edge(node, model.shell(shell).node[c]);
          if (edge.valid() && kinds[edge.value] != EdgeKind::smooth && kinds[edge.value] != EdgeKind::free) return false;
        }
      return true;
    };
    std::size_t smooth = 0, turned = 0, disagree = 0;
    for (std::size_t e = 0; e < kinds.size(); ++e) {
      if (kinds[e] != EdgeKind::smooth) continue;
      const Edge ends = model.adjacency->edge(EdgeIndex(e));
      const auto shells = model.adjacency->shells_of(EdgeIndex(e));
      const auto plain = [&](ShellIndex s) {
        const auto& n = model.shell(s).node;
        return Vec3((model.position(n[2]) - model.position(n[0])).cross(model.position(n[3]) - model.position(n[1])));
      };
      disagree += plain(shells[0]).dot(plain(shells[1])) < 0 ? 1 : 0;
      if (!inner(ends.low) || !inner(ends.high)) continue;
      ++smooth;
      turned += normals[ends.low.value].dot(normals[ends.high.value]) < 0 ? 1 : 0;
    }
    std::cout << "  " << name << ": " << disagree << " smooth edges between shells that disagree; of " << smooth << " inner ones " << turned
              << " between normals that do\n";
    EXPECT_GT(smooth, 500u);
    EXPECT_EQ(turned, 0u);
    for (const Vec3& normal : normals) EXPECT_TRUE(normal.allFinite());
  }
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
