// How shells are joined, against a count over all pairs.
#include <algorithm>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "mesh/model/topology_change.h"
#include "mesh/quality/structure.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::quality {
namespace {

using Ends = std::pair<std::uint32_t, std::uint32_t>;  // low, high

struct FoundByPairs {
  std::set<std::uint32_t> duplicates;
  std::set<Ends> opposed, multiple, unjoined;
  std::map<std::uint32_t, std::size_t> triangles;
};

FoundByPairs by_all_pairs(const Model& model, double tolerance) {
  FoundByPairs found;
  std::map<Ends, std::vector<std::pair<std::uint32_t, bool>>> uses;  // shell, whether it runs from low to high
  std::vector<std::set<std::uint32_t>> corners(model.shell_count());
  for (std::uint32_t s = 0; s < model.shell_count(); ++s) {
    if (model.is_removed(ShellIndex(std::size_t{s}))) continue;
    const ShellNodes& shell = model.shell_nodes[s];
    const auto count = static_cast<std::size_t>(shell.corners());
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t from = shell.node[i].value, to = shell.node[(i + 1) % count].value;
      corners[s].insert(from);
      uses[std::minmax(from, to)].push_back({s, from < to});
    }
    if (shell.is_triangle())
      for (const std::uint32_t node : corners[s]) ++found.triangles[node];
    for (std::uint32_t earlier = 0; earlier < s; ++earlier)
      if (corners[earlier] == corners[s]) found.duplicates.insert(s);
  }
  std::vector<std::pair<Ends, std::uint32_t>> free;
  for (const auto& [ends, shells] : uses) {
    if (shells.size() > 2) found.multiple.insert(ends);
    if (shells.size() == 2 && shells[0].second == shells[1].second) found.opposed.insert(ends);
    if (shells.size() == 1) free.push_back({ends, shells[0].first});
  }
  const auto at = [&](std::uint32_t node) { return model.positions[node]; };
  for (const auto& [e, of_e] : free)
    for (const auto& [f, of_f] : free) {
      if (e == f || model.shell_parts[of_e] != model.shell_parts[of_f]) continue;
      const double reach = tolerance * std::min((at(e.second) - at(e.first)).norm(), (at(f.second) - at(f.first)).norm());
      const auto near = [&](std::uint32_t a, std::uint32_t b) { return (at(a) - at(b)).norm() <= reach; };
      if ((near(e.first, f.first) && near(e.second, f.second)) || (near(e.first, f.second) && near(e.second, f.first)))
        found.unjoined.insert(e);
    }
  // three free edges between three nodes, one of which lies on the edge between the others
  const std::map<Ends, std::uint32_t> shell_at(free.begin(), free.end());
  for (const auto& [long_one, of_long] : free)
    for (std::uint32_t between = 0; between < model.node_count(); ++between) {
      const auto one = shell_at.find(std::minmax(long_one.first, between)), other = shell_at.find(std::minmax(long_one.second, between));
      if (one == shell_at.end() || other == shell_at.end()) continue;
      const PartIndex part = model.shell_parts[of_long];
      if (model.shell_parts[one->second] != part || model.shell_parts[other->second] != part) continue;
      const Vec3 along = at(long_one.second) - at(long_one.first), to = at(between) - at(long_one.first);
      const double before = to.dot(along.normalized());
      if (before > 0 && before < along.norm() && along.normalized().cross(to).norm() <= tolerance * along.norm())
        found.unjoined.insert({long_one, one->first, other->first});
    }
  return found;
}

std::set<Ends> ends_of(const Model& model, const std::vector<EdgeIndex>& edges) {
  std::set<Ends> all;
  for (const EdgeIndex edge : edges) all.insert({model.adjacency->edge(edge).low.value, model.adjacency->edge(edge).high.value});
  return all;
}

/// Strips of quads and triangles of all sizes that lie edge to edge with nodes of their own, nearly at one place or not quite; some shells
/// turned over, some twice, some put on an edge of others.
Model patchwork(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<Vec3> points;
  std::vector<std::array<int, 4>> shells;
  for (int strip = 0; strip < 12; ++strip) {
    const int kind = strip % 3, row = strip / 3;
    const double size = kind == 0 ? 1 : kind == 1 ? 0.03 : 40;
    const auto first = static_cast<int>(points.size());
    for (int i = 0; i <= 6; ++i)
      for (int j = 0; j < 2; ++j) {
        const double off = size * (share(random) < 0.5 ? 0.003 : 0.02);
        points.emplace_back(size * i + off * share(random), size * (row + j) + off * share(random), 100.0 * kind);
      }
    for (int i = 0; i < 6; ++i) {
      const int a = first + 2 * i;
      std::array<int, 4> quad = {a, a + 2, a + 3, a + 1};
      if (share(random) < 0.2) std::reverse(quad.begin(), quad.end());
      if (share(random) < 0.3) {
        shells.push_back({quad[0], quad[1], quad[2], quad[2]});
        shells.push_back({quad[0], quad[2], quad[3], quad[3]});
      } else {
        shells.push_back(quad);
      }
      if (share(random) < 0.1) shells.push_back({quad[2], quad[3], quad[0], quad[1]});
      if (i > 0 && i < 4 && share(random) < 0.2) shells.push_back({a, a + 1, first + 12, first + 12});
    }
  }
  Model model = test::make_shells(points, shells);
  model.parts = std::make_shared<const std::vector<Part>>(2);
  for (std::size_t s = model.shell_count() / 2; s < model.shell_count(); ++s)
    if (s % 5 == 0) model.shell_parts.set(s, PartIndex(std::size_t{1}));
  for (std::size_t s = 7; s < model.shell_count(); s += 29) remove_shell(model, ShellIndex(s));
  model.adjacency = std::make_shared<const Adjacency>(build_adjacency(model));
  return model;
}

TEST(StructureOracle, finds_what_a_look_at_all_pairs_finds) {
  std::size_t unjoined = 0, duplicates = 0, opposed = 0, multiple = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const Model model = patchwork(seed);
    const Structure found = check_structure(model);
    const FoundByPairs expected = by_all_pairs(model, StructureOptions().tolerance);
    std::set<std::uint32_t> copies;
    for (const ShellIndex shell : found.duplicates) copies.insert(shell.value);
    EXPECT_EQ(copies, expected.duplicates) << seed;
    EXPECT_EQ(ends_of(model, found.opposed), expected.opposed) << seed;
    EXPECT_EQ(ends_of(model, found.multiple), expected.multiple) << seed;
    EXPECT_EQ(ends_of(model, found.unjoined), expected.unjoined) << seed;
    NodeSet clusters;
    std::size_t most = 0;
    for (const auto& [node, count] : expected.triangles) {
      if (static_cast<double>(count) > StructureOptions().triangles_at_node) clusters.emplace_back(std::size_t{node});
      most = std::max(most, count);
    }
    EXPECT_EQ(found.clusters, clusters) << seed;
    EXPECT_EQ(found.max_triangles, most) << seed;
    unjoined += expected.unjoined.size(), duplicates += copies.size(), opposed += found.opposed.size(), multiple += found.multiple.size();
  }
  EXPECT_GT(unjoined, 100u);
  EXPECT_GT(duplicates, 30u);
  EXPECT_GT(opposed, 30u);
  EXPECT_GT(multiple, 30u);
}

}  // namespace
}  // namespace prismesh::mesh::quality
