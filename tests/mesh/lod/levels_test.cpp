// Levels of detail: whatever a view chooses stands for each shell once, has no cracks and keeps borders; moved shells are shown as they
// are.
#include "mesh/lod/levels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "mesh/deck/sample.h"
#include "mesh/lod/choose.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/topology_change.h"
#include "mesh/spatial/point_triangle.h"

namespace prismesh::mesh::lod {
namespace {

constexpr double kPi = 3.14159265358979;

/// A model of quads, each given by four nodes and a part.
class Sheets {
 public:
  std::uint32_t node(const Vec3& at) {
    nodes_.push_back(at);
    return static_cast<std::uint32_t>(nodes_.size() - 1);
  }
  void quad(std::array<std::uint32_t, 4> corners, std::uint32_t part) {
    shells_.push_back({{NodeIndex(corners[0]), NodeIndex(corners[1]), NodeIndex(corners[2]), NodeIndex(corners[3])}});
    parts_.push_back(part);
  }
  /// A grid of `u` x `v` quads. Wraps around where told.
  template <class Place, class PartOf>
  void grid(std::uint32_t u, std::uint32_t v, bool wrap_u, bool wrap_v, const Place& place, const PartOf& part_of) {
    const std::uint32_t columns = wrap_u ? u : u + 1, rows = wrap_v ? v : v + 1, first = static_cast<std::uint32_t>(nodes_.size());
    for (std::uint32_t j = 0; j < rows; ++j)
      for (std::uint32_t i = 0; i < columns; ++i) node(place(double(i) / u, double(j) / v));
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return first + (j % rows) * columns + i % columns; };
    for (std::uint32_t j = 0; j < v; ++j)
      for (std::uint32_t i = 0; i < u; ++i) quad({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}, part_of(i, j));
  }
  Model model() const {
    Model model;
    model.positions.resize(nodes_.size(), Vec3::Zero());
    model.node_ids.resize(nodes_.size());
    model.node_holds.resize(nodes_.size());
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      model.positions.set(n, nodes_[n]);
      model.node_ids.set(n, static_cast<std::int64_t>(n + 1));
    }
    model.shell_nodes.resize(shells_.size());
    model.shell_ids.resize(shells_.size());
    model.shell_parts.resize(shells_.size());
    model.shell_thickness.resize(shells_.size());
    std::uint32_t parts = 0;
    for (std::size_t s = 0; s < shells_.size(); ++s) {
      model.shell_nodes.set(s, shells_[s]);
      model.shell_ids.set(s, static_cast<std::int64_t>(s + 1));
      model.shell_parts.set(s, PartIndex(std::size_t{parts_[s]}));
      parts = std::max(parts, parts_[s] + 1);
    }
    model.parts = std::make_shared<const std::vector<Part>>(parts);
    model.shell_index = std::make_shared<const IdIndex>(std::vector<std::int64_t>());
    model.adjacency = std::make_shared<const Adjacency>(build_adjacency(model));
    return model;
  }

 private:
  std::vector<Vec3> nodes_;
  std::vector<ShellNodes> shells_;
  std::vector<std::uint32_t> parts_;
};

Vec3 on_torus(double u, double v) {
  const double around = 400 + 100 * std::cos(2 * kPi * v);
  return {around * std::cos(2 * kPi * u), around * std::sin(2 * kPi * u), 100 * std::sin(2 * kPi * v)};
}

Model torus() {
  Sheets sheets;
  sheets.grid(240, 80, true, true, on_torus, [](auto, auto) { return 0U; });
  return sheets.model();
}

/// A wavy sheet of four parts with a hole.
Model plates() {
  Sheets sheets;
  sheets.grid(
      120, 120, false, false, [](double u, double v) { return Vec3(600 * u, 600 * v, 0); },
      [](std::uint32_t i, std::uint32_t j) { return (i < 50 ? 0U : 1U) + (j < 70 ? 0U : 2U); });
  Model model = sheets.model();
  std::vector<NodeIndex> nothing;
  for (std::uint32_t j = 20; j < 35; ++j)
    for (std::uint32_t i = 70; i < 95; ++i) {
      const ShellIndex shell(std::size_t{j * 120 + i});
      remove_shell(model, shell);
    }
  model.adjacency = std::make_shared<const Adjacency>(build_adjacency(model));
  return model;
}

std::vector<CoarseTriangle> triangles_of_clusters(const Model& model, const Levels& levels, const std::vector<std::uint32_t>& clusters) {
  std::vector<CoarseTriangle> triangles;
  for (const std::uint32_t c : clusters) {
    const Cluster& cluster = levels.clusters[c];
    for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
      if (c >= levels.shell_clusters) {
        triangles.push_back(levels.triangles[i]);
        continue;
      }
      const ShellNodes& nodes = model.shell(levels.shells[i]);
      triangles.push_back({{nodes.node[0], nodes.node[1], nodes.node[2]}, levels.shells[i]});
      if (!nodes.is_triangle()) triangles.push_back({{nodes.node[2], nodes.node[3], nodes.node[0]}, levels.shells[i]});
    }
  }
  return triangles;
}

/// Views from many places, near and far, with different demands.
template <class Check>
void from_everywhere(const Model& model, const Levels& levels, const Check& check) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-1, 1);
  std::vector<std::uint32_t> clusters;
  for (int k = 0; k < 40; ++k) {
    const Vec3 target = model.position(NodeIndex(random() % model.node_count()));
    const double reach = std::pow(10, 1 + 3 * std::abs(place(random)));
    const Viewpoint view{target + reach * Vec3(place(random), place(random), place(random)), 1000, 1};
    clusters.clear();
    choose(levels, {}, view, {1.0 + k % 4}, clusters);
    check(clusters, view);
  }
}

TEST(Levels, have_each_shell_once_as_it_is) {
  const Model model = plates();
  const Levels levels = build_levels(model).value();
  std::vector<ShellIndex> shells = levels.shells;
  std::sort(shells.begin(), shells.end());
  EXPECT_EQ(std::adjacent_find(shells.begin(), shells.end()), shells.end());
  EXPECT_EQ(shells.size(), live_shells(model));
  const Viewpoint near{{300, 300, 1}, 1e9, 1e-3};
  std::vector<std::uint32_t> clusters;
  choose(levels, {}, near, {0}, clusters);
  std::size_t shown = 0;
  for (const std::uint32_t c : clusters) shown += c < levels.shell_clusters ? levels.clusters[c].count : 0;
  EXPECT_GE(triangles_of(levels, clusters), shown);
}

TEST(Levels, have_no_cracks) {
  const Model model = torus();
  const Levels levels = build_levels(model).value();
  std::size_t mixed = 0;
  from_everywhere(model, levels, [&](const std::vector<std::uint32_t>& clusters, const Viewpoint&) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const CoarseTriangle& triangle : triangles_of_clusters(model, levels, clusters))
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = triangle.node[k].value, b = triangle.node[(k + 1) % 3].value;
        ++edges[{std::min(a, b), std::max(a, b)}];
      }
    for (const auto& [edge, uses] : edges) ASSERT_EQ(uses, 2) << edge.first << "-" << edge.second << ": a closed surface stays closed";
    std::set<std::uint32_t> makers;
    for (const std::uint32_t c : clusters) makers.insert(levels.clusters[c].made_by);
    mixed += makers.size() > 1 ? 1 : 0;
  });
  EXPECT_GT(mixed, 10u);
}

TEST(Levels, keep_borders_of_parts_holes_and_outlines) {
  const Model model = plates();
  const Levels levels = build_levels(model).value();
  std::map<std::uint32_t, double> areas;
  const auto area = [&](const CoarseTriangle& t) {
    return (model.position(t.node[1]) - model.position(t.node[0])).cross(model.position(t.node[2]) - model.position(t.node[0])).norm() / 2;
  };
  std::vector<std::uint32_t> all;
  for (std::uint32_t c = 0; c < levels.shell_clusters; ++c) all.push_back(c);
  for (const CoarseTriangle& t : triangles_of_clusters(model, levels, all)) areas[model.shell_parts[t.shell.value].value] += area(t);
  std::size_t fewest = model.shell_count();
  from_everywhere(model, levels, [&](const std::vector<std::uint32_t>& clusters, const Viewpoint&) {
    double error = 0;
    for (const std::uint32_t c : clusters)
      if (levels.clusters[c].made_by != kNoGroup) error = std::max(error, levels.groups[levels.clusters[c].made_by].error);
    if (error > 1e-6) return;  // outlines are cut by so much
    std::map<std::uint32_t, double> now;
    const auto triangles = triangles_of_clusters(model, levels, clusters);
    for (const CoarseTriangle& t : triangles) now[model.shell_parts[t.shell.value].value] += area(t);
    for (const auto& [part, size] : areas)
      EXPECT_NEAR(now[part], size, 1e-6 * size) << "part " << part << ": in the plane nothing is lost or covered twice";
    fewest = std::min(fewest, triangles.size());
  });
  EXPECT_LT(fewest, 500u) << "flat parts become few triangles";
}

TEST(Levels, say_how_far_they_are_from_the_shells) {
  const Model model = torus();
  const Levels levels = build_levels(model).value();
  from_everywhere(model, levels, [&](const std::vector<std::uint32_t>& clusters, const Viewpoint& view) {
    const auto triangles = triangles_of_clusters(model, levels, clusters);
    if (triangles.size() > 3000) return;  // takes long, and is near the original
    double error = 0, nearest = std::numeric_limits<double>::infinity();
    for (const std::uint32_t c : clusters)
      if (levels.clusters[c].made_by != kNoGroup) error = std::max(error, levels.groups[levels.clusters[c].made_by].error);
    double farthest = 0;
    for (std::size_t n = 0; n < model.node_count(); n += 37) {
      double near2 = std::numeric_limits<double>::infinity();
      for (const CoarseTriangle& t : triangles)
        near2 =
            std::min(near2, spatial::closest_on_triangle({model.position(t.node[0]), model.position(t.node[1]), model.position(t.node[2])},
                                                         model.position(NodeIndex(n)))
                                .distance2);
      farthest = std::max(farthest, std::sqrt(near2));
      nearest = std::min(nearest, (view.eye - model.position(NodeIndex(n))).norm());
    }
    EXPECT_LE(farthest, 1.2 * error + 1e-9) << triangles.size() << " triangles";
  });
}

TEST(Levels, become_few_even_of_many_small_parts) {
  Sheets sheets;
  std::uint32_t part = 0;
  for (int j = 0; j < 60; ++j)
    for (int i = 0; i < 60; ++i, ++part)
      sheets.grid(
          2, 2, false, false, [&](double u, double v) { return Vec3(10 * i + 4 * u, 10 * j + 4 * v, part % 7); },
          [&](auto, auto) { return part; });
  const Model model = sheets.model();
  const Levels levels = build_levels(model).value();
  const Viewpoint far{{300, 300, 300'000}, 1000, 1};
  std::vector<std::uint32_t> clusters;
  choose(levels, {}, far, {1}, clusters);
  EXPECT_LT(triangles_of(levels, clusters), model.shell_count() / 4);
  EXPECT_GT(triangles_of(levels, clusters), 0u) << "something stands for them";
}

TEST(Levels, are_the_same_each_time) {
  const Model model = plates();
  const Levels a = build_levels(model).value(), b = build_levels(model).value();
  ASSERT_EQ(a.triangles.size(), b.triangles.size());
  for (std::size_t t = 0; t < a.triangles.size(); ++t) ASSERT_EQ(a.triangles[t].node, b.triangles[t].node);
  EXPECT_EQ(a.shells, b.shells);
  EXPECT_EQ(a.groups.size(), b.groups.size());
}

/// By cluster of shells: infinite where one of these is.
std::vector<float> seen_as_they_are(const Levels& levels, const std::set<std::uint32_t>& shells) {
  std::vector<float> by_cluster(levels.shell_clusters);
  for (std::size_t c = 0; c < levels.shell_clusters; ++c)
    for (std::uint32_t i = 0; i < levels.clusters[c].count; ++i)
      if (shells.count(levels.shells[levels.clusters[c].first + i].value) > 0) by_cluster[c] = std::numeric_limits<float>::infinity();
  return by_cluster;
}

TEST(Levels, show_shells_that_are_held_as_they_are) {
  const Model model = torus();
  const Levels levels = build_levels(model).value();
  const Viewpoint far{{0, 0, 100'000}, 1000, 1};
  std::vector<std::uint32_t> before, after;
  choose(levels, {}, far, {2}, before);
  EXPECT_TRUE(std::all_of(before.begin(), before.end(), [&](std::uint32_t c) { return c >= levels.shell_clusters; }));
  choose(levels, added_errors(levels, seen_as_they_are(levels, {5000, 12'345})), far, {2}, after);
  std::set<std::uint32_t> shown;
  for (const std::uint32_t c : after)
    if (c < levels.shell_clusters)
      for (std::uint32_t i = 0; i < levels.clusters[c].count; ++i) shown.insert(levels.shells[levels.clusters[c].first + i].value);
  EXPECT_TRUE(shown.count(5000) && shown.count(12'345));
  EXPECT_LT(triangles_of(levels, after), model.shell_count()) << "the rest stays coarse";
}

TEST(Levels, show_shells_whose_sides_are_seen_as_they_are) {
  Sheets sheets;  // flat, so that no error keeps shells apart
  sheets.grid(
      100, 100, false, false, [](double u, double v) { return Vec3(100 * u, 100 * v, 0); }, [](auto, auto) { return 0U; });
  const Model model = sheets.model();
  const Levels levels = build_levels(model).value();
  const auto shells_at = [&](double distance) {
    std::vector<std::uint32_t> clusters;
    choose(levels, {}, {{50, 50, distance}, 1000, 1}, {1, 4}, clusters);
    std::size_t shells = 0;
    for (const std::uint32_t c : clusters) shells += c < levels.shell_clusters ? levels.clusters[c].count : 0;
    return shells;
  };
  EXPECT_EQ(shells_at(150), model.shell_count()) << "more than 5 pixels at the nearest corner, 4 at a group's farthest";
  EXPECT_EQ(shells_at(1000), 0u) << "1 pixel";
}

/// After edits here and there, one after another, whatever is chosen is closed and as near to the moved shells as is said.
TEST(Levels, stay_right_after_edits_in_random_order) {
  Model model = torus();
  const Model made_of = model;
  const Levels levels = build_levels(model).value();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-1, 1);
  for (int edit = 0; edit < 8; ++edit) {
    const Vec3 centre = model.position(NodeIndex(random() % model.node_count()));
    const Vec3 by = std::pow(10, 1 + place(random)) * Vec3(place(random), place(random), place(random));
    for (std::size_t n = 0; n < model.node_count(); ++n)
      if ((model.position(NodeIndex(n)) - centre).norm() < 60) model.positions.set(n, model.position(NodeIndex(n)) + by);
    std::vector<float> by_cluster(levels.shell_clusters);
    for (std::size_t c = 0; c < levels.shell_clusters; ++c)
      for (std::uint32_t i = 0; i < levels.clusters[c].count; ++i)
        for (const NodeIndex node : model.shell(levels.shells[levels.clusters[c].first + i]).node)
          by_cluster[c] = std::max(by_cluster[c], static_cast<float>((model.position(node) - made_of.position(node)).norm()));
    const std::vector<float> moved = added_errors(levels, by_cluster);
    for (const double distance : {900.0, 4000.0, 20'000.0}) {
      const Viewpoint view{distance * Vec3(place(random), place(random), 1), 1000, 1};
      std::vector<std::uint32_t> clusters;
      choose(levels, moved, view, {2}, clusters);
      const auto triangles = triangles_of_clusters(model, levels, clusters);
      std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
      for (const CoarseTriangle& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(t.node[k].value, t.node[(k + 1) % 3].value)];
      for (const auto& [edge, uses] : edges) ASSERT_EQ(uses, 2) << "edit " << edit;
      if (triangles.size() > 3000) continue;  // takes long
      double error = 0;
      for (const std::uint32_t c : clusters)
        if (const std::uint32_t maker = levels.clusters[c].made_by; maker != kNoGroup)
          error = std::max(error, levels.groups[maker].error + 2 * moved[maker]);
      for (std::size_t n = 0; n < model.node_count(); n += 61) {
        double near2 = std::numeric_limits<double>::infinity();
        for (const CoarseTriangle& t : triangles)
          near2 = std::min(near2,
                           spatial::closest_on_triangle({model.position(t.node[0]), model.position(t.node[1]), model.position(t.node[2])},
                                                        model.position(NodeIndex(n)))
                               .distance2);
        ASSERT_LE(std::sqrt(near2), 1.2 * error + 1e-9) << "edit " << edit << ", " << triangles.size() << " triangles";
        const double distance_now = std::max(1.0, (model.position(NodeIndex(n)) - view.eye).norm());
        ASSERT_LE(std::sqrt(near2) * 1000 / distance_now, 1.2 * 2 + 1e-6) << "pixels, edit " << edit;
      }
    }
  }
}

TEST(Levels, leave_out_what_cant_be_drawn) {
  Model model = torus();
  model.positions.set(100, Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0));
  model.positions.set(7000, Vec3(0, std::numeric_limits<double>::infinity(), 0));
  const Levels levels = build_levels(model).value();
  EXPECT_EQ(levels.shells.size(), model.shell_count() - 8);
  for (const CoarseTriangle& t : levels.triangles)
    for (const NodeIndex node : t.node) ASSERT_TRUE(model.position(node).allFinite());
  EXPECT_TRUE(build_levels(Model()).value().clusters.empty());
  Sheets one;
  one.grid(
      1, 1, false, false, [](double u, double v) { return Vec3(u, v, 0); }, [](auto, auto) { return 0U; });
  EXPECT_EQ(build_levels(one.model()).value().clusters.size(), 1u);
}

TEST(Levels, hold_slivers_points_and_coordinates_far_from_zero) {
  Sheets sheets;
  sheets.grid(
      60, 60, false, false, [](double u, double v) { return Vec3(1e7 + 0.06 * u, 1e7 + 0.06 * v, 1e7); }, [](auto, auto) { return 0U; });
  sheets.grid(
      400, 4, false, false, [](double u, double v) { return Vec3(1e7 + u, 1e7 + 1e-9 * v, 0); }, [](auto, auto) { return 1U; });
  for (int k = 0; k < 200; ++k) {
    const std::uint32_t at = sheets.node({1e7, 1e7, 5});
    sheets.quad({at, at, at, at}, 2);
  }
  const Model model = sheets.model();
  const Levels levels = build_levels(model).value();
  EXPECT_EQ(levels.shells.size(), model.shell_count());
  const Viewpoint far{{1e7, 1e7, 2e7}, 1000, 1};
  std::vector<std::uint32_t> clusters;
  choose(levels, {}, far, {1}, clusters);
  EXPECT_LT(triangles_of(levels, clusters), model.shell_count());
  for (const Group& group : levels.groups) EXPECT_TRUE(std::isfinite(group.error) && std::isfinite(group.sphere.radius));
}

TEST(Levels, keep_junctions_of_sheets_together) {
  Sheets sheets;  // five sheets that meet in one line
  std::vector<std::uint32_t> line;
  for (int k = 0; k <= 200; ++k) line.push_back(sheets.node({double(k), 0, 0}));
  for (int sheet = 0; sheet < 5; ++sheet) {
    std::vector<std::uint32_t> before = line;
    for (int row = 1; row <= 20; ++row) {
      std::vector<std::uint32_t> now;
      for (int k = 0; k <= 200; ++k) now.push_back(sheets.node({double(k), row * std::cos(1.2 * sheet), row * std::sin(1.2 * sheet)}));
      for (std::size_t k = 0; k < 200; ++k) sheets.quad({before[k], before[k + 1], now[k + 1], now[k]}, 0);
      before = now;
    }
  }
  const Model model = sheets.model();
  const Levels levels = build_levels(model).value();
  const std::set<std::uint32_t> joint(line.begin(), line.end());
  std::size_t coarse = 0;
  from_everywhere(model, levels, [&](const std::vector<std::uint32_t>& clusters, const Viewpoint&) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> on_line;
    const auto triangles = triangles_of_clusters(model, levels, clusters);
    for (const CoarseTriangle& t : triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = t.node[k].value, b = t.node[(k + 1) % 3].value;
        if (joint.count(a) > 0 && joint.count(b) > 0) ++on_line[std::minmax(a, b)];
      }
    for (const auto& [edge, uses] : on_line)
      ASSERT_EQ(uses, 5) << "a sheet has come off between nodes " << edge.first << " and " << edge.second;
    coarse += triangles.size() < model.shell_count() / 10 ? 1 : 0;
  });
  EXPECT_GT(coarse, 0u);
}

TEST(Levels, stop_when_told) {
  const auto levels = build_levels(torus(), [](double) { return false; });
  ASSERT_FALSE(levels);
  EXPECT_TRUE(is_cancelled(levels.error()));
}

}  // namespace
}  // namespace prismesh::mesh::lod
