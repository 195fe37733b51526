// Marched distances against exact ones on 10,000 elements. A quad's surface isn't defined: a distance counts as right between those
// over the triangles of the one diagonal and of the other, chosen alike everywhere.
#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/spatial/cut_patch.h"
#include "mesh/spatial/geodesic.h"
#include "tests/mesh/spatial/exact_geodesic.h"
#include "tests/mesh/spatial/trial_sheets.h"
#include "tests/support/real_deck.h"
#include "tests/support/whole_model.h"

namespace prismesh::mesh::spatial {
namespace {

using test::all_shells;

test::TriangleSurface triangles_of(const Patch& patch, bool other_diagonal) {
  test::TriangleSurface surface{patch.positions, {}};
  for (const auto& [a, b, c, d] : patch.shells) {
    if (c == b) continue;
    if (c == d) {
      surface.triangle.push_back({a, b, c});
    } else if (other_diagonal) {
      surface.triangle.insert(surface.triangle.end(), {{a, b, d}, {b, c, d}});
    } else {
      surface.triangle.insert(surface.triangle.end(), {{a, b, c}, {a, c, d}});
    }
  }
  return surface;
}

struct AccuracyErrors {
  double mean = 0;
  double max = 0;
  double apart = 0;  ///< most that the two ways to cut the quads differ
  std::size_t count = 0;
};

/// As shares of the radius, over the nodes within it.
AccuracyErrors compare(const Patch& patch, const std::vector<std::uint32_t>& sources, double radius) {
  const std::vector<double> one = test::exact_geodesic(triangles_of(patch, false), sources, 1.1 * radius);
  const std::vector<double> other = test::exact_geodesic(triangles_of(patch, true), sources, 1.1 * radius);
  const std::vector<double> marched = geodesic_distance(patch, sources);
  AccuracyErrors errors;
  for (std::size_t i = 0; i < marched.size(); ++i) {
    const auto [low, high] = std::minmax(one[i], other[i]);
    if (!(high <= radius)) continue;
    const double error = std::max({0.0, low - marched[i], marched[i] - high}) / radius;
    errors.mean += error;
    errors.max = std::max(errors.max, error);
    errors.apart = std::max(errors.apart, (high - low) / radius);
    ++errors.count;
  }
  errors.mean /= static_cast<double>(errors.count);
  return errors;
}

void say(const std::string& name, const Patch& patch, const AccuracyErrors& errors) {
  std::cout << std::fixed << std::setprecision(4) << "  " << name << ": " << patch.shells.size() << " shells, " << errors.count
            << " nodes, mean " << 100 * errors.mean << " %, most " << 100 * errors.max << " %, diagonals " << 100 * errors.apart << " %\n";
}

void expect_within_aim(const std::string& name, const Patch& patch, const std::vector<std::uint32_t>& sources, double radius) {
  const AccuracyErrors errors = compare(patch, sources, radius);
  say(name, patch, errors);
  EXPECT_GT(errors.count, 50u) << name;
  EXPECT_LE(errors.mean, 0.003) << name;
  EXPECT_LE(errors.max, 0.01) << name;
}

std::uint32_t nearest(const Patch& patch, const Vec3& place) {
  std::uint32_t best = 0;
  for (std::uint32_t i = 0; i < patch.positions.size(); ++i)
    if ((patch.positions[i] - place).norm() < (patch.positions[best] - place).norm()) best = i;
  return best;
}

using Places = std::vector<std::pair<double, double>>;

void expect_within_aim_on_panel(const std::string& name, const Model& model, const Places& places) {
  const Patch patch = cut_patch(model, all_shells(model));
  for (const auto& [x, y] : places)
    expect_within_aim(name + " from " + std::to_string(int(x)) + ", " + std::to_string(int(y)), patch,
                      {nearest(patch, test::on_panel(x, y))}, 45);
}

TEST(GeodesicAccuracy, of_quads) {
  expect_within_aim_on_panel("regular quads", test::quad_panel(0), {{42, 55}});
  expect_within_aim_on_panel("jittered quads", test::quad_panel(0.3), {{50, 50}, {0, 0}});
}

TEST(GeodesicAccuracy, of_quads_and_triangles) {
  expect_within_aim_on_panel("mixed", test::mixed_panel(0.3, 0.3), {{50, 50}, {0, 0}});
  expect_within_aim_on_panel("triangles", test::mixed_panel(0.3, 1.0), {{30, 62}});
}

TEST(GeodesicAccuracy, of_slender_and_obtuse_triangles) {
  expect_within_aim_on_panel("aspect 5", test::slender_panel(5, 0), {{42, 55}, {0, 0}});
  expect_within_aim_on_panel("aspect 5, sheared", test::slender_panel(5, 0.4), {{42, 55}, {30, 62}});
  expect_within_aim_on_panel("aspect 1/5, sheared", test::slender_panel(0.2, 0.4), {{50, 50}});
}

/// The worst that is known: along a boundary with teeth, from one of them, paths graze tooth after tooth.
TEST(GeodesicAccuracy, of_slender_triangles_along_a_serrated_boundary) {
  for (const double aspect : {5.0, 0.2}) {
    const Model model = test::slender_panel(aspect, 0.4);
    const Patch patch = cut_patch(model, all_shells(model));
    const AccuracyErrors errors = compare(patch, {nearest(patch, test::on_panel(0, 0))}, 45);
    say("serrated", patch, errors);
    EXPECT_LE(errors.mean, 0.003);
    EXPECT_LE(errors.max, 0.015);
  }
}

TEST(GeodesicAccuracy, where_three_sheets_meet) {
  const Model model = test::three_sheets(0.25);
  const Patch patch = cut_patch(model, all_shells(model));
  for (const auto& [i, j] : {std::pair{6, 28}, {0, 30}})
    expect_within_aim("three sheets", patch, {nearest(patch, model.position(model.find_node(i == 0 ? 1 + j : 100000 + i + 100 * j)))}, 40);
}

TEST(GeodesicAccuracy, around_round_holes) {
  const Model model = test::holed_panel();
  const Patch patch = cut_patch(model, all_shells(model));
  for (const auto& [x, y] : {std::pair{50.0, 40.0}, {35.0, 50.0}, {0.0, 30.0}})
    expect_within_aim("holes", patch, {nearest(patch, test::on_panel(x, y))}, 45);
}

TEST(GeodesicAccuracy, from_many_sources) {
  const Model model = test::mixed_panel(0.3, 0.3);
  const Patch patch = cut_patch(model, all_shells(model));
  // single nodes far apart, whose waves meet in the middle
  std::vector<std::uint32_t> scattered;
  for (const auto& [x, y] : {std::pair{20.0, 30.0}, {70.0, 25.0}, {45.0, 80.0}, {48.0, 52.0}})
    scattered.push_back(nearest(patch, test::on_panel(x, y)));
  expect_within_aim("four sources", patch, scattered, 40);
}

TEST(GeodesicAccuracy, is_the_same_there_and_back) {
  for (const Model& model : {test::holed_panel(), test::mixed_panel(0.3, 0.5), test::three_sheets(0.25)}) {
    const Patch patch = cut_patch(model, all_shells(model));
    const auto count = static_cast<std::uint32_t>(patch.nodes.size());
    const std::array<std::uint32_t, 5> some{count / 9, count / 3, count / 2, 2 * count / 3, count - 40};
    std::array<std::vector<double>, 5> from;
    for (std::size_t i = 0; i < some.size(); ++i) from[i] = geodesic_distance(patch, std::vector<std::uint32_t>{some[i]});
    for (std::size_t a = 0; a < some.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) EXPECT_NEAR(from[a][some[b]] / from[b][some[a]], 1, 0.002) << some[a] << ", " << some[b];
  }
}

/// Iso-distances on a plane of quads and triangles: how far a circle is from round.
TEST(GeodesicAccuracy, keeps_circles_round) {
  Model model = test::mixed_panel(0.3, 0.4);
  for (std::size_t n = 0; n < model.node_count(); ++n) {
    Vec3 flat = model.positions[n];
    flat.z() = 0;
    model.positions.set(n, flat);
  }
  const Patch patch = cut_patch(model, all_shells(model));
  const std::uint32_t middle = nearest(patch, Vec3(46, 46, 0));
  const std::vector<double> distance = geodesic_distance(patch, std::vector<std::uint32_t>{middle});
  double most = 0;
  for (std::uint32_t i = 0; i < distance.size(); ++i) {
    const double radius = (patch.positions[i] - patch.positions[middle]).norm();
    if (radius > 0 && radius <= 44) most = std::max(most, std::abs(distance[i] / radius - 1));
  }
  std::cout << "  circles are round to " << std::scientific << most << " of their radius\n";
  EXPECT_LE(most, 1e-9);
}

/// The shells around a node, ring by ring, until there are enough.
ShellSet around(const Model& model, NodeIndex node, std::size_t enough) {
  NodeSet nodes{node};
  ShellSet shells;
  while (shells.size() < enough) {
    ShellSet more = shells_touching(model, nodes);
    if (more.size() == shells.size() || more.size() > 10'000) break;
    shells = std::move(more);
    nodes = nodes_of(model, shells);
  }
  return shells;
}

/// Real panels: mixed, warped, with holes, beads and junctions. From a few nodes of each deck, within half of what was cut out.
TEST(GeodesicAccuracy, of_real_decks) {
  const auto decks = test::real_decks();
  if (!decks) GTEST_SKIP() << "PRISMESH_MODELS doesn't point to the real decks";
  for (const char* file : {"wing_ferig", "bumper_beam_rad", "pillars_open_airbag_v135"}) {
    const Model model = test::open_real(*decks, file);
    for (const double share : {0.3, 0.6}) {
      const NodeIndex start = model.shell(ShellIndex(static_cast<std::size_t>(share * static_cast<double>(model.shell_count())))).node[0];
      const Patch patch = cut_patch(model, around(model, start, 6000));
      const auto source = static_cast<std::uint32_t>(std::lower_bound(patch.nodes.begin(), patch.nodes.end(), start) - patch.nodes.begin());
      double farthest = 0;
      for (const double d : geodesic_distance(patch, std::vector<std::uint32_t>{source}))
        if (d < kUnreached) farthest = std::max(farthest, d);
      expect_within_aim(file, patch, {source}, 0.6 * farthest);
    }
  }
}

}  // namespace
}  // namespace prismesh::mesh::spatial
