// Where nodes stand on the reference and what they are held by, in flat sheets whose answers are known.
#include "mesh/relax/spring_net.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/deterministic_math.h"
#include "tests/mesh/relax/relaxing.h"

namespace prismesh::test {

namespace {

using namespace mesh;

/// A flat sheet of squares of this size.
Model squares(int columns, int rows, double size = kSize) {
  return make_grid(columns, rows, [=](int i, int j) { return Vec3(size * i, size * j, 0); });
}

relax::SpringNet net_of(const Model& model, const Model& reference, const NodeSet& movable) {
  const relax::ReferenceSurface surface(reference, all_shells(reference), 30);
  return relax::make_spring_net(model, surface, movable, 30, {}).value();
}

/// The springs of a node by the node at their other end.
std::map<NodeIndex, relax::Spring> springs_at(const relax::SpringNet& net, NodeIndex node) {
  std::map<NodeIndex, relax::Spring> springs;
  const auto local = static_cast<std::size_t>(std::find(net.nodes.begin(), net.nodes.end(), node) - net.nodes.begin());
  if (local >= net.movable) return springs;
  for (const relax::Spring& spring : net.springs_of(local)) springs[net.nodes[spring.to]] = spring;
  EXPECT_EQ(springs.size(), net.springs_of(local).size()) << "one is there twice";
  return springs;
}

TEST(relax_net, has_a_spring_for_each_edge_and_diagonal_as_strong_as_its_shells_are_many) {
  const Model model = squares(4, 4);
  const relax::SpringNet net = net_of(model, model, all_nodes(model));
  EXPECT_EQ(net.movable, 21u) << "all but the corners";
  EXPECT_EQ(net.nodes.size(), 25u);
  for (const auto& [at, around] : {std::pair(std::pair(2, 2), 8u), std::pair(std::pair(2, 0), 5u), std::pair(std::pair(1, 1), 8u)}) {
    const auto [i, j] = at;
    const auto springs = springs_at(net, grid_node(4, i, j));
    EXPECT_EQ(springs.size(), around);
    for (const auto& [other, spring] : springs) {
      const int di = std::abs(static_cast<int>(other.value % 5) - i), dj = std::abs(static_cast<int>(other.value / 5) - j);
      const bool is_diagonal = di + dj == 2, is_border = j == 0 && dj == 0;
      EXPECT_EQ(spring.weight, is_diagonal || is_border ? 1 : 2);
      EXPECT_NEAR(spring.rest, is_diagonal ? 5 * std::sqrt(2.0) : 5, 1e-5);
    }
  }
  for (const double size : net.size) EXPECT_NEAR(size, 5, 1e-9);
}

TEST(relax_net, has_no_diagonals_in_triangles) {
  std::vector<Vec3> points{Vec3::Zero()};
  std::vector<std::array<int, 4>> shells;
  for (int k = 0; k < 6; ++k) {
    points.emplace_back(5 * deterministic_cos_degrees(60 * k), 5 * deterministic_sin_degrees(60 * k), 0);
    shells.push_back({0, 1 + k, 1 + (k + 1) % 6, 1 + (k + 1) % 6});
  }
  const Model model = make_shells(points, shells);
  const relax::SpringNet net = net_of(model, model, {NodeIndex(0)});
  const auto springs = springs_at(net, NodeIndex(0));
  EXPECT_EQ(springs.size(), 6u);
  for (const auto& [other, spring] : springs) {
    EXPECT_EQ(spring.weight, 2);
    EXPECT_NEAR(spring.rest, 5, 1e-5);
  }
}

TEST(relax_net, has_springs_as_long_as_the_mesh_is_fine_not_the_reference) {
  const Model reference = squares(4, 4, 10), fine = squares(8, 8, 5);
  const relax::SpringNet net = net_of(fine, reference, all_nodes(fine));
  for (const auto& [other, spring] : springs_at(net, grid_node(8, 4, 4))) {
    const bool is_diagonal = other.value / 9 != 4 && other.value % 9 != 4;
    // a little longer than in the corners, where nodes stay whose edges are short
    EXPECT_NEAR(spring.rest, is_diagonal ? 5 * std::sqrt(2.0) : 5, 0.4);
  }
}

TEST(relax_net, has_no_colour_twice_in_a_shell) {
  const Model model = sheet_on(torus(), 12, 9, 0.3);
  const relax::SpringNet net = net_of(model, model, all_nodes(model));
  std::vector<int> colour_of(net.nodes.size(), -1);
  std::size_t coloured = 0;
  for (std::size_t c = 0; c < net.colours.size(); ++c)
    for (const std::uint32_t node : net.colours[c]) {
      EXPECT_EQ(colour_of[node], -1);
      colour_of[node] = static_cast<int>(c);
      ++coloured;
    }
  EXPECT_EQ(coloured, net.movable);
  for (const std::array<std::int32_t, 4>& corners : net.corners)
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < a; ++b) {
        const int colour = colour_of[static_cast<std::size_t>(corners[a])];
        EXPECT_TRUE(colour < 0 || colour != colour_of[static_cast<std::size_t>(corners[b])]);
      }
}

/// The anchor of a node of `model` on `reference`.
relax::SurfaceAnchor footing_on(const Model& model, const Model& reference, NodeIndex node) {
  const relax::ReferenceSurface surface(reference, all_shells(reference), 30);
  return relax::find_anchor(model, surface, node, deterministic_cos_degrees(30));
}

bool has_corner(const Model& model, ShellIndex shell, NodeIndex node) {
  const ShellNodes& nodes = model.shell(shell);
  return std::find(nodes.node.begin(), nodes.node.end(), node) != nodes.node.end();
}

TEST(relax_footing, inside_is_the_sheet_on_an_edge_its_line_and_in_a_corner_nothing) {
  const Model model = squares(6, 6);
  const relax::SurfaceAnchor inside = footing_on(model, model, grid_node(6, 3, 2));
  EXPECT_EQ(inside.freedom, relax::Freedom::surface);
  EXPECT_TRUE(has_corner(model, inside.shell, grid_node(6, 3, 2)));
  EXPECT_NEAR(std::abs(inside.direction.z()), 1, 1e-12);
  EXPECT_NEAR(inside.size, 5, 1e-9);
  const relax::SurfaceAnchor edge = footing_on(model, model, grid_node(6, 3, 0));
  EXPECT_EQ(edge.freedom, relax::Freedom::line);
  EXPECT_NEAR(std::abs(edge.direction.x()), 1, 1e-12);
  EXPECT_LE(std::max(edge.from, edge.to), grid_node(6, 4, 0));
  EXPECT_GE(std::min(edge.from, edge.to), grid_node(6, 2, 0));
  EXPECT_NEAR(edge.size, 5, 1e-9);
  EXPECT_EQ(footing_on(model, model, grid_node(6, 6, 0)).freedom, relax::Freedom::fixed);
}

TEST(relax_footing, is_missing_without_shells_or_a_place) {
  Model model = make_shells({{0, 0, 0}, {5, 0, 0}, {5, 5, 0}, {0, 5, 0}, {2, 2, 0}}, {{0, 1, 2, 3}});
  EXPECT_EQ(footing_on(model, model, NodeIndex(4)).freedom, relax::Freedom::fixed);
  const Model sheet = squares(6, 6);
  Model broken = sheet;
  broken.positions.set(grid_node(6, 3, 3).value, Vec3(15, std::nan(""), 0));
  EXPECT_EQ(footing_on(broken, sheet, grid_node(6, 3, 3)).freedom, relax::Freedom::fixed);
}

TEST(relax_footing, is_missing_farther_than_a_quarter_of_an_element_from_the_reference) {
  const Model reference = squares(6, 6);
  const NodeIndex inside = grid_node(6, 3, 3), edge = grid_node(6, 3, 0);
  for (const auto& [off, stands] : {std::pair(1.15, true), std::pair(1.4, false)}) {
    Model model = reference;
    model.positions.set(inside.value, Vec3(15, 15, off));
    model.positions.set(edge.value, Vec3(15, -off, 0));
    EXPECT_EQ(footing_on(model, reference, inside).freedom, stands ? relax::Freedom::surface : relax::Freedom::fixed) << off;
    EXPECT_EQ(footing_on(model, reference, edge).freedom, stands ? relax::Freedom::line : relax::Freedom::fixed) << off;
  }
}

TEST(relax_footing, of_a_piece_with_numbers_of_its_own_is_where_it_lies) {
  // rows and columns 3 to 6 of the reference, numbered anew
  const Model reference = squares(9, 9);
  const Model piece = make_grid(3, 3, [](int i, int j) { return Vec3(5.0 * (i + 3), 5.0 * (j + 3), 0); });
  for (const auto& [i, j] : {std::pair(1, 1), std::pair(2, 1), std::pair(2, 2)}) {
    const relax::SurfaceAnchor anchor = footing_on(piece, reference, grid_node(3, i, j));
    EXPECT_EQ(anchor.freedom, relax::Freedom::surface);
    EXPECT_TRUE(has_corner(reference, anchor.shell, grid_node(9, i + 3, j + 3))) << i << ' ' << j;
  }
  EXPECT_EQ(footing_on(piece, reference, grid_node(3, 1, 0)).freedom, relax::Freedom::fixed) << "its border is no line of the reference";
}

TEST(relax_footing, leads_back_along_the_sheet_and_along_the_line_to_its_end) {
  const Model model = squares(6, 6);
  const relax::ReferenceSurface surface(model, all_shells(model), 30);
  const double cosine = deterministic_cos_degrees(30);
  relax::SurfaceAnchor inside = relax::find_anchor(model, surface, grid_node(6, 1, 1), cosine);
  EXPECT_LT((relax::move_anchor(surface, Vec3(22, 17, 3), inside) - Vec3(22, 17, 0)).norm(), 1e-9);
  EXPECT_EQ(inside.shell, ShellIndex(std::size_t{4 + 6 * 3})) << "the anchor follows";
  relax::SurfaceAnchor edge = relax::find_anchor(model, surface, grid_node(6, 1, 0), cosine);
  EXPECT_LT((relax::move_anchor(surface, Vec3(22, 2, 3), edge) - Vec3(22, 0, 0)).norm(), 1e-9);
  EXPECT_EQ(std::max(edge.from, edge.to), grid_node(6, 5, 0));
  EXPECT_LT((relax::move_anchor(surface, Vec3(44, 8, 0), edge) - Vec3(30, 0, 0)).norm(), 1e-9) << "not round the corner";
}

TEST(relax, takes_nodes_that_alone_may_move_back_to_the_middle) {
  const Model regular = squares(6, 6);
  Model pulled = regular;
  const NodeIndex inside = grid_node(6, 3, 3), edge = grid_node(6, 3, 0);
  pulled.positions.set(inside.value, Vec3(16.7, 13.9, 0));
  pulled.positions.set(edge.value, Vec3(13.4, 0, 0));
  const relax::ReferenceSurface surface(regular, all_shells(regular), 30);
  const relax::Relaxed relaxed = relax::relax({pulled, surface, criteria_of(), {}}, {edge, inside}).value();
  ASSERT_EQ(relaxed.nodes, (NodeSet{edge, inside}));
  EXPECT_LT((relaxed.positions[0] - Vec3(15, 0, 0)).norm(), 0.2);
  EXPECT_LT((relaxed.positions[1] - Vec3(15, 15, 0)).norm(), 0.2);
  EXPECT_EQ(relaxed.held_back, 0u);
  EXPECT_EQ(relaxed.limited, 0u);
  EXPECT_NEAR(relaxed.farthest, std::hypot(1.7, 1.1), 0.2);
}

}  // namespace

}  // namespace prismesh::test
