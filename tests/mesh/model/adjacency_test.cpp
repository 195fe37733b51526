#include "mesh/model/adjacency.h"

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "tests/support/make_model.h"

namespace prismesh::mesh {
namespace {

using test::make_grid;
using test::make_shells;
using Corners = std::array<int, 4>;

NodeIndex node(int i) { return NodeIndex(static_cast<std::size_t>(i)); }

std::vector<std::uint32_t> values(std::span<const ShellIndex> shells) {
  std::vector<std::uint32_t> out;
  for (const ShellIndex shell : shells) out.push_back(shell.value);
  return out;
}

/// The same table by the slowest and plainest means.
void expect_as_by_hand(const Model& model) {
  const Adjacency& adjacency = *model.adjacency;
  std::map<std::uint32_t, std::set<std::uint32_t>> around;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::set<std::uint32_t>> edges;
  for (std::uint32_t s = 0; s < model.shell_count(); ++s) {
    const auto& corner = model.shell_nodes[s].node;
    const int corners = model.shell_nodes[s].corners();
    for (int i = 0; i < corners; ++i) {
      const std::uint32_t a = corner[i].value, b = corner[(i + 1) % corners].value;
      around[a].insert(s);
      if (a != b) edges[std::minmax(a, b)].insert(s);
    }
  }
  ASSERT_EQ(adjacency.node_first.size(), model.node_count() + 1);
  ASSERT_EQ(adjacency.edge_first.size(), model.node_count() + 1);
  for (std::uint32_t n = 0; n < model.node_count(); ++n)
    EXPECT_EQ(values(adjacency.shells_of(NodeIndex(n))), std::vector<std::uint32_t>(around[n].begin(), around[n].end()));
  ASSERT_EQ(adjacency.edge_count(), edges.size());
  std::size_t e = 0;
  for (const auto& [ends, shells] : edges) {  // a map walks its keys ascending, as the table must
    const Edge edge = adjacency.edge(EdgeIndex(e));
    EXPECT_EQ(edge.low.value, ends.first);
    EXPECT_EQ(edge.high.value, ends.second);
    EXPECT_EQ(values(adjacency.shells_of(EdgeIndex(e))), std::vector<std::uint32_t>(shells.begin(), shells.end()));
    EXPECT_EQ(adjacency.find_edge(edge.low, edge.high), EdgeIndex(e));
    EXPECT_EQ(adjacency.find_edge(edge.high, edge.low), EdgeIndex(e));
    ++e;
  }
}

TEST(Adjacency, grid_has_the_edges_and_neighbours_of_a_grid) {
  const Model model = make_grid(7, 5, [](int i, int j) { return Vec3(i, j, 0); });
  EXPECT_EQ(model.adjacency->edge_count(), 7u * 6 + 8 * 5);
  expect_as_by_hand(model);
}

TEST(Adjacency, triangles_and_a_node_without_shells) {
  const Model model = make_shells({{0, 0, 0}, {1, 0, 0}, {9, 9, 9}, {1, 1, 0}, {0, 1, 0}}, {Corners{0, 1, 3, 3}, Corners{0, 3, 4, 4}});
  EXPECT_TRUE(model.adjacency->shells_of(node(2)).empty());
  EXPECT_EQ(model.adjacency->edge_count(), 5u);
  expect_as_by_hand(model);
}

TEST(Adjacency, any_number_of_sheets_meet_at_an_edge) {
  const Model model = make_shells({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}},
                                  {Corners{0, 1, 2, 2}, Corners{0, 1, 3, 3}, Corners{1, 0, 4, 4}});
  EXPECT_EQ(values(model.adjacency->shells_of(model.adjacency->find_edge(node(1), node(0)))), (std::vector<std::uint32_t>{0, 1, 2}));
  expect_as_by_hand(model);
}

TEST(Adjacency, degenerate_shells_make_no_edge_to_themselves_and_count_once) {
  const Model model = make_shells({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {Corners{0, 0, 1, 2}, Corners{0, 1, 0, 2}, Corners{1, 1, 1, 1}});
  EXPECT_EQ(values(model.adjacency->shells_of(node(0))), (std::vector<std::uint32_t>{0, 1}));
  EXPECT_FALSE(model.adjacency->find_edge(node(0), node(0)).valid());
  expect_as_by_hand(model);
}

TEST(Adjacency, no_edge_between_strangers) {
  const Model model = make_grid(2, 2, [](int i, int j) { return Vec3(i, j, 0); });
  EXPECT_FALSE(model.adjacency->find_edge(node(0), node(4)).valid());
  EXPECT_FALSE(model.adjacency->find_edge(node(0), node(8)).valid());
}

TEST(Adjacency, empty_model) {
  const Model model = make_shells({}, {});
  EXPECT_EQ(model.adjacency->edge_count(), 0u);
  expect_as_by_hand(model);
}

TEST(Adjacency, scattered_numbering_over_several_ranges) {
  std::mt19937 random(7);
  constexpr int kSide = 200;  // 40,401 nodes: more than one range of nodes
  std::vector<int> number((kSide + 1) * (kSide + 1));
  for (std::size_t i = 0; i < number.size(); ++i) number[i] = static_cast<int>(i);
  std::shuffle(number.begin(), number.end(), random);
  std::vector<Corners> shells;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const int a = j * (kSide + 1) + i;
      shells.push_back({number[a], number[a + 1], number[a + kSide + 2], number[a + kSide + 1]});
    }
  expect_as_by_hand(make_shells(std::vector<Vec3>(number.size(), Vec3::Zero()), shells));
}

TEST(Adjacency, free_edge_nodes_are_the_rim) {
  const Model model = make_grid(4, 3, [](int i, int j) { return Vec3(i, j, 0); });
  const auto is_free = free_edge_nodes(*model.adjacency, model.node_count());
  for (int j = 0; j <= 3; ++j)
    for (int i = 0; i <= 4; ++i) EXPECT_EQ(is_free[j * 5 + i] != 0, i == 0 || i == 4 || j == 0 || j == 3) << i << " " << j;
}

}  // namespace
}  // namespace prismesh::mesh
