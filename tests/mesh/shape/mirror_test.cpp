#include "mesh/shape/mirror.h"

#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/model/topology_change.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::shape {
namespace {

const Plane kAcrossX{Vec3::Zero(), Vec3::UnitX()};

/// Nodes (i, j) at x = 5 (i - 5), so that column 5 lies in the plane x = 0.
Model sheet() {
  return test::make_grid(10, 4, [](int i, int j) { return Vec3(5.0 * (i - 5), 5.0 * j, 0); });
}

TEST(Mirror, finds_the_node_at_the_mirrored_position) {
  const Model model = sheet();
  NodeSet nodes;
  for (int j = 0; j <= 4; ++j)
    for (int i = 0; i <= 10; ++i) nodes.push_back(test::grid_node(10, i, j));
  const std::vector<NodeIndex> images = find_images(model, nodes, kAcrossX);
  for (int j = 0; j <= 4; ++j)
    for (int i = 0; i <= 10; ++i) EXPECT_EQ(images[test::grid_node(10, i, j).value], test::grid_node(10, 10 - i, j));
}

TEST(Mirror, allows_a_quarter_of_a_side) {
  Model model = sheet();
  const NodeIndex node = test::grid_node(10, 8, 2), near = test::grid_node(10, 2, 2);
  model.positions.set(near.value, model.position(near) + Vec3(0.8, 0.8, 0));
  EXPECT_EQ(find_images(model, {node}, kAcrossX)[0], near);
  model.positions.set(near.value, model.position(near) + Vec3(0.4, 0.4, 0));
  EXPECT_FALSE(find_images(model, {node}, kAcrossX)[0].valid());
  // a sheet a thousand times as coarse allows a thousand times as much
  const Model coarse = test::make_grid(10, 4, [](int i, int j) { return Vec3(5e3 * (i - 5) + (i < 5 ? 900 : 0), 5e3 * j, 0); });
  EXPECT_EQ(find_images(coarse, {node}, kAcrossX)[0], near);
}

TEST(Mirror, a_node_without_shells_has_the_sheets_tolerance) {
  const Model grid = sheet();
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (std::size_t n = 0; n < grid.node_count(); ++n) nodes.push_back({grid.node_ids[n], grid.positions[n]});
  for (std::size_t s = 0; s < grid.shell_count(); ++s) {
    shells.push_back({grid.shell_ids[s], 1, {}});
    for (const NodeIndex node : grid.shell(ShellIndex(s)).node) shells.back().nodes.push_back(grid.node_ids[node.value]);
  }
  for (const auto& [id, at] : {std::pair(901, Vec3(12, 3, 50)), std::pair(902, Vec3(-12, 4, 50)), std::pair(903, Vec3(12, 3, 90)),
                               std::pair(904, Vec3(-12, 4.5, 90))})
    nodes.push_back({id, at});
  const Model model = test::make_model(nodes, shells);
  const NodeSet both{test::grid_node(10, 8, 2), model.find_node(901), model.find_node(903)};
  const std::vector<NodeIndex> images = find_images(model, both, kAcrossX);
  EXPECT_EQ(images[1], model.find_node(902)) << "1 away, where a quarter of a side is 1.25";
  EXPECT_FALSE(images[2].valid()) << "1.5 away";
}

TEST(Mirror, a_removed_node_is_nobodys_image) {
  Model model = sheet();
  const NodeIndex node = test::grid_node(10, 8, 2), opposite = test::grid_node(10, 2, 2);
  ASSERT_EQ(find_images(model, {node}, kAcrossX)[0], opposite);
  const auto shells_there = model.adjacency->shells_of(opposite);
  for (const ShellIndex shell : ShellSet(shells_there.begin(), shells_there.end())) remove_shell(model, shell);
  remove_node(model, opposite);
  model.adjacency = std::make_shared<const Adjacency>(build_adjacency(model));
  EXPECT_FALSE(find_images(model, {node}, kAcrossX)[0].valid());
}

TEST(Mirror, one_image_for_one_node_and_the_closest_first) {
  // two nodes close together on the right, one on the left
  const Model model = test::make_shells(
      {{10, 0, 0}, {20, 0, 0}, {20, 10, 0}, {10, 0, 1}, {20, 0, 1}, {20, 10, 1}, {-10, 0, 0.9}, {-20, 0, 9}, {-20, 10, 9}},
      {{0, 1, 2, 2}, {3, 4, 5, 5}, {6, 7, 8, 8}});
  const std::vector<NodeIndex> images = find_images(model, {NodeIndex(std::size_t{0}), NodeIndex(std::size_t{3})}, kAcrossX);
  EXPECT_FALSE(images[0].valid());
  EXPECT_EQ(images[1], NodeIndex(std::size_t{6}));
}

TEST(Mirror, sheets_on_top_of_each_other_keep_to_their_part) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  // left part 2 stands before left part 1 in the deck, right the other way round
  const auto add = [&](std::int64_t part, double x) {
    const auto first = static_cast<std::int64_t>(nodes.size()) + 1;
    for (const Vec3& at : {Vec3(x, 0, 0), Vec3(2 * x, 0, 0), Vec3(2 * x, 10, 0)})
      nodes.push_back({static_cast<std::int64_t>(nodes.size()) + 1, at});
    shells.push_back({first, part, {first, first + 1, first + 2}});
  };
  add(2, -10);
  add(1, -10);
  add(1, 10);
  add(2, 10);
  const Model model = test::make_model(nodes, shells);
  const std::vector<NodeIndex> images = find_images(model, {model.find_node(7), model.find_node(11)}, kAcrossX);
  EXPECT_EQ(images[0], model.find_node(4));
  EXPECT_EQ(images[1], model.find_node(2));
}

std::vector<Vec3> mirrored_moves(const Plane& plane, const std::vector<Vec3>& start, const std::vector<double>& weight, const Vec3& grab,
                                 const std::vector<std::uint32_t>& images, const std::vector<Vec3>& moves) {
  std::vector<Mirrored> nodes(start.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i].image = images[i];
  find_shares(plane, start, weight, grab, nodes);
  return mirror_moves(plane, nodes, moves);
}

TEST(Mirror, one_half_acted_on_moves_and_the_other_mirrors_it) {
  const std::vector<Vec3> moves =
      mirrored_moves(kAcrossX, {{7, 0, 0}, {-7, 0, 0}}, {0.5, 0}, Vec3(20, 0, 0), {1, 0}, {{1, 2, 3}, Vec3::Zero()});
  EXPECT_EQ(moves[0], Vec3(1, 2, 3));
  EXPECT_EQ(moves[1], Vec3(-1, 2, 3));
}

TEST(Mirror, in_the_plane_nothing_moves_across_it) {
  const std::vector<Vec3> moves = mirrored_moves(kAcrossX, {{0, 5, 0}}, {1}, Vec3(20, 0, 0), {0}, {{1, 2, 3}});
  EXPECT_EQ(moves[0], Vec3(0, 2, 3));
}

TEST(Mirror, with_both_halves_acted_on_they_meet_in_the_plane_without_a_step) {
  // all follow whole: from the grab's distance on each half moves as one, between them the move across grows evenly
  std::vector<Vec3> start, moves;
  std::vector<std::uint32_t> images;
  for (int i = -8; i <= 8; ++i) {
    start.emplace_back(i, 0, 0);
    moves.emplace_back(4, 1, 0);
    images.push_back(static_cast<std::uint32_t>(8 - i));
  }
  const std::vector<Vec3> both = mirrored_moves(kAcrossX, start, std::vector<double>(17, 1.0), Vec3(4, 0, 0), images, moves);
  for (int i = -8; i <= 8; ++i) EXPECT_EQ(both[static_cast<std::size_t>(i + 8)], Vec3(std::clamp(i, -4, 4), 1, 0)) << i;
  // a grab in the plane moves nothing across it
  const std::vector<Vec3> inside = mirrored_moves(kAcrossX, start, std::vector<double>(17, 1.0), Vec3(0, 9, 0), images, moves);
  for (const Vec3& move : inside) EXPECT_EQ(move, Vec3(0, 1, 0));
}

TEST(Mirror, what_is_symmetric_already_stays_as_it_is) {
  const std::vector<Vec3> moves =
      mirrored_moves(kAcrossX, {{3, 0, 0}, {-3, 0, 0}}, {0.75, 0.75}, Vec3(6, 0, 0), {1, 0}, {{1, 2, 3}, {-1, 2, 3}});
  EXPECT_EQ(moves[0], Vec3(1, 2, 3));
  EXPECT_EQ(moves[1], Vec3(-1, 2, 3));
}

TEST(Mirror, images_move_as_mirror_images_to_the_bit) {
  std::vector<Vec3> start, moves;
  std::vector<double> weight;
  std::vector<std::uint32_t> images;
  for (int i = 0; i < 200; ++i) {
    const Vec3 place(std::abs(std::sin(i / 2)) * 9, i / 2, std::cos(i / 2));
    start.push_back(i % 2 == 0 ? place : kAcrossX.mirrored_position(place));
    moves.emplace_back(std::sin(3 * i), std::cos(7 * i), std::sin(11 * i));
    weight.push_back(i % 7 == 0 ? 0 : std::abs(std::sin(5 * i)));
    if (weight.back() == 0) moves.back().setZero();
    images.push_back(static_cast<std::uint32_t>(i ^ 1));
  }
  const std::vector<Vec3> both = mirrored_moves(kAcrossX, start, weight, Vec3(4.4, 0, 0), images, moves);
  for (std::size_t i = 0; i < 200; ++i) EXPECT_EQ(both[i ^ 1], kAcrossX.mirrored(both[i]));
}

TEST(Mirror, finds_images_in_a_plane_anywhere) {
  const Plane plane{Vec3(3, 1, 7), Vec3(1, 2, 2) / 3};
  std::vector<Vec3> points;
  std::vector<std::array<int, 4>> shells;
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < 9; ++k) {
      const Vec3 place(5 + 4 * (k % 3), 20 + 3 * (k / 3), 0.5 * k);
      points.push_back(side == 0 ? place : plane.mirrored_position(place));
    }
  for (const int first : {0, 9})
    for (const int a : {0, 1, 3, 4}) shells.push_back({first + a, first + a + 1, first + a + 4, first + a + 3});
  const Model model = test::make_shells(points, shells);
  for (std::size_t k = 0; k < 18; ++k) EXPECT_EQ(find_images(model, {NodeIndex(k)}, plane)[0], NodeIndex((k + 9) % 18)) << k;
}

TEST(Mirror, allows_a_quarter_of_the_shortest_side) {
  for (const auto& [off, found] : {std::pair(0.24, true), std::pair(0.26, false)}) {
    // shells ten times as long as wide
    const Model model = test::make_grid(4, 2, [off = off](int i, int j) { return Vec3(10.0 * (i - 2) + (i == 0 ? off : 0), j, 0); });
    EXPECT_EQ(find_images(model, {test::grid_node(4, 4, 1)}, kAcrossX)[0].valid(), found) << off;
  }
}

TEST(Mirror, shares_count_from_the_plane_wherever_it_is) {
  const Plane plane{Vec3(100, 5, 0), Vec3::UnitX()};
  std::vector<Vec3> start, moves;
  std::vector<std::uint32_t> images;
  for (int i = -6; i <= 6; ++i) {
    start.emplace_back(100 + i, 0, 0);
    moves.emplace_back(4, 1, 0);
    images.push_back(static_cast<std::uint32_t>(6 - i));
  }
  const std::vector<Vec3> both = mirrored_moves(plane, start, std::vector<double>(13, 1.0), Vec3(96, 0, 0), images, moves);
  for (int i = -6; i <= 6; ++i) EXPECT_EQ(both[static_cast<std::size_t>(i + 6)], Vec3(-std::clamp(i, -4, 4), 1, 0)) << i;
}

}  // namespace
}  // namespace prismesh::mesh::shape
