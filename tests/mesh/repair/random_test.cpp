// Random meshes, random rules: nothing forbidden is touched, the mesh stays whole, the worst shell isn't worse.
#include <algorithm>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "mesh/quality/judge.h"
#include "mesh/quality/measure.h"
#include "mesh/quality/report.h"
#include "mesh/relax/freedom.h"
#include "tests/mesh/repair/sheets.h"
#include "tests/mesh/repair/validator.h"

namespace prismesh::mesh::repair {
namespace {

struct Shaken {
  Model model;
  Grid grid;
};

/// A sheet whose inner nodes are shaken hard, some of whose quads are triangles.
Shaken shaken(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shake(-0.45, 0.45);
  const Grid grid = seed % 3 == 0 ? flat(9, 8) : seed % 3 == 1 ? cylinder() : l_profile();
  const Grid still = grid;
  std::vector<Vec3> positions = grid.positions();
  const auto shells_of_grid = grid.shells();
  std::vector<int> uses(positions.size(), 0);
  for (const auto& shell : shells_of_grid)
    for (const std::size_t node : shell) ++uses[node];
  for (std::size_t j = 1; j < grid.rows; ++j)
    for (std::size_t i = 1; i < grid.columns; ++i) {
      if (uses[grid.node(i, j)] != 4 || (seed % 3 == 2 && i == 8)) continue;  // free edges and the crease keep their shape
      const double dx = shake(random), dy = shake(random);
      const bool near_crease = seed % 3 == 2 && (i == 7 || i == 9);
      positions[grid.node(i, j)] = grid.place(static_cast<double>(i) + (near_crease ? 0 : dx), static_cast<double>(j) + dy);
    }
  std::vector<std::array<std::size_t, 4>> shells;
  for (const auto& q : shells_of_grid) {
    if (random() % 8 == 0) {
      shells.push_back({q[0], q[1], q[2], q[2]});
      shells.push_back({q[0], q[2], q[3], q[3]});
    } else {
      shells.push_back(q);
    }
  }
  return {model_of(positions, shells), still};
}

NodeSet every_node(const Model& model) {
  NodeSet nodes;
  for (std::size_t n = 0; n < model.node_count(); ++n) nodes.emplace_back(n);
  return nodes;
}

bool fails(const Model& model, ShellIndex shell) {
  std::vector<Vec3> corners;
  for (int i = 0; i < model.shell(shell).corners(); ++i)
    corners.push_back(model.position(model.shell(shell).node[static_cast<std::size_t>(i)]));
  return quality::judge(quality::measure(corners), {quality::default_criteria(), 1.0}).fail != 0;
}

ShellSet failing_shells(const Model& model) {
  ShellSet shells = all_shells(model);
  std::erase_if(shells, [&](ShellIndex shell) { return !fails(model, shell); });
  return shells;
}

std::size_t failing(const Model& model) { return failing_shells(model).size(); }

/// What is told to be left are the shells of the result that fail, ascending, each with a reason.
void expect_left_is_what_fails(const Repaired& repaired, const Model& after) {
  ShellSet told;
  for (const Unrepaired& left : repaired.unrepaired) {
    told.push_back(left.shell);
    EXPECT_FALSE(left.why.empty()) << left.shell.value;
  }
  EXPECT_EQ(told, failing_shells(after));
}

void expect_none_fails_that_did_not(const Model& before, const Model& after) {
  for (std::size_t s = 0; s < before.shell_count(); ++s)
    if (!after.is_removed(ShellIndex(s)) && !fails(before, ShellIndex(s))) {
      EXPECT_FALSE(fails(after, ShellIndex(s))) << s;
    }
}

class Random : public testing::TestWithParam<unsigned> {};

TEST_P(Random, shaking_is_repaired_and_the_sheet_stays_whole) {
  const Shaken sheet = shaken(GetParam());
  const Model good = model_of(sheet.grid.positions(), sheet.grid.shells());
  const relax::ReferenceSurface surface(good, all_shells(good), 30);
  const auto repaired = repair({sheet.model, surface, {}, {quality::default_criteria(), 1.0}, {}}, all_shells(sheet.model));
  ASSERT_TRUE(repaired.has_value());
  const Model next = carried_out(sheet.model, repaired->change);
  const Shape a = shape_of(sheet.model), b = shape_of(next);
  EXPECT_EQ(what_is_wrong(next), "");
  EXPECT_EQ(a.euler, b.euler);
  EXPECT_EQ(a.free_loops, b.free_loops);
  EXPECT_EQ(a.pieces, b.pieces);
  // On the tube's ends a new node lies on the arc, not on its chord.
  EXPECT_NEAR(a.free_length, b.free_length, (GetParam() % 3 == 1 ? 1e-3 : 1e-9) * a.free_length);
  EXPECT_LE(failing(next), failing(sheet.model) / 10);
  EXPECT_EQ(repaired->bad_before > 0, !repaired->change.empty());
  EXPECT_EQ(repaired->relaxed, repaired->change.moved.size());
  expect_left_is_what_fails(*repaired, next);
  expect_none_fails_that_did_not(sheet.model, next);
}

/// What a seed forbids of each node and shell.
struct Forbidden {
  std::vector<std::uint8_t> node, shell;
  std::set<std::pair<NodeIndex, NodeIndex>> edges;

  Forbidden(const Model& model, unsigned seed) {
    std::mt19937 random(seed + 1000);
    for (std::size_t n = 0; n < model.node_count(); ++n) node.push_back(static_cast<std::uint8_t>(random() % 3 == 0 ? random() % 4 : 0));
    for (std::size_t s = 0; s < model.shell_count(); ++s) shell.push_back(static_cast<std::uint8_t>(random() % 3 == 0 ? random() % 16 : 0));
    for (const ShellIndex s : all_shells(model))
      for (std::size_t c = 0; c < 4; ++c)
        if (random() % 5 == 0) edges.insert(std::minmax(model.shell(s).node[c], model.shell(s).node[(c + 1) % 4]));
  }
  Rules rules() const {
    return {[this](NodeIndex n) { return node[n.value]; }, [this](ShellIndex s) { return shell[s.value]; },
            [this](NodeIndex a, NodeIndex b) { return edges.count(std::minmax(a, b)) == 0; }};
  }
};

TEST_P(Random, nothing_forbidden_is_touched) {
  const Shaken sheet = shaken(GetParam());
  const Model good = model_of(sheet.grid.positions(), sheet.grid.shells());
  const relax::ReferenceSurface surface(good, all_shells(good), 30);
  const Forbidden forbidden(sheet.model, GetParam());
  const auto repaired = repair({sheet.model, surface, forbidden.rules(), {quality::default_criteria(), 1.0}, {}}, all_shells(sheet.model));
  ASSERT_TRUE(repaired.has_value());
  const Restructuring& change = repaired->change;
  EXPECT_FALSE(change.empty());
  for (const auto& [node, position] : change.moved) EXPECT_EQ(forbidden.node[node.value] & kStays, 0);
  for (const NodeIndex node : change.removed_nodes) EXPECT_EQ(forbidden.node[node.value] & kNeeded, 0);
  for (const ShellIndex shell : change.removed_shells) EXPECT_EQ(forbidden.shell[shell.value] & kLasting, 0);
  for (const NewShell& shell : change.new_shells) EXPECT_EQ(forbidden.shell[shell.parent.value] & kIndivisible, 0);
  for (const auto& [shell, nodes] : change.reshaped) {
    EXPECT_EQ(forbidden.shell[shell.value] & kKeepsNodes, 0);
    if (nodes.is_triangle() != sheet.model.shell(shell).is_triangle()) {
      EXPECT_EQ(forbidden.shell[shell.value] & kNoTriangle, 0);
    }
  }
  for (const NewNode& node : change.new_nodes) {
    const NodeIndex a = node.origin.parent[0], b = node.origin.parent[1];
    const bool is_on_edge = node.origin.count() == 2 && a.value < sheet.model.node_count() && b.value < sheet.model.node_count();
    EXPECT_FALSE(is_on_edge && forbidden.edges.count(std::minmax(a, b)) != 0);
  }
  const Model next = carried_out(sheet.model, change);
  EXPECT_EQ(what_is_wrong(next), "");
  EXPECT_EQ(shape_of(sheet.model).euler, shape_of(next).euler);
  expect_left_is_what_fails(*repaired, next);
  expect_none_fails_that_did_not(sheet.model, next);
}

INSTANTIATE_TEST_SUITE_P(Repair, Random, testing::Range(0U, 6U));

TEST(Limits, no_node_goes_farther_than_it_may_however_often_it_moves) {
  for (const unsigned seed : {0U, 3U}) {
    const Shaken sheet = shaken(seed);
    const Model good = model_of(sheet.grid.positions(), sheet.grid.shells());
    const relax::ReferenceSurface surface(good, all_shells(good), 30);
    const quality::SizedCriteria criteria{quality::default_criteria(), 1.0};
    Options options;
    options.relax.max_move_on_surface = 0.1;
    options.relax.max_move_on_line = 0.02;
    options.max_rounds = 3;
    const auto repaired = repair({sheet.model, surface, {}, criteria, options}, all_shells(sheet.model));
    ASSERT_TRUE(repaired.has_value());
    EXPECT_FALSE(repaired->change.moved.empty());
    const std::vector<relax::Freedom> freedoms = relax::node_freedoms(good, every_node(good), 30);
    double on_surface = 0, on_line = 0;
    for (const auto& [node, position] : repaired->change.moved) {
      double& farthest = freedoms[node.value] == relax::Freedom::surface ? on_surface : on_line;
      farthest = std::max(farthest, (position - sheet.model.position(node)).norm());
    }
    EXPECT_LE(on_surface, 0.1 + 1e-12) << seed;
    EXPECT_LE(on_line, 0.02 + 1e-12) << seed;
  }
}

TEST(Limits, no_more_triangles_than_their_share_or_than_there_were) {
  const auto triangles_of = [](const Model& model) {
    std::size_t count = 0;
    for (std::size_t s = 0; s < model.shell_count(); ++s)
      if (!model.is_removed(shell_at(s)) && model.shell(shell_at(s)).is_triangle()) ++count;
    return count;
  };
  // Corners that are meant to stand out of the sheet: quads there warp, whatever the places.
  const Grid grid = flat(12, 12);
  std::vector<Vec3> positions = grid.positions();
  for (const auto& [i, j] : {std::pair(3U, 3U), {8U, 3U}, {3U, 8U}, {8U, 8U}, {5U, 6U}})
    positions[grid.node(i, j)] += Vec3(0.25, 0.1, 0.25);
  const Model bad = model_of(positions, grid.shells());
  const relax::ReferenceSurface surface(bad, all_shells(bad), 30);
  std::map<double, std::size_t> triangles;
  for (const double percent : {0.0, 2.0, 50.0}) {
    Options options;
    options.max_triangles_percent = percent;
    const auto repaired = repair({bad, surface, {}, {quality::default_criteria(), 1.0}, options}, all_shells(bad));
    ASSERT_TRUE(repaired.has_value());
    triangles[percent] = triangles_of(carried_out(bad, repaired->change));
  }
  EXPECT_EQ(triangles[0], 0u);
  EXPECT_LE(triangles[2], 2u) << "2 % of 144";
  EXPECT_GT(triangles[50], 2u) << "with more allowed more are made";
}

TEST(Bad, input_is_left_alone_and_said) {
  const Grid grid = flat(8, 8);
  std::vector<Vec3> positions = grid.positions();
  auto shells = grid.shells();
  positions[grid.node(2, 2)] = Vec3(std::nan(""), 0, 0);
  shells[grid.shell(5, 5)] = {grid.node(5, 5), grid.node(6, 5), grid.node(5, 5), grid.node(5, 6)};
  positions[grid.node(6, 2)] = positions[grid.node(7, 2)];
  const Model model = model_of(positions, shells);
  const Model good = model_of(grid.positions(), grid.shells());
  const relax::ReferenceSurface surface(good, all_shells(good), 30);
  const auto repaired = repair({model, surface, {}, {quality::default_criteria(), 1.0}, {}}, all_shells(model));
  ASSERT_TRUE(repaired.has_value());
  EXPECT_FALSE(repaired->unrepaired.empty());
  for (const auto& [node, position] : repaired->change.moved) EXPECT_TRUE(position.allFinite());
  for (const NewNode& node : repaired->change.new_nodes) EXPECT_TRUE(node.position.allFinite());
  for (const Unrepaired& left : repaired->unrepaired) EXPECT_FALSE(left.why.empty());
}

}  // namespace
}  // namespace prismesh::mesh::repair
