#include "mesh/model/model.h"

#include <set>

#include <gtest/gtest.h>

#include "mesh/model/topology_change.h"

namespace prismesh::mesh {
namespace {

TEST(ChunkedArray, shares_until_written) {
  ChunkedArray<int> a(3 * kChunkSize + 5, 7);
  EXPECT_EQ(a.chunk_count(), 4u);
  EXPECT_EQ(a.chunk(3).size(), 5u);
  ChunkedArray<int> b = a;
  for (std::size_t c = 0; c < 4; ++c) EXPECT_TRUE(a.shares_chunk(b, c));
  b.set(kChunkSize, 8);
  EXPECT_TRUE(a.shares_chunk(b, 0));
  EXPECT_FALSE(a.shares_chunk(b, 1));
  EXPECT_EQ(a[kChunkSize], 7);
  EXPECT_EQ(b[kChunkSize], 8);
  EXPECT_EQ(b[kChunkSize + 1], 7);
}

TEST(ChunkedArray, grows_and_shrinks) {
  ChunkedArray<int> a(10, 1);
  a.resize(kChunkSize + 10, 2);
  EXPECT_EQ(a[9], 1);
  EXPECT_EQ(a[10], 2);
  EXPECT_EQ(a[kChunkSize + 9], 2);
  a.resize(3);
  EXPECT_EQ(a.chunk_count(), 1u);
  a.resize(5, 9);
  EXPECT_EQ(a[2], 1);
  EXPECT_EQ(a[3], 9);
}

TEST(Model, tells_which_nodes_moved) {
  Model a;
  a.positions.resize(3 * kChunkSize, Vec3(1, 2, 3));
  Model b = a;
  EXPECT_TRUE(moved_nodes(a, b).empty());
  b.positions.set(2 * kChunkSize + 1, Vec3(1, 2, 4));
  b.positions.set(5, Vec3(0, 2, 3));
  b.positions.set(6, Vec3(1, 2, 3));
  EXPECT_EQ(moved_nodes(a, b), (std::vector<NodeIndex>{NodeIndex(5), NodeIndex(2 * kChunkSize + 1)}));
  EXPECT_EQ(moved_nodes(b, a), moved_nodes(a, b));
}

TEST(Model, no_node_has_moved_that_one_of_the_states_lacks) {
  Model a;
  a.positions.resize(5, Vec3(1, 2, 3));
  a.node_ids.resize(5);
  for (std::size_t n = 0; n < 5; ++n) a.node_ids.set(n, static_cast<std::int64_t>(n) + 1);
  a.node_holds.resize(5);
  a.node_index = std::make_shared<const IdIndex>(std::vector<std::int64_t>{1, 2, 3, 4, 5});
  Model b = a;
  for (const std::size_t n : {0U, 1U}) b.positions.set(n, Vec3(0, 0, 0));
  remove_node(b, NodeIndex(1));
  add_node(b, 6, Vec3(9, 9, 9), edge_origin(NodeIndex(2), NodeIndex(3)));
  EXPECT_EQ(moved_nodes(a, b), std::vector<NodeIndex>{NodeIndex(0)});
  EXPECT_EQ(moved_nodes(b, a), std::vector<NodeIndex>{NodeIndex(0)});
}

TEST(Model, says_why_each_kind_of_node_is_held) {
  for (const auto& [hold, word] :
       {std::pair(kHeldByParameter, "parameter"), std::pair(kHeldByInclude, "include"), std::pair(kHeldByFrame, "coordinate system"),
        std::pair(kHeldByMaking, "one card makes it"), std::pair(kHeldByMissing, "isn't defined")})
    EXPECT_NE(why_held(hold).find(word), std::string_view::npos) << word;
}

TEST(Model, finds_parts_by_their_id) {
  Model model;
  auto parts = std::make_shared<std::vector<Part>>(3);
  (*parts)[0].id = 3;
  (*parts)[1].id = 10;
  (*parts)[2].id = 4000000000;
  model.parts = parts;
  EXPECT_EQ(model.find_part(3), PartIndex(0));
  EXPECT_EQ(model.find_part(4000000000), PartIndex(2));
  EXPECT_FALSE(model.find_part(4).valid());
  EXPECT_FALSE(model.find_part(5000000000).valid());
}

TEST(Model, element_classes_have_names_of_their_own) {
  std::set<std::string_view> names;
  for (int c = 0; c < kElementClassCount; ++c) names.insert(name(static_cast<ElementClass>(c)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kElementClassCount));
}

}  // namespace
}  // namespace prismesh::mesh
