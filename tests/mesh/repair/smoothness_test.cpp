// Repaired sheets are about as smooth as the shaped ones, and of equal changes the smoother one is taken.
#include "mesh/repair/smoothness.h"

#include <algorithm>
#include <map>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "mesh/quality/report.h"
#include "mesh/repair/redivide.h"
#include "mesh/repair/trial.h"
#include "tests/mesh/repair/patch_fixture.h"
#include "tests/mesh/repair/validator.h"

namespace prismesh::mesh::repair {
namespace {

/// A parabolic trough along y, one quad of which has its diagonals along and across it.
struct Trough {
  static constexpr double kDepth = 0.02;
  static Vec3 place(double x, double y) { return {x, y, kDepth * x * x}; }
  /// Quads turned by 45 degrees: node (i, j) is at x = i - j, y = i + j - 6.
  Grid grid{6, 6, [](double i, double j) { return place(i - j, i + j - 6); }, {}};
};

TEST(Facets, are_fewer_along_a_trough_than_across_it) {
  const Trough trough;
  PatchFixture fixture(model_of(trough.grid.positions(), trough.grid.shells()));
  const LocalShell middle = fixture.shell(trough.grid.shell(2, 2));
  double facets[2];
  for (const int first : {0, 1}) {
    fixture.patch.begin();
    ASSERT_FALSE(split_quad(fixture.context, middle, first));
    EXPECT_NEAR(facets_before(fixture.context), 0, 0.1) << "the middles of quads have the surface's normals";
    facets[first] = facets_now(fixture.context);
    fixture.patch.take_back();
  }
  // Diagonal 0 goes along y. The halves on both sides of the other one rise from it at their outer corners by 2 x the depth.
  EXPECT_LT(facets[0], 1);
  EXPECT_GT(facets[1], 2 * Trough::kDepth * 180 / std::numbers::pi);
}

TEST(Facets, decide_between_changes_of_equal_quality) {
  const Trough trough;
  const Model good = model_of(trough.grid.positions(), trough.grid.shells());
  std::vector<Vec3> positions = trough.grid.positions();
  const std::size_t node = trough.grid.node(3, 3), shell = trough.grid.shell(2, 2);
  positions[node] = Trough::place(0, -1.9);
  PatchFixture fixture(model_of(positions, trough.grid.shells()));
  Rules rules;
  rules.node = [](NodeIndex) { return std::uint8_t{kStays}; };
  const relax::ReferenceSurface surface(good, all_shells(good), 30);
  const quality::SizedCriteria criteria{quality::default_criteria(), 1.5};  // so that no diagonal is too long
  for (const int first : {0, 1}) {
    Patch patch(fixture.model, all_shells(fixture.model), 1, rules, 30);
    const RepairContext context{patch, surface, criteria, fixture.options, quality::limits_for(criteria)};
    const Progress none;
    RepairState state{{}, {}, {none}};
    state.clusters = {4, {0, 0, 0}, {}, {}};
    state.history.max_triangles = 100;
    state.history.max_triangles_by_split = 100;
    state.history.added_triangle_pairs = -1;  // so that a pair is allowed
    patch.begin();
    std::vector<LocalShell> all;
    for (std::size_t s = 0; s < patch.shell_count(); ++s) all.push_back(LocalShell(s));
    judge_shells(context, all);
    patch.keep();
    const LocalNode moved = patch.find(at(node));
    const LocalShell split = patch.find(shell_at(shell));
    std::vector<Candidate> candidates;
    for (const int diagonal : {first, 1 - first})
      candidates.push_back({Operation::split, [&, diagonal]() -> Refusal {
                              patch.move(moved, Trough::place(0, 0));
                              return split_quad(context, split, diagonal);
                            }});
    ASSERT_TRUE(improve(context, state, candidates, split, TrialGoal::cure));
    // the diagonal along the trough has the corners (2, 2) and (3, 3)
    const auto has = [&](std::size_t i, std::size_t j) {
      const Corners& corners = patch.shell(split).corners;
      return std::find(corners.begin(), corners.end(), patch.find(at(trough.grid.node(i, j)))) != corners.end();
    };
    EXPECT_TRUE(has(2, 2) && has(3, 3)) << "whatever the order of the candidates";
  }
}

/// The 95th percentile of the angles between the normals of neighbours, in degrees, over edges with their middle within `radius` of the
/// z axis. By a map of edges, built here.
double jumps(const Model& model, double radius) {
  std::map<std::pair<NodeIndex, NodeIndex>, std::vector<Vec3>> edges;
  for (const ShellIndex s : all_shells(model)) {
    const ShellNodes& shell = model.shell(s);
    const auto at = [&](std::size_t c) { return model.position(shell.node[c]); };
    const Vec3 normal = (shell.is_triangle() ? (at(1) - at(0)).cross(at(2) - at(0)) : (at(2) - at(0)).cross(at(3) - at(1))).normalized();
    const auto count = static_cast<std::size_t>(shell.corners());
    for (std::size_t c = 0; c < count; ++c) edges[std::minmax(shell.node[c], shell.node[(c + 1) % count])].push_back(normal);
  }
  std::vector<double> angles;
  for (const auto& [edge, normals] : edges) {
    const Vec3 middle = 0.5 * (model.position(edge.first) + model.position(edge.second));
    if (normals.size() == 2 && std::hypot(middle.x(), middle.y()) < radius)
      angles.push_back(std::acos(std::min(1.0, normals[0].dot(normals[1]))) * 180 / std::numbers::pi);
  }
  std::sort(angles.begin(), angles.end());
  return angles[angles.size() * 95 / 100];
}

/// A bump two elements high: its weight, from 0 at the border to 1 in the middle.
struct Bump {
  const char* name;
  double radius;
  double (*distance)(double x, double y);  ///< from the middle, as a fraction of that to the border
};
void PrintTo(const Bump& bump, std::ostream* out) { *out << bump.name; }

class Bumps : public testing::TestWithParam<Bump> {};

TEST_P(Bumps, stay_smooth_when_they_are_repaired) {
  const Bump& bump = GetParam();
  const Grid grid{16,
                  16,
                  [&](double i, double j) {
                    const double x = i - 8, y = j - 8, d = std::max(0.0, 1 - bump.distance(x, y));
                    return Vec3(x, y, 2 * d * d * (3 - 2 * d));
                  },
                  {}};
  const Model shaped = model_of(grid.positions(), grid.shells());
  const quality::SizedCriteria criteria{quality::default_criteria(), 1};
  const relax::ReferenceSurface surface(shaped, all_shells(shaped), 30);
  const auto bad = quality::count(quality::judge_model(shaped, criteria));
  ASSERT_GE(bad.fail, 8u);
  const auto repaired = repair({shaped, surface, {}, criteria, {}}, all_shells(shaped));
  ASSERT_TRUE(repaired.has_value());
  const Model after = carried_out(shaped, repaired->change);
  EXPECT_EQ(what_is_wrong(after), "");
  EXPECT_EQ(quality::count(quality::judge_model(after, criteria)).fail, 0u);
  const double before = jumps(shaped, bump.radius + 1), now = jumps(after, bump.radius + 1);
  RecordProperty("jumps_before", std::to_string(before));
  RecordProperty("jumps_after", std::to_string(now));
  EXPECT_LE(now, 1.2 * before);
}

INSTANTIATE_TEST_SUITE_P(OfThreeShapes, Bumps,
                         testing::Values(Bump{"round", 4, [](double x, double y) { return std::hypot(x, y) / 4; }},
                                         Bump{"small", 3, [](double x, double y) { return std::hypot(x, y) / 3.5; }},
                                         Bump{"long", 6, [](double x, double y) { return std::hypot(x / 6, y / 3.5); }}),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace prismesh::mesh::repair
