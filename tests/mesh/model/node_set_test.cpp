#include "mesh/model/node_set.h"

#include <gtest/gtest.h>

#include "tests/support/make_model.h"

namespace prismesh::mesh {
namespace {

using test::make_grid;
using test::make_shells;
using Corners = std::array<int, 4>;

NodeSet nodes(std::initializer_list<std::size_t> indices) {
  NodeSet set;
  for (const std::size_t i : indices) set.push_back(NodeIndex(i));
  return set;
}
ShellSet shells(std::initializer_list<std::size_t> indices) {
  ShellSet set;
  for (const std::size_t i : indices) set.push_back(ShellIndex(i));
  return set;
}

// A set is gathered and sorted when it is small beside the model, marked when it is large; both must agree.
class NodeSets : public ::testing::TestWithParam<int> {
 protected:
  // the first three rows are the same in both: 4 columns, nodes 0-4, 5-9, 10-14; shells 0-3, 4-7
  Model model = make_grid(4, GetParam(), [](int i, int j) { return Vec3(i, j, 0); });
};

TEST_P(NodeSets, shells_touching_and_inside) {
  EXPECT_EQ(shells_touching(model, nodes({6})), shells({0, 1, 4, 5}));
  EXPECT_EQ(shells_touching(model, nodes({0, 1, 5, 6})), shells({0, 1, 4, 5}));
  EXPECT_EQ(shells_inside(model, nodes({0, 1, 5, 6})), shells({0}));
  EXPECT_TRUE(shells_inside(model, nodes({0, 1, 5})).empty());
  EXPECT_TRUE(shells_inside(model, nodes({0, 1, 6})).empty()) << "the last corner counts as well";
  EXPECT_TRUE(shells_touching(model, {}).empty());
  EXPECT_EQ(nodes_of(model, shells({0, 1})), nodes({0, 1, 2, 5, 6, 7}));
}
INSTANTIATE_TEST_SUITE_P(SmallAndLarge, NodeSets, ::testing::Values(3, 3000));

TEST(NodeSet, midside_nodes_belong_to_the_shell) {
  Model model =
      make_shells({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}, {0.5, 0, 0}, {1, 0.5, 0}, {0.5, 1, 0}, {0, 0.5, 0}},
                  {Corners{1, 4, 5, 2}, Corners{0, 1, 2, 3}});
  MidsideNodes midside;
  midside.shell = ShellIndex(std::size_t{1});
  for (std::size_t i = 0; i < 3; ++i) midside.node[i] = NodeIndex(6 + i);  // the fourth is absent
  model.midside = std::make_shared<const std::vector<MidsideNodes>>(1, midside);
  EXPECT_EQ(nodes_of(model, shells({0})), nodes({1, 2, 4, 5}));
  EXPECT_EQ(nodes_of(model, shells({1})), nodes({0, 1, 2, 3, 6, 7, 8}));
}

}  // namespace
}  // namespace prismesh::mesh
