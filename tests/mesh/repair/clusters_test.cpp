// Many triangles together are merged and divided anew, where no shell that passed fails.
#include "mesh/repair/clusters.h"

#include <array>
#include <cmath>
#include <random>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "mesh/quality/judge.h"
#include "mesh/quality/measure.h"
#include "mesh/quality/triangle_clusters.h"
#include "tests/mesh/repair/sheets.h"
#include "tests/mesh/repair/validator.h"

namespace prismesh::mesh::repair {
namespace {

enum class Diagonals : std::uint8_t { same, star, random };

/// The grid with two triangles for each quad with first <= i, j < last.
Model with_cut_quads(const Grid& grid, std::size_t first, std::size_t last, Diagonals diagonals, double shift = 0) {
  std::mt19937 random(7);
  std::vector<Vec3> positions = grid.positions();
  std::vector<std::array<std::size_t, 4>> shells;
  for (std::size_t j = 0; j < grid.rows; ++j)
    for (std::size_t i = 0; i < grid.columns; ++i) {
      const std::size_t a = grid.node(i, j), b = grid.node(i + 1, j), c = grid.node(i + 1, j + 1), d = grid.node(i, j + 1);
      if (i < first || j < first || i >= last || j >= last) {
        shells.push_back({a, b, c, d});
        continue;
      }
      if (i > first && j > first && shift > 0) {
        const double x = static_cast<double>(random() % 1000) / 500 - 1, y = static_cast<double>(random() % 1000) / 500 - 1;
        positions[a] = grid.place(static_cast<double>(i) + shift * x, static_cast<double>(j) + shift * y);
      }
      const bool other = diagonals == Diagonals::star ? (i + j) % 2 == 1 : diagonals == Diagonals::random && random() % 2 == 1;
      if (other) {
        shells.push_back({a, b, d, d});
        shells.push_back({b, c, d, d});
      } else {
        shells.push_back({a, b, c, c});
        shells.push_back({a, c, d, d});
      }
    }
  return model_of(positions, shells);
}

std::size_t max_triangles_at_a_node(const Model& model) {
  std::map<std::uint32_t, std::size_t> count;
  std::size_t max = 0;
  for (const ShellIndex shell : all_shells(model))
    if (model.shell(shell).is_triangle())
      for (const NodeIndex node : std::set<NodeIndex>(model.shell(shell).node.begin(), model.shell(shell).node.end()))
        max = std::max(max, ++count[node.value]);
  return max;
}

std::array<std::size_t, 3> grades(const Model& model) {
  std::array<std::size_t, 3> count{};
  for (const ShellIndex shell : all_shells(model)) {
    std::vector<Vec3> corners;
    for (int i = 0; i < model.shell(shell).corners(); ++i)
      corners.push_back(model.position(model.shell(shell).node[static_cast<std::size_t>(i)]));
    ++count[static_cast<std::size_t>(quality::judge(quality::measure(corners), {quality::default_criteria(), 1.0}).grade())];
  }
  return count;
}

struct Thinned {
  Model model;
  Repaired repaired;
};

Thinned thin(const Model& model, const Rules& rules = {}) {
  const relax::ReferenceSurface surface(model, all_shells(model), 30);
  const quality::SizedCriteria criteria{quality::default_criteria(), 1.0};
  const Options options;
  NodeSet clusters;
  for (const quality::TriangleCluster& cluster : quality::find_triangle_clusters(model, 3)) clusters.push_back(cluster.node);
  Result<Repaired> repaired = repair({model, surface, rules, criteria, options, clusters}, all_shells(model));
  EXPECT_TRUE(repaired.has_value());
  return {carried_out(model, repaired->change), std::move(*repaired)};
}

Grid bowl() {
  return {10, 10, [](double x, double y) { return Vec3(x, y, 0.02 * ((x - 5) * (x - 5) + (y - 5) * (y - 5))); }, {}};
}

TEST(Clusters, a_patch_of_32_triangles_becomes_quads) {
  const Grid grid{10, 10, [](double x, double y) { return Vec3(x, y, 0); }, {}};
  const Model before = with_cut_quads(grid, 3, 7, Diagonals::same);
  ASSERT_EQ(triangles(before), 32u);
  const Thinned thinned = thin(before);
  EXPECT_EQ(thinned.repaired.clusters_before, 9u);
  EXPECT_TRUE(thinned.repaired.clusters_left.empty());
  EXPECT_EQ(triangles(thinned.model), 0u) << "each pair becomes the quad that it was";
  EXPECT_EQ(thinned.repaired.done[static_cast<std::size_t>(Operation::merge)], 16u);
  for (std::size_t n = 0; n < before.node_count(); ++n)
    EXPECT_NEAR((thinned.model.positions[n] - before.positions[n]).norm(), 0, 1e-6) << n;
  EXPECT_EQ(what_is_wrong(thinned.model), "");
  EXPECT_EQ(grades(thinned.model), (std::array<std::size_t, 3>{100, 0, 0}));
}

TEST(Clusters, eight_triangles_about_a_node_become_quads) {
  const Grid grid{8, 8, [](double x, double y) { return Vec3(x, y, 0); }, {}};
  const Model before = with_cut_quads(grid, 3, 5, Diagonals::star);
  ASSERT_EQ(max_triangles_at_a_node(before), 8u);
  const Thinned thinned = thin(before);
  EXPECT_EQ(thinned.repaired.clusters_before, 1u);
  EXPECT_EQ(triangles(thinned.model), 0u);
  EXPECT_EQ(what_is_wrong(thinned.model), "");
}

TEST(Clusters, nodes_about_which_triangles_lie_at_random_keep_three_at_most) {
  const Grid flat{10, 10, [](double x, double y) { return Vec3(x, y, 0); }, {}};
  for (const Grid& grid : {flat, bowl()})
    for (const double shift : {0.0, 0.15, 0.25}) {
      const Model before = with_cut_quads(grid, 2, 8, Diagonals::random, shift);
      ASSERT_GT(max_triangles_at_a_node(before), 3u);
      const Thinned thinned = thin(before);
      EXPECT_TRUE(thinned.repaired.clusters_left.empty()) << shift;
      EXPECT_LE(max_triangles_at_a_node(thinned.model), 3u) << shift;
      EXPECT_LE(grades(thinned.model)[2], grades(before)[2]) << shift;
      EXPECT_EQ(what_is_wrong(thinned.model), "") << shift;
      const Shape was = shape_of(before), is = shape_of(thinned.model);
      EXPECT_EQ(was.euler, is.euler);
      EXPECT_NEAR(was.free_length, is.free_length, 1e-4 * was.free_length);
      EXPECT_NEAR(was.area, is.area, 0.005 * was.area);
    }
}

TEST(Clusters, what_cards_keep_stays_and_is_told_with_the_reason) {
  const Grid grid{8, 8, [](double x, double y) { return Vec3(x, y, 0); }, {}};
  const Model before = with_cut_quads(grid, 3, 5, Diagonals::star);
  Rules rules;
  rules.shell = [](ShellIndex) { return static_cast<std::uint8_t>(kKeepsNodes | kLasting); };
  const Thinned thinned = thin(before, rules);
  ASSERT_EQ(thinned.repaired.clusters_left.size(), 1u);
  EXPECT_EQ(thinned.repaired.clusters_left[0].node, at(grid.node(4, 4)));
  EXPECT_EQ(thinned.repaired.clusters_left[0].triangles, 8u);
  EXPECT_EQ(thinned.repaired.clusters_left[0].why, "its triangles have to stay as they are");
  EXPECT_EQ(triangles(thinned.model), 8u);
}

TEST(Clusters, what_is_not_asked_for_stays) {
  const Grid grid{10, 10, [](double x, double y) { return Vec3(x, y, 0); }, {}};
  const Model before = with_cut_quads(grid, 3, 7, Diagonals::same);
  const relax::ReferenceSurface surface(before, all_shells(before), 30);
  const auto repaired = repair({before, surface, {}, {quality::default_criteria(), 1.0}, {}, {}}, all_shells(before));
  ASSERT_TRUE(repaired.has_value());
  EXPECT_TRUE(repaired->change.empty());
}

}  // namespace
}  // namespace prismesh::mesh::repair
