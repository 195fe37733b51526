// Lines of elements that aren't shells, each kind by the edges it has.
#include <algorithm>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/model/element_lines.h"

namespace prismesh::mesh {
namespace {

using Edges = std::set<std::pair<std::size_t, std::size_t>>;

/// Elements of one kind, each by its nodes; of part 5 and following.
Model model_of(ElementClass kind, const std::vector<std::vector<std::size_t>>& elements) {
  auto block = std::make_shared<ElementBlock>();
  for (const std::vector<std::size_t>& nodes : elements) {
    block->part.push_back(PartIndex(5 + block->id.size()));
    block->id.push_back(static_cast<std::int64_t>(block->id.size() + 1));
    for (const std::size_t node : nodes) block->nodes.push_back(NodeIndex(node));
    block->first_node.push_back(static_cast<std::uint32_t>(block->nodes.size()));
  }
  Model model;
  for (auto& each : model.elements) each = std::make_shared<const ElementBlock>();
  model.elements[static_cast<std::size_t>(kind)] = block;
  return model;
}

Edges edges_of(const Model& model) {
  const ElementLines lines = element_lines(model);
  Edges edges;
  for (std::size_t i = 0; i < lines.parts.size(); ++i) edges.emplace(lines.nodes[2 * i].value, lines.nodes[2 * i + 1].value);
  EXPECT_EQ(edges.size(), lines.parts.size()) << "an edge is there twice";
  EXPECT_EQ(lines.nodes.size(), 2 * lines.parts.size());
  return edges;
}

Edges solid(const std::vector<std::size_t>& nodes) { return edges_of(model_of(ElementClass::solid, {nodes})); }

const Edges kTetrahedron{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
const Edges kWedge{{0, 1}, {1, 2}, {0, 2}, {3, 4}, {4, 5}, {3, 5}, {0, 3}, {1, 4}, {2, 5}};
const Edges kBrick{{0, 1}, {1, 2}, {2, 3}, {0, 3}, {4, 5}, {5, 6}, {6, 7}, {4, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};

TEST(ElementLines, of_a_solid_are_the_edges_between_its_corners) {
  EXPECT_EQ(solid({0, 1, 2, 3}), kTetrahedron);
  EXPECT_EQ(solid({0, 1, 2, 3, 3, 3, 3, 3}), kTetrahedron);
  EXPECT_EQ(solid({0, 1, 2, 3, 10, 11, 12, 13, 14, 15}), kTetrahedron) << "mid-side nodes aren't corners";
  EXPECT_EQ(solid({0, 1, 2, 3, 4, 5}), kWedge);
  EXPECT_EQ(solid({0, 1, 2, 3, 4, 5, 10, 11, 12, 13, 14, 15, 16, 17, 18}), kWedge);
  EXPECT_EQ(solid({0, 1, 2, 3, 4, 5, 6, 7}), kBrick);
  EXPECT_EQ(solid({0, 1, 2, 3, 4, 5, 6, 7, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21}), kBrick);
  EXPECT_EQ(solid({0, 1, 2, 3, 4, 4, 4, 4}), (Edges{{0, 1}, {1, 2}, {2, 3}, {0, 3}, {0, 4}, {1, 4}, {2, 4}, {3, 4}})) << "a pyramid";
  EXPECT_EQ(solid({0, 1, 2, 3, 4}), Edges{}) << "nobody knows what it is";
}

TEST(ElementLines, leave_out_faces_between_solids_and_name_each_edges_part) {
  // Three bricks in a row: the edges round the two faces between them belong to outer faces as well.
  const Model row = model_of(ElementClass::solid, {{0, 1, 5, 4, 8, 9, 13, 12}, {1, 2, 6, 5, 9, 10, 14, 13}, {2, 3, 7, 6, 10, 11, 15, 14}});
  EXPECT_EQ(edges_of(row).size(), 28u);
  const ElementLines lines = element_lines(row);
  for (std::size_t i = 0; i < lines.parts.size(); ++i) {
    const std::size_t low = lines.nodes[2 * i].value % 4, high = lines.nodes[2 * i + 1].value % 4;
    if (low == high && low % 3 == 0) {
      EXPECT_EQ(lines.parts[i].value, low == 0 ? 5u : 7u) << "at either end";
    }
  }
  // Around an inner edge of four bricks every face is shared: the edge isn't drawn.
  const Model four =
      model_of(ElementClass::tshell,
               {{0, 1, 4, 3, 9, 10, 13, 12}, {1, 2, 5, 4, 10, 11, 14, 13}, {3, 4, 7, 6, 12, 13, 16, 15}, {4, 5, 8, 7, 13, 14, 17, 16}});
  const Edges edges = edges_of(four);
  EXPECT_EQ(edges.size(), 12u + 12u + 8u);
  EXPECT_FALSE(edges.contains({4, 13}));
}

TEST(ElementLines, of_bars_are_their_ends) {
  EXPECT_EQ(edges_of(model_of(ElementClass::beam, {{4, 2, 9}, {2, 3, 9}})), (Edges{{2, 4}, {2, 3}})) << "the third orients it";
  EXPECT_EQ(edges_of(model_of(ElementClass::discrete, {{1, 0}, {7, 7}, {8}})), (Edges{{0, 1}})) << "a spring to ground has one node";
}

}  // namespace
}  // namespace prismesh::mesh
