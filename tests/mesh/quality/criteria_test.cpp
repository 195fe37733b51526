#include "mesh/quality/criteria.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/quality/judge.h"
#include "mesh/quality/limits.h"
#include "mesh/quality/measure.h"
#include "tests/support/places.h"

namespace prismesh::mesh::quality {
namespace {

using ::testing::HasSubstr;

Criteria parsed(const std::string& text) {
  const Result<Criteria> criteria = parse_criteria(text, "mine.toml");
  EXPECT_TRUE(criteria) << (criteria ? "" : criteria.error().text());
  return criteria.value_or(Criteria{});
}

Error refused(const std::string& text) {
  const Result<Criteria> criteria = parse_criteria(text, "mine.toml");
  EXPECT_FALSE(criteria) << text;
  return criteria ? Error{} : criteria.error();
}

/// A quad's values that every criterion likes, for a target size of 10.
Values good_quad() {
  Values values;
  values.fill(std::numeric_limits<float>::quiet_NaN());
  const auto set = [&](Metric m, float value) { values[int(m)] = value; };
  set(Metric::warpage, 0);
  set(Metric::aspect, 1);
  set(Metric::skew, 0);
  set(Metric::jacobian, 1);
  set(Metric::taper, 0);
  set(Metric::min_angle_quad, 90);
  set(Metric::max_angle_quad, 90);
  set(Metric::min_length, 10);
  set(Metric::max_length, 10);
  return values;
}
Values good_triangle() {
  Values values = good_quad();
  for (const Metric m : {Metric::warpage, Metric::jacobian, Metric::taper, Metric::min_angle_quad, Metric::max_angle_quad})
    values[int(m)] = std::numeric_limits<float>::quiet_NaN();
  values[int(Metric::min_angle_tri)] = values[int(Metric::max_angle_tri)] = 60;
  return values;
}

struct Case {
  Metric metric;
  float ok, warn, fail;
};

TEST(Criteria, the_default_has_the_thresholds_it_documents) {
  const Case cases[] = {
      {Metric::warpage, 12.9f, 14, 15.1f},     {Metric::aspect, 4.3f, 4.5f, 5.1f},       {Metric::skew, 33, 35, 41},
      {Metric::jacobian, 0.71f, 0.65f, 0.59f}, {Metric::taper, 0.49f, 0.55f, 0.61f},     {Metric::min_angle_quad, 46.5f, 45, 39},
      {Metric::max_angle_quad, 133, 135, 141}, {Metric::min_angle_tri, 34.5f, 33, 29},   {Metric::max_angle_tri, 111, 113, 121},
      {Metric::min_length, 4.1f, 3.9f, 1.9f},  {Metric::max_length, 14.9f, 15.1f, 20.1f}};
  for (const Case& one : cases) {
    const bool triangle = one.metric == Metric::min_angle_tri || one.metric == Metric::max_angle_tri;
    const auto grade = [&](float value) {
      Values values = triangle ? good_triangle() : good_quad();
      values[int(one.metric)] = value;
      return judge(values, {default_criteria(), 10.0});
    };
    const auto bit = static_cast<std::uint16_t>(1u << int(one.metric));
    EXPECT_EQ(grade(one.ok), ShellState()) << name(one.metric);
    EXPECT_EQ(grade(one.warn), (ShellState{bit, 0})) << name(one.metric);
    EXPECT_EQ(grade(one.fail), (ShellState{bit, bit})) << name(one.metric);
    EXPECT_EQ(grade(one.warn).grade(), Grade::warn);
    EXPECT_EQ(grade(one.fail).grade(), Grade::fail);
  }
  EXPECT_EQ(default_criteria().warn_triangles_percent, 10);
  EXPECT_EQ(default_criteria().fail_triangles_percent, 15);
}

TEST(Criteria, a_metric_that_is_not_named_is_not_judged) {
  Values values = good_quad();
  values[int(Metric::warpage)] = 170;
  values[int(Metric::aspect)] = 1e8f;
  EXPECT_EQ(judge(values, {parsed("[metrics.skew]\nfail_above = 40"), 10.0}), ShellState());
}

TEST(Criteria, what_fails_also_warns) {
  Values values = good_quad();
  values[int(Metric::skew)] = 41;
  const ShellState state = judge(values, {parsed("[metrics.skew]\nfail_above = 40"), 10.0});
  EXPECT_EQ(state.warn, state.fail);
  EXPECT_EQ(state.grade(), Grade::fail);
}

TEST(Criteria, quads_and_triangles_apart_and_lengths_by_thickness) {
  const Criteria criteria = parsed(
      "name = \"published\"\n[metrics.skew.quad]\nfail_above = 48\n[metrics.skew.triangle]\nfail_above = 60\n"
      "[metrics.min_length]\nfail_below_thicknesses = 1.1\n");
  EXPECT_EQ(criteria.name, "published");
  Values quad = good_quad(), triangle = good_triangle();
  quad[int(Metric::skew)] = triangle[int(Metric::skew)] = 50;
  EXPECT_EQ(judge(quad, {criteria, 10.0}).grade(), Grade::fail);
  EXPECT_EQ(judge(triangle, {criteria, 10.0}).grade(), Grade::ok);
  triangle[int(Metric::skew)] = 61;
  EXPECT_EQ(judge(triangle, {criteria, 10.0}).grade(), Grade::fail);
  EXPECT_EQ(judge(good_quad(), {criteria, 10.0}, 9.0).grade(), Grade::ok);
  EXPECT_EQ(judge(good_quad(), {criteria, 10.0}, 9.2).grade(), Grade::fail);
  EXPECT_EQ(judge(good_quad(), {criteria, 10.0}, 0.0).grade(), Grade::ok);  // unknown
}

TEST(Criteria, a_thin_sheet_keeps_the_least_length_of_the_target_size) {
  const Criteria criteria = parsed("[metrics.min_length]\nfail_below = 0.2\nfail_below_thicknesses = 1.1\n");
  Values quad = good_quad();
  quad[int(Metric::min_length)] = 1.9F;
  EXPECT_EQ(judge(quad, {criteria, 10.0}, 0.5).grade(), Grade::fail);
  quad[int(Metric::min_length)] = 2.1F;
  EXPECT_EQ(judge(quad, {criteria, 10.0}, 0.5).grade(), Grade::ok);
}

TEST(Criteria, a_wanted_time_step_sets_the_least_length_by_the_material) {
  Criteria criteria = parsed("[metrics.min_length]\nfail_below = 0.2\n[time_step]\nwanted = 5e-7\nwarn_below = 6e-7");
  const double steel = 5.4219e6;  // mm/s
  const auto grade = [&](float length, const ShellProperties& properties) {
    Values values = good_quad();
    values[int(Metric::min_length)] = length;
    return judge(values, {criteria, 10.0}, properties).grade();
  };
  // 0.5 microseconds of a step that is 0.9 of what the length takes: 3.01 mm
  EXPECT_EQ(grade(3.0f, ShellProperties(0, steel)), Grade::fail);
  EXPECT_EQ(grade(3.02f, ShellProperties(0, steel)), Grade::warn);
  EXPECT_EQ(grade(3.60f, ShellProperties(0, steel)), Grade::warn);
  EXPECT_EQ(grade(3.62f, ShellProperties(0, steel)), Grade::ok);
  // where the material isn't known the fraction of the target size counts
  EXPECT_EQ(grade(2.1f, ShellProperties()), Grade::ok);
  EXPECT_EQ(grade(1.9f, ShellProperties()), Grade::fail);
  criteria.time_step_scale = 0.45;
  EXPECT_EQ(grade(6.0f, ShellProperties(0, steel)), Grade::fail);
  EXPECT_EQ(grade(6.04f, ShellProperties(0, steel)), Grade::warn);
}

TEST(Criteria, limits_are_those_that_shells_are_judged_by) {
  const Criteria criteria = parsed(
      "[metrics.min_length]\nwarn_below = 0.4\nfail_below = 0.2\nfail_below_thicknesses = 1.1\n[metrics.max_length]\nfail_above = 2\n"
      "[metrics.skew.quad]\nwarn_above = 34\n[metrics.skew.triangle]\nfail_above = 60\n[time_step]\nwanted = 0.5\nwarn_below = 0.7");
  for (const ShellProperties& properties : {ShellProperties(), ShellProperties(1.0), ShellProperties(3.0), ShellProperties(0, 1.5),
                                            ShellProperties(0, 9.0), ShellProperties(7.0, 9.0)})
    for (const bool of_triangle : {false, true})
      for (const Metric metric : {Metric::min_length, Metric::max_length, Metric::skew, Metric::aspect}) {
        const Threshold limits = threshold_of({criteria, 10}, metric, of_triangle, properties);
        const auto judged = [&](float value) {
          Values values = of_triangle ? good_triangle() : good_quad();
          values[int(metric)] = value;
          const ShellState state = judge(values, {criteria, 10}, properties);
          return std::pair((state.warn >> int(metric) & 1) != 0, (state.fail >> int(metric) & 1) != 0);
        };
        for (const float limit : {limits.warn_low, limits.warn_high, limits.fail_low, limits.fail_high}) {
          if (!std::isfinite(limit)) continue;
          for (const float value : {std::nextafter(limit, -1e9F), limit, std::nextafter(limit, 1e9F)}) {
            const bool fails = value < limits.fail_low || value > limits.fail_high;
            EXPECT_EQ(judged(value), std::pair(fails || value < limits.warn_low || value > limits.warn_high, fails))
                << name(metric) << ' ' << value << " of " << properties.thickness << ' ' << properties.wave_speed;
          }
        }
      }
  EXPECT_NEAR(threshold_of({criteria, 10}, Metric::min_length, false, ShellProperties(0, 9.0)).fail_low, 0.5 * 9 / 0.9, 1e-5);
  EXPECT_NEAR(threshold_of({criteria, 10}, Metric::min_length, false, ShellProperties(7.0, 9.0)).fail_low, 7.7, 1e-5);
}

TEST(Criteria, of_our_own_are_known_by_name) {
  EXPECT_EQ(load_criteria("default")->name, "default");
  const Criteria strict = load_criteria("strict").value();
  EXPECT_EQ(strict.name, "strict");
  EXPECT_FALSE(load_criteria("./strict"));
  // nothing that the strict ones let pass fails by the default ones
  for (int m = 0; m < kMetricCount; ++m) {
    for (const auto shape : {&Criteria::quad, &Criteria::triangle}) {
      const Threshold &a = (strict.*shape)[m], &b = (default_criteria().*shape)[m];
      EXPECT_GE(a.fail_low, b.fail_low) << name(static_cast<Metric>(m));
      EXPECT_GE(a.warn_low, b.warn_low) << name(static_cast<Metric>(m));
      EXPECT_LE(a.fail_high, b.fail_high) << name(static_cast<Metric>(m));
      EXPECT_LE(a.warn_high, b.warn_high) << name(static_cast<Metric>(m));
    }
  }
  EXPECT_LE(strict.fail_triangles_percent, default_criteria().fail_triangles_percent);
}

TEST(Criteria, files_of_a_folder_are_listed_if_they_are_criteria) {
  std::string pattern = (std::filesystem::temp_directory_path() / "prismesh-criteria-XXXXXX").string();
  ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
  const std::filesystem::path folder = pattern;
  const auto put = [&](const char* name, const std::string& text) { std::ofstream(folder / name) << text; };
  put("b.toml", "[metrics.skew]\nfail_above = 3\n");
  put("a.toml", "name = \"ours\"\n");
  put("notes.txt", "name = \"x\"\n");
  put("other.toml", "[package]\nname = \"x\"\n");
  put("deck.k.prismesh.toml", "");
  put("large.toml", std::string(kMaxCriteriaBytes + 1, '\n'));
  std::filesystem::create_directory(folder / "folder.toml");
  EXPECT_THAT(criteria_files_in(folder), ::testing::ElementsAre(folder / "a.toml", folder / "b.toml"));
  EXPECT_THAT(criteria_files_in(folder / "gone"), ::testing::IsEmpty());
  EXPECT_EQ(load_criteria(folder / "a.toml")->name, "ours");
  EXPECT_EQ(load_criteria(folder / "b.toml")->name, "b.toml") << "without a name it is that of the file";
  EXPECT_EQ(load_criteria(folder / "large.toml").error().message, "a criteria file has at most 1 MiB");
  EXPECT_THAT(built_in_criteria(), ::testing::ElementsAre("default", "strict", "skew_and_thickness"));
  std::filesystem::remove_all(folder);
}

TEST(Criteria, mistakes_are_named_with_their_line) {
  EXPECT_EQ(refused("[time_step]\nwarn_below = 1").text(),
            "mine.toml:1: time_step needs \"wanted\": the time step that no shell may go below, in the deck's time unit");
  EXPECT_EQ(refused("[time_step]\nwanted = -1").text(), "mine.toml:2: time_step: wanted must be above 0");
  EXPECT_EQ(refused("[time_step]\nwanted = 2\nwarn_below = 1").line, 3);
  EXPECT_EQ(refused("[triangles]\nwarn_above = 9\nfail_above = 8").line, 2);
  EXPECT_EQ(parsed("[triangles]\nfail_above = 8").fail_triangles_percent, 8);
  EXPECT_EQ(refused("[triangles]\nwarn_above_at_node = -1").line, 2);
  EXPECT_EQ(refused("[triangles]\nwarn_above_at_node = 1e30").text(),
            "mine.toml:2: triangles: warn_above_at_node must be from 0 to 1000000");
  EXPECT_EQ(refused("[metrics.warpag]\nwarn_above = 3").text(),
            "mine.toml:1: the list of metrics has no \"warpag\"; the nearest known is \"warpage\"");
  EXPECT_EQ(refused("\n[metrics.warpage]\nwarn_abov = 3").text(),
            "mine.toml:3: metrics.warpage has no \"warn_abov\"; the nearest known is \"warn_above\"");
  EXPECT_EQ(refused("name = \"x\"\n[metrics.skew]\nfail_above = \"40\"").text(), "mine.toml:3: metrics.skew: fail_above must be a number");
  EXPECT_EQ(refused("[metrics.skew]\nfail_above = nan").line, 2);
  EXPECT_THAT(refused("[metrics.skew]\nwarn_above = 50\nfail_above = 40").text(),
              HasSubstr("mine.toml:2: metrics.skew: warn_above lies beyond"));
  EXPECT_THAT(refused("[metrics.jacobian]\nfail_below = 0.6\nwarn_below = 0.5").text(),
              HasSubstr("mine.toml:3: metrics.jacobian: warn_below lies beyond"));
  EXPECT_EQ(refused("[metrics.skew]\nfail_above = true").text(), "mine.toml:2: metrics.skew: fail_above must be a number");
  EXPECT_THAT(refused("[metrics.taper.triangel]\nfail_above = 1").text(), HasSubstr("\"triangle\""));
  EXPECT_THAT(refused("metrics = 3").text(), HasSubstr("must be a table"));
  const Error syntax = refused("[metrics.skew]\nfail_above = = 4");
  EXPECT_EQ(syntax.line, 2);
  EXPECT_THAT(syntax.message, HasSubstr("not TOML"));
}

TEST(Criteria, published_sets_load) {
  EXPECT_FALSE(load_criteria("/nonexistent/criteria.toml"));
  const std::filesystem::path folder = test::source_folder() / "mesh/quality/criteria";
  std::size_t sets = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".toml") continue;
    const Result<Criteria> criteria = load_criteria(entry.path());
    ASSERT_TRUE(criteria) << criteria.error().text();
    EXPECT_FALSE(criteria->name.empty());
    ++sets;
  }
  EXPECT_GE(sets, 2u);
}

TEST(Criteria, points_are_judged_as_shells_are) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(0, 2);
  std::vector<Vec3> moving, fixed;
  for (int i = 0; i < 60; ++i) {
    moving.emplace_back(anywhere(random), anywhere(random), 0.2 * anywhere(random));
    fixed.emplace_back(anywhere(random), anywhere(random), 0.2 * anywhere(random));
  }
  std::vector<std::array<std::int32_t, 4>> corners;
  std::vector<ShellProperties> thickness;
  std::uniform_int_distribution<std::int32_t> pick(-60, 59);
  for (int s = 0; s < 500; ++s) {
    std::array<std::int32_t, 4> c = {pick(random), pick(random), pick(random), pick(random)};
    if (s % 3 == 0) c[3] = c[2];
    corners.push_back(c);
    thickness.emplace_back(anywhere(random));
  }
  const Criteria criteria = parsed("[metrics.min_length]\nfail_below_thicknesses = 0.5\n[metrics.aspect]\nwarn_above = 2\n");
  std::vector<ShellState> states(corners.size());
  judge_points({moving, fixed, corners, thickness}, {criteria, 1.0}, states);
  for (std::size_t s = 0; s < corners.size(); ++s) {
    std::vector<Vec3> p;
    for (std::size_t i = 0; i < (corners[s][3] == corners[s][2] ? 3u : 4u); ++i) {
      const std::int32_t at = corners[s][i];
      p.push_back(at >= 0 ? moving[static_cast<std::size_t>(at)] : fixed[static_cast<std::size_t>(~at)]);
    }
    EXPECT_EQ(states[s], judge(measure(p), {criteria, 1.0}, thickness[s])) << s;
  }
}

}  // namespace
}  // namespace prismesh::mesh::quality
