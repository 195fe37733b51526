// Passes of a repair: relaxing makes no shell worse, and triangles that no operation touched stay.
#include "mesh/repair/passes.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "tests/mesh/repair/patch_fixture.h"
#include "tests/mesh/repair/validator.h"

namespace prismesh::mesh::repair {
namespace {

/// A flat sheet whose inner nodes are shaken.
Model shaken_sheet(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shake(-0.5, 0.5);
  const Grid grid = flat(16, 16);
  std::vector<Vec3> positions = grid.positions();
  for (std::size_t j = 1; j < grid.rows; ++j)
    for (std::size_t i = 1; i < grid.columns; ++i) positions[grid.node(i, j)] += Vec3(shake(random), shake(random), 0);
  return model_of(positions, grid.shells());
}

TEST(RelaxNeighbourhood, moves_nodes_and_makes_no_shell_worse) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    PatchFixture sheet(shaken_sheet(seed));
    Patch& patch = sheet.patch;
    std::vector<LocalShell> all;
    for (std::size_t s = 0; s < patch.shell_count(); ++s) all.emplace_back(s);
    patch.begin();
    judge_shells(sheet.context, all);
    patch.keep();
    std::vector<quality::Grade> before;
    for (const LocalShell shell : all) before.push_back(patch.shell(shell).state.grade());
    const Progress none;
    RepairState state{.history = {}, .record = {}, .progress = {none}};
    state.history.in_scope.assign(patch.shell_count(), 1);
    relax_neighbourhood(sheet.context, state);
    EXPECT_EQ(state.relaxing_refused_at, std::nullopt) << "seed " << seed << ": all was taken back";
    EXPECT_EQ(state.history.changes, 1u) << "seed " << seed;
    for (const LocalShell shell : all) EXPECT_LE(patch.shell(shell).state.grade(), before[shell.value]) << "seed " << seed;
  }
}

TEST(MaxMoves, count_from_the_model_that_the_options_name) {
  const Grid grid = flat(16, 16);
  const Model from = model_of(grid.positions(), grid.shells());
  constexpr double kMax = 0.3;
  for (unsigned seed = 0; seed < 3; ++seed) {
    const Model bad = shaken_sheet(seed);
    const relax::ReferenceSurface surface(bad, all_shells(bad), 30);
    Options options;
    options.moves_from = &from;
    options.relax.max_move_on_surface = options.relax.max_move_on_line = kMax;
    const auto repaired = repair({bad, surface, {}, {quality::default_criteria(), 1.0}, options}, all_shells(bad));
    ASSERT_TRUE(repaired.has_value());
    EXPECT_GT(repaired->change.moved.size(), 20U);
    for (const auto& [node, place] : repaired->change.moved) EXPECT_LE((place - from.position(node)).norm(), kMax + 1e-9) << seed;
  }
}

/// A flat sheet of triangles with one inner node moved far along the sheet.
Model triangles_with_a_bad_node(const Grid& grid) {
  std::vector<Vec3> positions = grid.positions();
  positions[grid.node(8, 8)] += Vec3(0.75, 0.1, 0);
  std::vector<std::array<std::size_t, 4>> shells;
  for (const auto& q : grid.shells()) {
    shells.push_back({q[0], q[1], q[2], q[2]});
    shells.push_back({q[0], q[2], q[3], q[3]});
  }
  return model_of(positions, shells);
}

TEST(TidyTriangles, leaves_a_mesh_of_triangles_as_it_is_away_from_bad_ones) {
  const Grid grid = flat(16, 16);
  const Model bad = triangles_with_a_bad_node(grid);
  const relax::ReferenceSurface surface(bad, all_shells(bad), 30);
  const Options options;
  const auto repaired = repair({bad, surface, {}, {quality::default_criteria(), 1.0}, options}, all_shells(bad));
  ASSERT_TRUE(repaired.has_value());
  const Model after = carried_out(bad, repaired->change);
  EXPECT_EQ(what_is_wrong(after), "");
  EXPECT_TRUE(repaired->unrepaired.empty());
  EXPECT_GE(triangles(after), triangles(bad) - 40) << "of 512 triangles those at the bad node may be joined";
}

}  // namespace
}  // namespace prismesh::mesh::repair
