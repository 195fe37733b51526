#include "mesh/quality/composite.h"

#include <cmath>

#include <gtest/gtest.h>

#include "mesh/model/topology_change.h"
#include "mesh/quality/judge.h"
#include "mesh/quality/measure.h"
#include "mesh/quality/report.h"
#include "mesh/quality/shell_properties.h"
#include "tests/mesh/quality/mixed_grid.h"

namespace prismesh::mesh::quality {
namespace {

Criteria criteria_of(const std::string& text) { return parse_criteria(text, "mine.toml").value(); }

float rated(const std::vector<Vec3>& corners, const Criteria& criteria = default_criteria(), double target_size = 1,
            const ShellProperties& properties = {}) {
  return composite(measure(corners), {criteria, target_size}, properties);
}

std::vector<Vec3> rectangle(double width, double height) { return {{0, 0, 0}, {width, 0, 0}, {width, height, 0}, {0, height, 0}}; }

TEST(Composite, is_1_where_nothing_could_be_better) {
  EXPECT_EQ(rated(rectangle(1, 1)), 1);
  EXPECT_NEAR(rated({{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}}), 1, 1e-6);
  EXPECT_EQ(rated(rectangle(1, 1), Criteria{}), 1);                                       // nothing is judged
  EXPECT_EQ(rated(rectangle(9, 1), criteria_of("[metrics.aspect]\nwarn_above = 3")), 1);  // no fail limit
}

TEST(Composite, runs_evenly_from_the_ideal_to_the_fail_limit) {
  const Criteria aspect = criteria_of("[metrics.aspect]\nwarn_above = 4\nfail_above = 5");
  EXPECT_NEAR(rated(rectangle(3, 1), aspect), 0.5, 1e-6);
  EXPECT_NEAR(rated(rectangle(5, 1), aspect), 0, 1e-6);
  EXPECT_GE(rated(rectangle(5, 1), aspect), 0);
  const Criteria lengths = criteria_of("[metrics.min_length]\nfail_below = 0.2\n[metrics.max_length]\nfail_above = 2");
  EXPECT_NEAR(rated(rectangle(0.6, 1), lengths), 0.5, 1e-6);
  EXPECT_NEAR(rated(rectangle(1.5, 1), lengths), 0.5, 1e-6);
  EXPECT_NEAR(rated(rectangle(15, 10), lengths, 10), 0.5, 1e-6);
  // the worst metric counts
  EXPECT_NEAR(rated(rectangle(1.5, 0.36), lengths), 0.2, 1e-6);
}

TEST(Composite, goes_towards_minus_1_where_it_fails_and_still_tells_bad_from_worse) {
  const Criteria aspect = criteria_of("[metrics.aspect]\nfail_above = 5");
  EXPECT_NEAR(rated(rectangle(9, 1), aspect), -0.5, 1e-6);
  float before = 0;
  for (const double width : {5.001, 6.0, 20.0, 500.0, 1e5}) {
    const float now = rated(rectangle(width, 1), aspect);
    EXPECT_LT(now, before) << width;
    EXPECT_GT(now, -1) << width;
    before = now;
  }
}

TEST(Composite, defects_have_minus_1_and_nothing_else_has) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(rated({{0, 0, 0}, {1, 0, 0}, {nan, 1, 0}, {0, 1, 0}}), -1);
  EXPECT_EQ(rated({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}), -1);
  EXPECT_EQ(rated({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, Criteria{}), -1);
  EXPECT_GT(rated({{0, 0, 0}, {1, 0, 0}, {0.5, 1e-9, 0}}), -1);
}

TEST(Composite, thickness_and_wanted_time_step_set_the_least_length) {
  const Criteria thick = criteria_of("[metrics.min_length]\nfail_below = 0.2\nfail_below_thicknesses = 2");
  EXPECT_NEAR(rated(rectangle(0.6, 1), thick, 1, ShellProperties(0.1)), 0.5, 1e-6);
  EXPECT_NEAR(rated(rectangle(0.6, 1), thick, 1, ShellProperties(0.2)), 0.2 / 0.6, 1e-6);
  EXPECT_LT(rated(rectangle(0.6, 1), thick, 1, ShellProperties(0.4)), 0);
  // 0.5 of a time step (the deck takes 0.9 of what the length gives) at 1.08 a time unit: 0.6
  const Criteria step = criteria_of("[metrics.min_length]\nfail_below = 0.2\n[time_step]\nwanted = 0.5");
  EXPECT_NEAR(rated(rectangle(0.8, 1), step, 1, ShellProperties(0, 1.08)), 0.5, 1e-6);
  EXPECT_NEAR(rated(rectangle(0.6, 1), step, 1), 0.5, 1e-6);
  // where nothing is known nothing is judged
  EXPECT_EQ(rated(rectangle(0.6, 1), criteria_of("[metrics.min_length]\nfail_below_thicknesses = 2"), 1), 1);
}

TEST(Composite, falls_over_a_twentieth_of_a_limit_that_is_the_ideal) {
  const Criteria criteria = parse_criteria("[metrics.max_length]\nfail_above = 1\n", "mine.toml").value();
  Values values;
  values.fill(std::numeric_limits<float>::quiet_NaN());
  values[int(Metric::aspect)] = 1;
  values[int(Metric::max_length)] = 10.5F;
  EXPECT_NEAR(composite(values, {criteria, 10}, {}), -0.5, 1e-5);
}

TEST(Composite, is_a_number_whatever_the_limits) {
  for (const char* limit : {"fail_above = 1e30", "fail_above = -1e30", "fail_above = 0", "fail_below = 1e30", "fail_below = -1e30",
                            "fail_above = 1e-30", "fail_below = 1\nfail_above = 1"})
    for (const char* metric : {"aspect", "warpage", "min_length", "min_angle_quad"}) {
      const Criteria criteria = criteria_of("[metrics." + std::string(metric) + "]\n" + limit);
      for (const double size : {1.0, 1e20, 1e-20}) {
        const Values values = measure(rectangle(3, 1));
        const float figure = composite(values, {criteria, size});
        EXPECT_TRUE(figure > -1 && figure <= 1) << metric << ' ' << limit;
        EXPECT_EQ(figure < 0, judge(values, {criteria, size}).grade() == Grade::fail) << metric << ' ' << limit << ' ' << size;
      }
    }
}

TEST(Composite, is_negative_exactly_where_a_shell_fails) {
  const Model model = test::mixed_grid(30, 0.6, true, 21);
  for (const double size : {0.4, 1.0, 3.0}) {
    const ChunkedArray<ShellState> states = judge_model(model, {default_criteria(), size});
    std::vector<ShellIndex> shells;
    for (std::size_t s = 0; s < model.shell_count(); ++s) shells.emplace_back(s);
    std::vector<float> figures(shells.size());
    composites(model, shells, {default_criteria(), size}, figures);
    std::size_t failing = 0;
    double sum = 0, least = 1;
    for (std::size_t s = 0; s < shells.size(); ++s) {
      EXPECT_EQ(figures[s] < 0, states[s].grade() == Grade::fail) << s;
      EXPECT_EQ(figures[s] == -1, states[s].has_defect()) << s;
      failing += figures[s] < 0;
      sum += figures[s];
      least = std::min<double>(least, figures[s]);
    }
    EXPECT_GT(failing, 0u);
    const Report r = report(model, {default_criteria(), size}, {});
    EXPECT_EQ(r.min_composite, least);
    EXPECT_NEAR(r.mean_composite, sum / static_cast<double>(shells.size()), 1e-9);
  }
}

TEST(Composite, comes_with_the_metrics_it_is_made_of) {
  const Model model = test::mixed_grid(20, 0.6, true, 22);
  std::vector<ShellIndex> shells;
  for (std::size_t s = 0; s < model.shell_count(); s += 2) shells.emplace_back(s);
  std::vector<float> alone(shells.size()), figures(shells.size());
  std::vector<Values> measured(shells.size()), values(shells.size());
  measure_shells(model, shells, measured);
  composites(model, shells, {default_criteria(), 1.0}, alone);
  composites(model, shells, {default_criteria(), 1.0}, figures, values);
  EXPECT_EQ(figures, alone);
  for (std::size_t i = 0; i < shells.size(); ++i)
    for (std::size_t m = 0; m < kMetricCount; ++m) {
      EXPECT_EQ(std::isnan(values[i][m]), std::isnan(measured[i][m]));
      if (!std::isnan(measured[i][m])) {
        EXPECT_EQ(values[i][m], measured[i][m]);
      }
    }
}

TEST(Composite, alone_in_batches_and_by_points_is_the_same) {
  Model model = test::mixed_grid(30, 0.6, true, 21);
  remove_shell(model, ShellIndex(std::size_t{17}));
  const Criteria criteria =
      criteria_of("[metrics.min_length]\nfail_below = 0.2\nfail_below_thicknesses = 1\n[metrics.skew]\nfail_above = 40");
  for (std::size_t s = 0; s < model.shell_count(); ++s) model.shell_thickness.set(s, 0.1f + 0.01f * static_cast<float>(s % 50));
  std::vector<ShellIndex> shells;
  std::vector<std::array<std::int32_t, 4>> corners;
  std::vector<Vec3> points;
  std::vector<ShellProperties> properties;
  for (std::size_t n = 0; n < model.node_count(); ++n) points.push_back(model.positions[n]);
  for (std::size_t s = 0; s < model.shell_count(); s += 3) {
    if (model.is_removed(ShellIndex(s))) continue;
    shells.emplace_back(s);
    const auto node = [&](std::size_t c) { return static_cast<std::int32_t>(model.shell_nodes[s].node[c].value); };
    corners.push_back({node(0), node(1), node(2), node(3)});
    properties.push_back(properties_of(model, ShellIndex(s)));
  }
  std::vector<float> batch(shells.size()), by_points(shells.size());
  std::vector<ShellState> states(shells.size());
  composites(model, shells, {criteria, 1.0}, batch);
  judge_points({points, {}, corners, properties}, {criteria, 1.0}, states, by_points);
  for (std::size_t i = 0; i < shells.size(); ++i) {
    std::vector<Vec3> p;
    for (int c = 0; c < model.shell(shells[i]).corners(); ++c) p.push_back(points[static_cast<std::size_t>(corners[i][c])]);
    EXPECT_EQ(batch[i], rated(p, criteria, 1.0, properties[i])) << i;
    EXPECT_EQ(batch[i], by_points[i]) << i;
  }
  const std::vector<ShellIndex> gone = {ShellIndex(std::size_t{17})};
  float figure = 0;
  Values of_gone{};
  composites(model, gone, {criteria, 1.0}, std::span(&figure, 1), std::span(&of_gone, 1));
  EXPECT_EQ(figure, 1);
  for (const float value : of_gone) EXPECT_TRUE(std::isnan(value));
}

}  // namespace
}  // namespace prismesh::mesh::quality
