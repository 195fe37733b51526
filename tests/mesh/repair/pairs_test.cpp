// Shells that only two triangles side by side let pass: the triangles are made, and counted.
#include "mesh/repair/repair.h"

#include <gtest/gtest.h>

#include "mesh/quality/report.h"
#include "tests/mesh/repair/sheets.h"
#include "tests/mesh/repair/validator.h"

namespace prismesh::mesh::repair {
namespace {

/// A flat plate of unit quads with one node lifted: the quads about it are warped, and the plate is meant so.
struct Tent {
  std::size_t i, j;
  double height = 0.6;
  Grid grid = flat(16, 16);

  Model model() const {
    std::vector<Vec3> positions = grid.positions();
    positions[grid.node(i, j)].z() = height;
    return model_of(positions, grid.shells());
  }
};

struct Outcome {
  Model model;
  Repaired repaired;
};
quality::Counts counts_of(const Model& model) { return quality::count(quality::judge_model(model, {quality::default_criteria(), 1.0})); }

Outcome repaired_with(const Model& bad, const Options& options, const Rules& rules = {}) {
  const relax::ReferenceSurface surface(bad, all_shells(bad), 30);
  auto repaired = repair({bad, surface, rules, {quality::default_criteria(), 1.0}, options}, all_shells(bad));
  EXPECT_TRUE(repaired.has_value());
  Model after = carried_out(bad, repaired->change);
  EXPECT_EQ(what_is_wrong(after), "");
  return {std::move(after), std::move(*repaired)};
}

/// Number of the model's triangles that have a node as a corner.
std::size_t triangles_at(const Model& model, NodeIndex node) {
  std::size_t count = 0;
  for (const ShellIndex shell : model.adjacency->shells_of(node)) count += model.shell(shell).is_triangle() ? 1 : 0;
  return count;
}

TEST(Pairs, let_the_warped_quads_about_a_lifted_node_pass) {
  const Tent tent{8, 8};
  const Model bad = tent.model();
  ASSERT_EQ(counts_of(bad).fail, 4u);
  const auto [after, repaired] = repaired_with(bad, {});
  EXPECT_EQ(counts_of(after).fail, 0u);
  EXPECT_EQ(counts_of(after).warn, 0u);
  EXPECT_TRUE(repaired.unrepaired.empty());
  EXPECT_EQ(triangles(after), 8u);
  // The diagonals from the lifted node are bent more, but as edges they would be too long, and eight triangles would meet there.
  EXPECT_EQ(triangles_at(after, at(tent.grid.node(8, 8))), 4u);
  EXPECT_EQ(repaired.triangle_pairs.size(), triangle_pairs(after));
  EXPECT_LE(repaired.triangle_pairs.size(), 4u);
  EXPECT_NEAR(after.position(at(tent.grid.node(8, 8))).z(), 0.6, 0.02);
}

TEST(Pairs, leave_a_lifted_node_where_it_is) {
  // At the lowest height so many triangles meet at the node at first that it is thinned, which must not cut it off either.
  for (const double height : {0.55, 0.62, 0.7}) {
    const Tent tent{8, 8, height};
    std::vector<Vec3> positions = tent.grid.positions();
    positions[tent.grid.node(8, 8)].z() = height;
    positions[tent.grid.node(4, 4)].x() += 1e-5;  // so that not all quads are equal
    const auto [after, repaired] = repaired_with(model_of(positions, tent.grid.shells()), {});
    EXPECT_EQ(counts_of(after).fail, 0u) << height;
    EXPECT_LE(repaired.triangle_pairs.size(), 7u) << height;
    EXPECT_NEAR(after.position(at(tent.grid.node(8, 8))).z(), height, 0.02) << height;
  }
}

TEST(Pairs, let_them_pass_at_a_free_edge_too) {
  const Tent tent{8, 0};
  const Model bad = tent.model();
  ASSERT_EQ(counts_of(bad).fail, 2u);
  const auto [after, repaired] = repaired_with(bad, {});
  EXPECT_EQ(counts_of(after).fail, 0u);
  EXPECT_TRUE(repaired.unrepaired.empty());
  EXPECT_GT(repaired.triangle_pairs.size(), 0u);
  EXPECT_LE(repaired.triangle_pairs.size(), 3u) << "as many as the halves of two quads side by side make";
  EXPECT_EQ(triangle_pairs(after), repaired.triangle_pairs.size());
  EXPECT_EQ(after.position(at(tent.grid.node(8, 0))).z(), 0.6);
}

TEST(Pairs, are_not_made_where_another_operation_helps) {
  // one quad's corner is so near the diagonal that it fails; nodes can move
  const Grid grid = flat(16, 16);
  const Model good = model_of(grid.positions(), grid.shells());
  std::vector<Vec3> positions = grid.positions();
  positions[grid.node(9, 9)] = Vec3(8.5, 8.5, 0);
  const Model bad = model_of(positions, grid.shells());
  ASSERT_GT(counts_of(bad).fail, 0u);
  const auto [after, repaired] = repaired_with(bad, {});
  EXPECT_EQ(counts_of(after).fail, 0u);
  EXPECT_EQ(repaired.triangle_pairs.size(), 0u);
  EXPECT_EQ(triangle_pairs(after), 0u);
}

TEST(Pairs, that_were_there_before_are_not_counted) {
  const Tent tent{8, 8};
  auto shells = tent.grid.shells();
  const auto q = shells[tent.grid.shell(4, 4)];
  shells[tent.grid.shell(4, 4)] = {q[0], q[1], q[2], q[2]};
  shells.push_back({q[0], q[2], q[3], q[3]});
  std::vector<Vec3> positions = tent.grid.positions();
  positions[tent.grid.node(8, 8)].z() = 0.6;
  const Model bad = model_of(positions, shells);
  ASSERT_EQ(triangle_pairs(bad), 1u);
  Rules rules;  // the two must keep their nodes, so that they aren't joined
  const ShellIndex first = shell_at(tent.grid.shell(4, 4)), second = shell_at(shells.size() - 1);
  rules.shell = [=](ShellIndex shell) { return shell == first || shell == second ? std::uint8_t{kKeepsNodes} : std::uint8_t{0}; };
  const auto [after, repaired] = repaired_with(bad, {}, rules);
  EXPECT_GT(repaired.triangle_pairs.size(), 0u);
  EXPECT_EQ(triangle_pairs(after), repaired.triangle_pairs.size() + 1);
}

TEST(Pairs, take_triangles_up_to_twice_their_share) {
  std::size_t fewest = 4;
  for (const double percent : {0.0, 1.0, 2.0}) {
    Options options;
    options.max_triangles_percent = percent;
    const auto [after, repaired] = repaired_with(Tent{8, 8}.model(), options);
    const std::size_t failing = counts_of(after).fail;
    EXPECT_LE(failing, fewest) << percent;
    EXPECT_EQ(failing, repaired.unrepaired.size());
    fewest = failing;
    EXPECT_LE(static_cast<double>(triangles(after)), 2 * percent / 100 * 256) << percent;
  }
  EXPECT_EQ(fewest, 0u);
}

}  // namespace
}  // namespace prismesh::mesh::repair
