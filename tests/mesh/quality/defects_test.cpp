#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "mesh/model/topology_change.h"
#include "mesh/quality/composite.h"
#include "mesh/quality/judge.h"
#include "mesh/quality/mass.h"
#include "mesh/quality/measure.h"
#include "mesh/quality/report.h"
#include "mesh/quality/target_size.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::quality {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<Defect> defects_of(const std::vector<Vec3>& corners) {
  const ShellState state = judge(measure(corners), {default_criteria(), 1.0});
  std::vector<Defect> found;
  for (const Defect defect : kDefects)
    if (state.has(defect)) found.push_back(defect);
  return found;
}
using Found = std::vector<Defect>;

TEST(Defects, each_kind_is_told_apart) {
  EXPECT_EQ(defects_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}), Found{});
  EXPECT_EQ(defects_of({{0, 0, 0}, {1, 0, kNaN}, {1, 1, 0}, {0, 1, 0}}), Found{Defect::not_finite});
  EXPECT_EQ(defects_of({{0, 0, 0}, {1, 0, 0}, {1, kInfinity, 0}, {0, 1, 0}}), Found{Defect::not_finite});
  EXPECT_EQ(defects_of({{0, 0, 0}, {1, 0, 0}, {1, -kInfinity, 0}}), Found{Defect::not_finite});
  EXPECT_EQ(defects_of({{0, 0, 0}, {1e60, 0, 0}, {0, 1, 0}}), Found{Defect::not_finite});
  // a triangle in disguise has area
  EXPECT_EQ(defects_of({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}}), Found{Defect::repeated_node});
  EXPECT_EQ(defects_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}), Found{Defect::no_area});
  EXPECT_EQ(defects_of({{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}), Found{Defect::no_area});
  const Found both = {Defect::repeated_node, Defect::no_area};
  EXPECT_EQ(defects_of({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}}), both);
  EXPECT_EQ(defects_of({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}), both);
  // folded along a diagonal, corner on corner
  EXPECT_EQ(defects_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, 0}}), both);
}

TEST(Defects, a_quad_whose_sides_cross_is_folded_even_where_area_is_left) {
  EXPECT_EQ(defects_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}), Found{Defect::no_area});
  EXPECT_EQ(defects_of({{0, 0, 0}, {3, 0, 0}, {0, 1, 0}, {1, 1, 0}}), Found{Defect::no_area});
  // one corner turned in is no fold: the arrowhead fails by its angles
  EXPECT_EQ(defects_of({{0, 0, 0}, {3, -3, 0}, {1, 0, 0}, {3, 3, 0}}), Found{});
}

TEST(Defects, slivers_that_are_not_quite_flat_keep_their_metrics) {
  const std::vector<Vec3> sliver = {{0, 0, 0}, {1, 0, 0}, {0.5, 1e-9, 0}};
  EXPECT_EQ(defects_of(sliver), Found{});
  EXPECT_LT(measure(sliver)[int(Metric::skew)], 90);
  EXPECT_EQ(judge(measure(sliver), {default_criteria(), 1.0}).grade(), Grade::fail);
  const std::vector<Vec3> needle = {{0, 0, 0}, {1, 0, 0}, {1, 1e-10, 0}, {0, 1e-10, 0}};
  EXPECT_LT(measure(needle)[int(Metric::aspect)], 1e9f);
}

TEST(Defects, fail_whatever_the_criteria) {
  const Criteria none;
  EXPECT_EQ(judge(measure(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {kNaN, 1, 0}}), {none, 1.0}).grade(), Grade::fail);
  EXPECT_EQ(judge(measure(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}), {none, 1.0}).grade(), Grade::fail);
  EXPECT_EQ(judge(measure(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {5, 1, 0}}), {none, 1.0}).grade(), Grade::ok);
}

/// Good quads in a row with one of each defect among them.
Model with_bad_shells() {
  std::vector<Vec3> points;
  for (int i = 0; i <= 6; ++i) points.insert(points.end(), {Vec3(i, 0, 0), Vec3(i, 1, 0)});
  points.emplace_back(kNaN, 0, 0);
  points.emplace_back(0, kInfinity, 0);
  return test::make_shells(points, {{0, 2, 3, 1},
                                    {2, 4, 5, 3},
                                    {4, 6, 7, 5},
                                    {2, 4, 14, 3},   // not finite
                                    {0, 2, 15, 15},  // not finite
                                    {0, 0, 2, 3},    // one node at two corners
                                    {0, 2, 4, 4},    // on a line
                                    {6, 8, 9, 7},
                                    {0, 3, 2, 1}});  // crossed
}

TEST(Defects, enter_no_minimum_and_no_mean) {
  Model model = with_bad_shells();
  Part part;
  part.id = 1;
  part.thickness = 1;
  part.density = 2;
  part.youngs_modulus = 3;
  part.poissons_ratio = 0;
  model.parts = std::make_shared<const std::vector<Part>>(1, part);
  const Report r = report(model, {default_criteria(), 1.0}, {});
  EXPECT_EQ(r.elements, 9u);
  EXPECT_EQ(r.counts, (Counts{4, 0, 5}));
  EXPECT_EQ(r.defects, (std::array<std::size_t, kDefectCount>{2, 1, 2}));
  for (int m = 0; m < kMetricCount; ++m) {
    const MetricSummary& s = r.metrics[m];
    const auto metric = static_cast<Metric>(m);
    const bool of_triangles = metric == Metric::min_angle_tri || metric == Metric::max_angle_tri;
    EXPECT_EQ(s.measured, of_triangles ? 0u : 4u) << name(metric);
    EXPECT_EQ(s.fail, 0u) << name(metric);
    EXPECT_TRUE(std::isfinite(s.min) && std::isfinite(s.mean) && std::isfinite(s.max)) << name(metric);
  }
  EXPECT_EQ(r.metrics[int(Metric::aspect)].max, 1);
  EXPECT_EQ(r.metrics[int(Metric::aspect)].mean, 1);
  EXPECT_EQ(r.min_composite, -1);
  EXPECT_NEAR(r.mean_composite, (4.0 - 5.0) / 9, 1e-6);
  // 4 good ones, and the triangle that repeats a node has its half; crossed corners still have two triangles
  EXPECT_TRUE(std::isfinite(*r.mass));
  EXPECT_TRUE(r.centre_of_gravity->allFinite());
  EXPECT_TRUE(std::isfinite(r.time_step->seconds));
  EXPECT_GT(r.time_step->seconds, 0);
  EXPECT_TRUE(std::isfinite(guess_target_size(model)));
  EXPECT_TRUE(std::isfinite(mass_properties(model).mass));
}

Model grid(int columns, int rows) {
  return test::make_grid(columns, rows, [](int i, int j) { return Vec3(i, j, 0); });
}

TEST(Removed, shells_count_for_nothing) {
  Model model = grid(4, 4);
  const ChunkedArray<ShellState> before = judge_model(model, {default_criteria(), 1.0});
  ChunkedArray<ShellState> states = before;
  Counts counts = count(states);
  remove_shell(model, ShellIndex(std::size_t{3}));
  remove_shell(model, ShellIndex(std::size_t{7}));
  model.adjacency = std::make_shared<Adjacency>(build_adjacency(model));
  const ShellSet gone = {ShellIndex(std::size_t{3}), ShellIndex(std::size_t{7})};
  for (int again = 0; again < 2; ++again) {
    rejudge(model, {default_criteria(), 1.0}, gone, states, counts);
    EXPECT_EQ(counts, (Counts{14, 0, 0}));
  }
  EXPECT_EQ(count(states), counts);
  EXPECT_EQ(count(judge_model(model, {default_criteria(), 1.0})), counts);
  EXPECT_TRUE(states[3].is_removed());
  EXPECT_EQ(states[3].grade(), Grade::ok);
  EXPECT_EQ(report(model, {default_criteria(), 1.0}, {}).elements, 14u);
  EXPECT_EQ(report(model, {default_criteria(), 1.0}, {}, &gone).elements, 0u);
  EXPECT_EQ(guess_target_size(model), 1.0);
  std::vector<Values> values(16);
  measure_range(model, 0, 16, values);
  EXPECT_TRUE(std::isnan(values[3][int(Metric::aspect)]));
  EXPECT_EQ(values[4][int(Metric::aspect)], 1);
}

TEST(Removed, shells_weigh_nothing) {
  Model model = grid(2, 1);
  auto parts = std::make_shared<std::vector<Part>>(1);
  (*parts)[0].density = 2.0;
  (*parts)[0].thickness = 3.0;
  model.parts = parts;
  remove_shell(model, ShellIndex(std::size_t{1}));
  EXPECT_EQ(mass_properties(model).mass, 6);
  EXPECT_EQ(mass_properties(model).shells, 1u);
  EXPECT_EQ(mass_properties(model, ShellIndex(std::size_t{1})).mass, 0);
}

TEST(Removed, added_shells_are_judged_though_nobody_named_them) {
  Model model = grid(70, 60);  // the last chunk grows
  ChunkedArray<ShellState> states = judge_model(model, {default_criteria(), 1.0});
  Counts counts = count(states);
  const ShellNodes& corner = model.shell(ShellIndex(std::size_t{0}));
  const NodeIndex far = add_node(model, 100000, {5, 0.2, 0}, edge_origin(corner.node[0], corner.node[1]));
  const ShellIndex added = add_shell(model, 100000, {{corner.node[0], corner.node[1], far, far}}, ShellIndex(std::size_t{0}));
  rejudge(model, {default_criteria(), 1.0}, {ShellIndex(std::size_t{0})}, states, counts);
  ASSERT_EQ(states.size(), model.shell_count());
  EXPECT_EQ(states[added.value].grade(), Grade::fail);
  EXPECT_EQ(counts, (Counts{4200, 0, 1}));
  EXPECT_EQ(counts, count(judge_model(model, {default_criteria(), 1.0})));
  // and the other way: back to the model without it
  rejudge(grid(70, 60), {default_criteria(), 1.0}, {}, states, counts);
  EXPECT_EQ(states.size(), 4200u);
  EXPECT_EQ(counts, (Counts{4200, 0, 0}));
}

}  // namespace
}  // namespace prismesh::mesh::quality
