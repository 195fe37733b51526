// Operations by hand: what each does, and what it says where it can't.
#include <gtest/gtest.h>

#include "mesh/repair/manual_operation.h"
#include "tests/mesh/repair/sheets.h"
#include "tests/mesh/repair/validator.h"

namespace prismesh::mesh::repair {
namespace {

struct ManualTask {
  Model model;
  relax::ReferenceSurface surface;
  explicit ManualTask(Model its_model) : model(std::move(its_model)), surface(model, all_shells(model), 30) {}

  Result<Restructuring> does(Operation operation, std::vector<std::size_t> shells, std::vector<std::size_t> nodes = {},
                             const Rules& rules = {}) const {
    ShellSet s;
    NodeSet n;
    for (const std::size_t shell : shells) s.push_back(shell_at(shell));
    for (const std::size_t node : nodes) n.push_back(at(node));
    return apply_manual_operation({model, surface, rules, {quality::default_criteria(), 1}, {}}, {operation, s, n});
  }
  /// The model afterwards, sound and with the same shape.
  Model after(const Result<Restructuring>& change) const {
    EXPECT_TRUE(change.has_value()) << (change ? "" : change.error().message);
    if (!change) return model;
    const Model next = carried_out(model, *change);
    EXPECT_EQ(what_is_wrong(next), "");
    const Shape a = shape_of(model), b = shape_of(next);
    EXPECT_EQ(a.euler, b.euler);
    EXPECT_EQ(a.free_loops, b.free_loops);
    EXPECT_NEAR(a.area, b.area, 1e-7 * a.area);
    EXPECT_NEAR(a.free_length, b.free_length, 1e-9 * a.free_length);
    return next;
  }
  std::string refusal(const Result<Restructuring>& change) const {
    EXPECT_FALSE(change.has_value());
    return change ? "" : change.error().message;
  }
};

ManualTask flat_hand() {
  const Grid grid = flat(6, 6);
  return ManualTask(model_of(grid.positions(), grid.shells()));
}

/// Shell 14 is split: shell 36 is its other triangle.
ManualTask hand_with_triangles() {
  const Grid grid = flat(6, 6);
  auto shells = grid.shells();
  const auto q = shells[14];
  shells[14] = {q[0], q[1], q[2], q[2]};
  shells.push_back({q[0], q[2], q[3], q[3]});
  return ManualTask(model_of(grid.positions(), shells));
}

TEST(ByHand, splits_a_quad_into_two_triangles_one_of_which_stays) {
  const ManualTask task = flat_hand();
  const auto change = task.does(Operation::split, {14});
  const Model next = task.after(change);
  ASSERT_EQ(change->new_shells.size(), 1U);
  ASSERT_EQ(change->reshaped.size(), 1U);
  EXPECT_EQ(change->reshaped[0].first, shell_at(14));
  EXPECT_EQ(change->new_shells[0].parent, shell_at(14));
  EXPECT_TRUE(change->new_nodes.empty());
  EXPECT_EQ(triangles(next), 2U);
}

TEST(ByHand, splits_along_the_diagonal_that_is_nearer_to_the_surface) {
  // A ridge along one diagonal of the quad: the model's surface is the tube, its axis the other diagonal.
  for (const bool mirrored : {false, true}) {
    Grid grid = flat(8, 8);
    grid.place = [mirrored](double x, double y) {
      const double across = ((x - 4) + (mirrored ? y - 4 : 4 - y)) / std::sqrt(2.0);
      return Vec3(x, y, std::sqrt(225 - across * across));
    };
    const ManualTask task(model_of(grid.positions(), grid.shells()));
    const auto change = task.does(Operation::split, {grid.shell(4, 4)});
    task.after(change);
    ASSERT_EQ(change->reshaped.size(), 1U);
    const ShellNodes kept = change->reshaped[0].second;
    // The ridge's line stays an edge: from corner 1 to 3 where the axis runs so, else from 0 to 2.
    const auto has = [&](std::size_t i, std::size_t j) {
      return std::find(kept.node.begin(), kept.node.end(), at(grid.node(i, j))) != kept.node.end();
    };
    EXPECT_EQ(has(4, 4) && has(5, 5), !mirrored);
    EXPECT_EQ(has(5, 4) && has(4, 5), mirrored);
  }
}

TEST(ByHand, divides_two_quads_across_their_common_edge) {
  const ManualTask task = flat_hand();
  const auto change = task.does(Operation::split, {14, 20});
  const Model next = task.after(change);
  ASSERT_EQ(change->new_nodes.size(), 1U);
  EXPECT_EQ(change->new_nodes[0].origin.count(), 2);
  EXPECT_NEAR((change->new_nodes[0].position - Vec3(2.5, 3, 0)).norm(), 0, 1e-9);
  EXPECT_EQ(triangles(next), 2U);
  EXPECT_EQ(triangle_pairs(next), 0U);
}

TEST(ByHand, divides_a_triangle_and_the_quad_beside_it) {
  const ManualTask task = hand_with_triangles();
  const auto change = task.does(Operation::split, {14, 15});
  task.after(change);
  EXPECT_EQ(change->new_nodes.size(), 1U);
  EXPECT_EQ(change->new_shells.size(), 2U);
}

TEST(ByHand, collapses_an_edge_to_the_node_that_holds_the_shape) {
  const ManualTask task = flat_hand();
  // Node 1 is on the free edge, node 8 above it inside.
  const auto change = task.does(Operation::collapse, {}, {1, 8});
  const Model next = task.after(change);
  ASSERT_EQ(change->removed_nodes, NodeSet{at(8)});
  EXPECT_TRUE(change->removed_shells.empty());
  EXPECT_EQ(triangles(next), 2U);
}

TEST(ByHand, joins_two_triangles) {
  const ManualTask task = hand_with_triangles();
  const auto change = task.does(Operation::merge, {14, 36});
  EXPECT_EQ(triangles(task.after(change)), 0U);
  EXPECT_EQ(change->removed_shells, ShellSet{shell_at(36)});
}

TEST(ByHand, keeps_the_triangle_that_has_to_last) {
  const ManualTask task = hand_with_triangles();
  Rules rules;
  rules.shell = [](ShellIndex shell) { return shell == shell_at(36) ? std::uint8_t{kLasting} : std::uint8_t{0}; };
  const auto change = task.does(Operation::merge, {14, 36}, {}, rules);
  task.after(change);
  EXPECT_EQ(change->removed_shells, ShellSet{shell_at(14)});
}

TEST(ByHand, turns_the_edge_between_two_triangles) {
  const ManualTask task = hand_with_triangles();
  const auto change = task.does(Operation::swap, {14, 36});
  const Model next = task.after(change);
  EXPECT_EQ(change->reshaped.size(), 2U);
  const std::array<std::size_t, 4> q = flat(6, 6).shells()[14];
  EXPECT_EQ(next.adjacency->find_edge(at(q[0]), at(q[2])).valid(), false);
  EXPECT_EQ(next.adjacency->find_edge(at(q[1]), at(q[3])).valid(), true);
}

TEST(ByHand, says_why_it_cannot) {
  const ManualTask task = flat_hand();
  EXPECT_EQ(task.refusal(task.does(Operation::merge, {0, 30})), "shell 101 and shell 131 have no edge in common");
  EXPECT_EQ(task.refusal(task.does(Operation::merge, {0, 1})), "shell 101: it isn't a triangle");
  EXPECT_EQ(task.refusal(task.does(Operation::collapse, {}, {0, 8})), "node 1 and node 9 have no edge between them");
  // Corner and its neighbour on the free edge: the corner stays, the neighbour may go; two nodes of opposite free edges never meet.
  EXPECT_EQ(task.refusal(task.does(Operation::swap, {0})), "name two shells with an edge in common");
  EXPECT_EQ(task.refusal(task.does(Operation::move, {0})), "nodes are moved by translate, lift, slide or rotate");
  Rules rules;
  rules.shell = [](ShellIndex) { return std::uint8_t{kIndivisible}; };
  EXPECT_EQ(task.refusal(task.does(Operation::split, {14}, {}, rules)), "shell 115: a shell there can't be divided");
  rules = {};
  rules.may_divide = [](NodeIndex, NodeIndex) { return false; };
  EXPECT_EQ(task.refusal(task.does(Operation::split, {14, 15}, {}, rules)),
            "shell 115 and shell 116: no node can come between two nodes there");
  rules = {};
  rules.node = [](NodeIndex) { return std::uint8_t{kNeeded}; };
  EXPECT_EQ(task.refusal(task.does(Operation::collapse, {14}, {}, rules)),
            "the edge from node 17 to node 18: both nodes hold the part's shape or are needed by something else");
}

TEST(ByHand, keeps_parts_apart) {
  ManualTask task = flat_hand();
  task.model.shell_parts.set(15, PartIndex(std::size_t{1}));
  EXPECT_EQ(task.refusal(task.does(Operation::swap, {14, 15})), "shell 115 and shell 116: the edge between them has to stay");
}

}  // namespace
}  // namespace prismesh::mesh::repair
