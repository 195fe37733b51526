// Nodes with too many triangles: of patches in quads, fans and meshes of triangles, whose counts are known.
#include "mesh/quality/triangle_clusters.h"

#include <gtest/gtest.h>

#include "mesh/model/topology_change.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::quality {
namespace {

using test::ShellSpec;

/// A plate of n x n quads of which those with is_cut(i, j) are two triangles, all along the same diagonal; part 1, or 2 where is_second.
Model cut_plate(int n, const std::function<bool(int, int)>& is_cut, const std::function<bool(int, int)>& is_second = {}) {
  std::vector<test::NodeSpec> nodes;
  std::vector<ShellSpec> shells;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) nodes.push_back({1 + i + j * (n + 1), Vec3(10 * i, 10 * j, 0)});
  const auto add = [&](std::int64_t part, std::vector<std::int64_t> corners) {
    shells.push_back({static_cast<std::int64_t>(shells.size()) + 1, part, std::move(corners)});
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const std::int64_t a = 1 + i + j * (n + 1), b = a + n + 1, part = is_second && is_second(i, j) ? 2 : 1;
      if (!is_cut(i, j)) {
        add(part, {a, a + 1, b + 1, b});
        continue;
      }
      add(part, {a, a + 1, b + 1});
      add(part, {a, b + 1, b});
    }
  return test::make_model(nodes, shells);
}

/// The ids of the clusters' nodes.
std::vector<std::int64_t> ids_of(const Model& model, const TriangleClusters& clusters) {
  std::vector<std::int64_t> ids;
  for (const TriangleCluster& cluster : clusters) ids.push_back(model.node_ids[cluster.node.value]);
  return ids;
}

bool in_patch(int i, int j) { return i >= 3 && i < 7 && j >= 3 && j < 7; }

TEST(TriangleClusters, a_patch_of_32_triangles_in_quads_has_nine) {
  const Model model = cut_plate(10, in_patch);
  ASSERT_EQ(model.shell_count(), 116u);
  const TriangleClusters found = find_triangle_clusters(model, 3);
  std::vector<std::int64_t> inside;
  for (int j = 4; j <= 6; ++j)
    for (int i = 4; i <= 6; ++i) inside.push_back(1 + i + 11 * j);
  EXPECT_EQ(ids_of(model, found), inside) << "six triangles about each node inside the patch, three at most on its rim";
  for (const TriangleCluster& cluster : found) {
    EXPECT_EQ(cluster.triangles, 6u);
    EXPECT_TRUE(model.shell(cluster.shell).is_triangle());
    EXPECT_EQ(model.shell(cluster.shell).node[cluster.corner], cluster.node);
  }
  EXPECT_TRUE(find_triangle_clusters(model, 6).empty());
  EXPECT_EQ(find_triangle_clusters(model, 5.5).size(), 9u);
}

TEST(TriangleClusters, only_the_given_triangles_count) {
  const Model model = cut_plate(10, in_patch);
  const ShellSet about = [&] {
    const auto shells = model.adjacency->shells_of(test::grid_node(10, 5, 5));
    return ShellSet(shells.begin(), shells.end());
  }();
  EXPECT_EQ(ids_of(model, find_triangle_clusters(model, 3, &about)), (std::vector<std::int64_t>{1 + 5 + 55}));
}

TEST(TriangleClusters, a_part_of_three_quarters_triangles_is_a_mesh_of_triangles) {
  // 2 t triangles and 16 - t quads: t = 9 makes 18 of 25, 72 %; t = 10 makes 20 of 26, 77 %.
  for (const auto& [cut, is_meant] : {std::pair(9, false), {10, true}, {16, true}, {0, false}}) {
    const Model model = cut_plate(4, [cut = cut](int i, int j) { return i + 4 * j < cut; });
    EXPECT_EQ(meshes_of_triangles(model)[0] != 0, is_meant) << cut;
    EXPECT_EQ(find_triangle_clusters(model, 3).empty(), is_meant || cut == 0) << cut;
  }
}

TEST(TriangleClusters, triangles_of_a_mesh_of_triangles_do_not_count_in_the_part_beside_it) {
  // Left half: part 2, of triangles alone. Right of it one quad of part 1 is cut: its triangles alone count.
  const auto is_left = [](int i, int) { return i < 4; };
  const Model one = cut_plate(
      8, [&](int i, int j) { return is_left(i, j) || (i == 4 && j == 4); }, is_left);
  EXPECT_TRUE(find_triangle_clusters(one, 3).empty());
  EXPECT_TRUE(find_triangle_clusters(one, 2).empty()) << "three of part 2 and two of part 1 at the border's node";
  EXPECT_EQ(find_triangle_clusters(one, 1).size(), 2u) << "both ends of the cut quad's diagonal";
}

TEST(TriangleClusters, removed_shells_and_those_without_a_part_do_no_harm) {
  Model model = cut_plate(10, in_patch);
  for (std::size_t s = 0; s < model.shell_count(); ++s) model.shell_parts.set(s, PartIndex());
  EXPECT_EQ(find_triangle_clusters(model, 3).size(), 9u);
  ShellSet at_centre;
  for (const ShellIndex shell : model.adjacency->shells_of(test::grid_node(10, 5, 5))) at_centre.push_back(shell);
  for (std::size_t i = 0; i < 3; ++i) remove_shell(model, at_centre[i]);
  for (const TriangleCluster& cluster : find_triangle_clusters(model, 3)) EXPECT_NE(cluster.node, test::grid_node(10, 5, 5));
}

}  // namespace
}  // namespace prismesh::mesh::quality
