// One change in the place of several makes the same mesh.
#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/quality/criteria.h"
#include "mesh/repair/compose.h"
#include "mesh/repair/manual_operation.h"
#include "tests/mesh/repair/sheets.h"

namespace prismesh::mesh::repair {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

using Corner = std::array<double, 3>;

/// The shells as the places of their corners, each beginning with the lowest; ascending.
std::vector<std::vector<Corner>> outlines_of(const Model& model) {
  std::vector<std::vector<Corner>> outlines;
  for (const ShellIndex shell : all_shells(model)) {
    std::vector<Corner> outline;
    const ShellNodes nodes = model.shell(shell);
    for (int c = 0; c < nodes.corners(); ++c) {
      const Vec3& position = model.position(nodes.node[static_cast<std::size_t>(c)]);
      outline.push_back({position.x(), position.y(), position.z()});
    }
    std::rotate(outline.begin(), std::min_element(outline.begin(), outline.end()), outline.end());
    outlines.push_back(outline);
  }
  std::sort(outlines.begin(), outlines.end());
  return outlines;
}

/// A single operation at a place by chance; empty: it isn't possible there.
Restructuring random_operation(const Model& model, std::mt19937& random) {
  const relax::ReferenceSurface surface(model, all_shells(model), 30);
  const ShellSet shells = all_shells(model);
  const ShellIndex shell = shells[random() % shells.size()];
  const ShellNodes nodes = model.shell(shell);
  const std::size_t c = random() % static_cast<std::size_t>(nodes.corners());
  const NodeIndex a = nodes.node[c], b = nodes.node[(c + 1) % static_cast<std::size_t>(nodes.corners())];
  const auto operation = static_cast<Operation>(random() % 4);
  ShellSet on_shells;
  NodeSet on_nodes;
  if (operation == Operation::collapse)
    on_nodes = {std::min(a, b), std::max(a, b)};
  else
    on_shells = {shell};
  // A split of two shells makes a new node.
  if (operation == Operation::merge || operation == Operation::swap || (operation == Operation::split && random() % 2 == 0))
    for (const ShellIndex other : model.adjacency->shells_of(model.adjacency->find_edge(a, b)))
      if (other != shell) on_shells.push_back(other);
  const auto change =
      apply_manual_operation({model, surface, {}, {quality::default_criteria(), 1.0}, {}}, {operation, on_shells, on_nodes});
  return change ? *change : Restructuring();
}

void expect_origins_are_whole(const Model& model, const Restructuring& change) {
  for (std::size_t i = 0; i < change.new_nodes.size(); ++i) {
    const NodeOrigin& origin = change.new_nodes[i].origin;
    ASSERT_GT(origin.count(), 0);
    double sum = 0;
    for (std::size_t p = 0; p < static_cast<std::size_t>(origin.count()); ++p) {
      EXPECT_LT(origin.parent[p].value, model.node_count() + i) << "a parent comes before its child";
      sum += origin.weight[p];
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
  for (const NewShell& shell : change.new_shells) EXPECT_LT(shell.parent.value, model.shell_count());
}

TEST(Compose, makes_the_mesh_of_several_changes_in_turn) {
  std::size_t vanished = 0, operations = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Grid grid = flat(5, 5);
    const Model model = model_of(grid.positions(), grid.shells());
    Restructuring all;
    Model now = model;
    for (int step = 0; step < 12; ++step) {
      const Restructuring next = random_operation(now, random);
      if (next.empty()) continue;
      ++operations;
      const Composition both = compose(model, all, next);
      vanished += static_cast<std::size_t>(std::count(both.new_node_index.begin(), both.new_node_index.end(), NodeIndex()));
      const Model in_turn = carried_out(now, next);
      expect_origins_are_whole(model, both.change);
      all = both.change;
      now = carried_out(model, all);
      ASSERT_EQ(outlines_of(now), outlines_of(in_turn));
      ASSERT_EQ(live_nodes(now), live_nodes(in_turn));
    }
  }
  EXPECT_GT(operations, 100U);
  EXPECT_GT(vanished, 5U) << "some new nodes were removed again";
}

TEST(Compose, of_an_operation_and_its_reverse_is_empty) {
  const Grid grid = flat(2, 1);
  const Model model = model_of(grid.positions(), grid.shells());
  Restructuring split, merged;
  const std::array<NodeIndex, 4> quad = model.shell(shell_at(0)).node;
  split.reshaped = {{shell_at(0), {{quad[0], quad[1], quad[2], quad[2]}}}};
  split.new_shells = {{{{quad[0], quad[2], quad[3], quad[3]}}, shell_at(0)}};
  merged.reshaped = {{shell_at(0), {quad}}};
  merged.removed_shells = {shell_at(2)};
  const Composition both = compose(model, split, merged);
  EXPECT_TRUE(both.change.empty());
  EXPECT_THAT(both.new_shell_index, ElementsAre(ShellIndex()));
}

TEST(Compose, gives_a_removed_shells_card_to_the_first_new_one_that_comes_from_it) {
  const Grid grid = flat(2, 1);
  const Model model = model_of(grid.positions(), grid.shells());
  const std::array<NodeIndex, 4> quad = model.shell(shell_at(0)).node;
  Restructuring split, removed;
  split.reshaped = {{shell_at(0), {{quad[0], quad[1], quad[2], quad[2]}}}};
  split.new_shells = {{{{quad[0], quad[2], quad[3], quad[3]}}, shell_at(0)}};
  removed.removed_shells = {shell_at(0)};
  const Composition both = compose(model, split, removed);
  EXPECT_THAT(both.change.removed_shells, IsEmpty());
  EXPECT_THAT(both.change.new_shells, IsEmpty());
  ASSERT_EQ(both.change.reshaped.size(), 1U);
  EXPECT_EQ(both.change.reshaped[0].second, split.new_shells[0].nodes);
  EXPECT_THAT(both.new_shell_index, ElementsAre(shell_at(0)));
}

TEST(Compose, takes_what_came_from_a_removed_new_node_from_its_parents) {
  const Grid grid = flat(2, 1);
  const Model model = model_of(grid.positions(), grid.shells());
  Restructuring first, second;
  first.new_nodes = {{Vec3(0.5, 0, 0), edge_origin(at(0), at(1))}};
  second.new_nodes = {{Vec3(0.25, 0, 0), edge_origin(at(0), at(6), 0.5)}};
  second.removed_nodes = {at(6)};
  const Composition both = compose(model, first, second);
  ASSERT_EQ(both.change.new_nodes.size(), 1U);
  const NodeOrigin& origin = both.change.new_nodes[0].origin;
  EXPECT_EQ(origin.parent[0], at(0));
  EXPECT_DOUBLE_EQ(origin.weight[0], 0.75);
  EXPECT_EQ(origin.parent[1], at(1));
  EXPECT_THAT(both.new_node_index, ElementsAre(NodeIndex(), at(6)));
  EXPECT_THAT(both.change.removed_nodes, IsEmpty());
}

}  // namespace
}  // namespace prismesh::mesh::repair
