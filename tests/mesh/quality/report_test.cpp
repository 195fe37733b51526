#include "mesh/quality/report.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "mesh/quality/mass.h"
#include "mesh/quality/target_size.h"
#include "mesh/quality/time_step.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::quality {
namespace {

Part steel() {
  Part part;
  part.id = 1;
  part.defined = true;
  part.thickness = 1.5;
  part.density = 7.85e-9;
  part.youngs_modulus = 210000.0;
  part.poissons_ratio = 0.3;
  return part;
}

void set_parts(Model& model, std::vector<Part> parts) { model.parts = std::make_shared<const std::vector<Part>>(std::move(parts)); }

Model steel_grid(int columns, int rows, double size) {
  Model model = test::make_grid(columns, rows, [&](int i, int j) { return Vec3(i * size, j * size, 0); });
  set_parts(model, {steel()});
  return model;
}

Report report_of(const Model& model, const TimeStepControl& control = {}, const ShellSet* shells = nullptr) {
  return report(model, {default_criteria(), 5.0}, control, shells);
}

TEST(Report, mass_and_centre_of_a_plate) {
  const Report r = report_of(steel_grid(20, 10, 5));
  ASSERT_TRUE(r.mass);
  EXPECT_NEAR(*r.mass, 100 * 50 * 1.5 * 7.85e-9, 1e-15);
  EXPECT_NEAR((*r.centre_of_gravity - Vec3(50, 25, 0)).norm(), 0, 1e-9);
  EXPECT_EQ(r.elements, 200u);
  EXPECT_EQ(r.counts, (Counts{200, 0, 0}));
}

TEST(MassProperties, what_is_added_and_taken_off_again_leaves_mass_and_centre) {
  const Model model = steel_grid(3, 1, 5);
  const MassProperties all = mass_properties(model);
  MassProperties rest = all;
  const MassProperties last = mass_properties(model, ShellIndex(2));
  rest -= last;
  EXPECT_NEAR(rest.mass, 2 * last.mass, 1e-18);
  EXPECT_NEAR((*rest.centre() - Vec3(5, 2.5, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(rest.shells, 2u);
  rest += last;
  EXPECT_NEAR((*rest.centre() - Vec3(7.5, 2.5, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(rest.shells, 3u);
}

TEST(Report, a_card_s_own_thickness_counts_before_the_section_s) {
  Model model = steel_grid(2, 1, 10);
  model.shell_thickness.set(1, 4.5f);  // three times the section's: the centre moves to 3/4
  const Report r = report_of(model);
  EXPECT_NEAR(*r.mass, 100 * (1.5 + 4.5) * 7.85e-9, 1e-14);
  EXPECT_NEAR(r.centre_of_gravity->x(), (5 * 1.5 + 15 * 4.5) / 6, 1e-9);
}

TEST(Report, centre_of_a_slanted_quad_is_its_area_s) {
  Model model = test::make_shells({{0, 0, 0}, {4, 0, 0}, {3, 2, 0}, {1, 2, 0}}, {{0, 1, 2, 3}});
  set_parts(model, {steel()});
  // trapezoid: h/3 (a + 2b) / (a + b)
  EXPECT_NEAR(report_of(model).centre_of_gravity->y(), 2.0 / 3 * (4 + 2 * 2) / (4 + 2), 1e-12);
}

TEST(Report, what_is_unknown_is_absent_not_zero) {
  Model model = steel_grid(2, 2, 5);
  Part part = steel();
  part.density.reset();
  set_parts(model, {part});
  EXPECT_FALSE(report_of(model).mass);
  EXPECT_FALSE(report_of(model).centre_of_gravity);
  EXPECT_FALSE(report_of(model).time_step);
  const ShellSet none;
  const Report r = report_of(model, {}, &none);
  EXPECT_EQ(r.elements, 0u);
  EXPECT_EQ(r.metrics[int(Metric::warpage)].measured, 0u);
  EXPECT_FALSE(r.metrics[int(Metric::warpage)].worst);
}

TEST(Report, time_step_of_a_steel_square) {
  const double speed = std::sqrt(210000.0 / (7.85e-9 * (1 - 0.09)));
  EXPECT_NEAR(speed, 5.42e6, 0.01e6);
  const Report r = report_of(steel_grid(3, 3, 5));
  ASSERT_TRUE(r.time_step);
  EXPECT_NEAR(r.time_step->seconds, 0.9 * 5 / speed, 1e-18);
  EXPECT_EQ(r.time_step->shell, ShellIndex(std::size_t{0}));
  TimeStepControl control;
  control.scale = 0.67;
  EXPECT_NEAR(report_of(steel_grid(3, 3, 5), control).time_step->seconds, 0.67 * 5 / speed, 1e-18);
  EXPECT_FALSE(r.added_mass);
}

TEST(Report, characteristic_lengths) {
  const std::vector<Vec3> rectangle = {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}};
  EXPECT_DOUBLE_EQ(characteristic_length(rectangle, 0), 3);
  EXPECT_DOUBLE_EQ(characteristic_length(rectangle, 1), 12.0 / 5);
  EXPECT_DOUBLE_EQ(characteristic_length(rectangle, 2), 3);
  const std::vector<Vec3> rhombus = {{0, 0, 0}, {5, 0, 0}, {8, 4, 0}, {3, 4, 0}};  // area 20, sides 5, diagonals sqrt 80, sqrt 20
  EXPECT_DOUBLE_EQ(characteristic_length(rhombus, 0), 4);
  EXPECT_DOUBLE_EQ(characteristic_length(rhombus, 1), 20 / std::sqrt(80.0));
  EXPECT_DOUBLE_EQ(characteristic_length(rhombus, 2), 5);
  const std::vector<Vec3> triangle = {{0, 0, 0}, {4, 0, 0}, {0, 3, 0}};
  EXPECT_DOUBLE_EQ(characteristic_length(triangle, 0), 12.0 / 5);
  EXPECT_DOUBLE_EQ(characteristic_length(triangle, 1), 12.0 / 5);
  EXPECT_DOUBLE_EQ(characteristic_length(triangle, 2), 3);
  EXPECT_EQ(characteristic_length(std::vector<Vec3>{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, 0), 0);
}

TEST(Report, the_third_option_goes_by_the_waves_in_a_bar) {
  Model model = steel_grid(3, 3, 5);
  TimeStepControl control;
  control.shell_option = 2;
  EXPECT_NEAR(report_of(model, control).time_step->seconds, 0.9 * 5 / std::sqrt(210000.0 / 7.85e-9), 1e-18);
  EXPECT_NEAR(*shell_time_step(steel(), std::vector<Vec3>{{0, 0, 0}, {4, 0, 0}, {0, 3, 0}}, 2), 3 / std::sqrt(210000.0 / 7.85e-9), 1e-18);
  // such a wave doesn't ask for Poisson's ratio
  Part part = steel();
  part.poissons_ratio.reset();
  set_parts(model, {part});
  EXPECT_TRUE(report_of(model, control).time_step);
  EXPECT_FALSE(report_of(model).time_step);
}

TEST(Report, shells_without_area_have_no_time_step) {
  // beside a good quad a triangle that is flat but for rounding
  Model model = test::make_shells({{0, 0, 0}, {5, 0, 0}, {5, 5, 0}, {0, 5, 0}, {10, 1e-11, 0}}, {{0, 1, 2, 3}, {0, 4, 1, 1}});
  set_parts(model, {steel()});
  const Report r = report_of(model);
  EXPECT_EQ(r.defects, (std::array<std::size_t, kDefectCount>{0, 0, 1}));
  EXPECT_EQ(r.time_step->shell, ShellIndex(std::size_t{0}));
  EXPECT_NEAR(r.time_step->seconds, 0.9 * 5 / std::sqrt(210000.0 / (7.85e-9 * (1 - 0.09))), 1e-18);
}

TEST(Report, rigid_parts_do_not_limit_the_step) {
  Model model = test::make_shells({{0, 0, 0}, {5, 0, 0}, {5, 5, 0}, {0, 5, 0}, {6, 0, 0}, {6, 5, 0}}, {{1, 4, 5, 2}, {0, 1, 2, 3}});
  Part rigid = steel();
  rigid.id = 2;
  rigid.limits_time_step = false;
  set_parts(model, {steel(), rigid});
  const double narrow = report_of(model).time_step->seconds;
  model.shell_parts.set(0, PartIndex(std::size_t{1}));
  const Report r = report_of(model);
  EXPECT_EQ(r.time_step->shell, ShellIndex(std::size_t{1}));
  EXPECT_NEAR(r.time_step->seconds / narrow, 5, 1e-12);
}

TEST(Report, mass_scaling_says_what_it_adds) {
  const Model model = steel_grid(4, 4, 5);
  const Report plain = report_of(model);
  TimeStepControl control;
  control.mass_scaled = -2 * plain.time_step->seconds / 0.9;  // twice the step: four times the mass
  const Report scaled = report_of(model, control);
  ASSERT_TRUE(scaled.added_mass);
  EXPECT_NEAR(*scaled.added_mass / *plain.mass, 3, 1e-12);
  EXPECT_EQ(scaled.time_step->seconds, plain.time_step->seconds);
  control.mass_scaled = -plain.time_step->seconds / 2;
  EXPECT_EQ(*report_of(model, control).added_mass, 0);
}

TEST(Report, a_positive_step_for_mass_scaling_takes_mass_away_too) {
  // 5 x 5 and 20 x 20, by mass 1 : 16; with the step of 10 the small one has four times its mass, the large one a quarter
  Model model = test::make_shells({{0, 0, 0}, {5, 0, 0}, {5, 5, 0}, {0, 5, 0}, {50, 0, 0}, {70, 0, 0}, {70, 20, 0}, {50, 20, 0}},
                                  {{0, 1, 2, 3}, {4, 5, 6, 7}});
  set_parts(model, {steel()});
  const Report plain = report_of(model);
  const double small = *plain.mass / 17, step_of_ten = 2 * plain.time_step->seconds / 0.9;
  TimeStepControl control;
  control.mass_scaled = step_of_ten;
  EXPECT_NEAR(*report_of(model, control).added_mass / small, 3 - 12, 1e-9);
  control.mass_scaled = -step_of_ten;
  EXPECT_NEAR(*report_of(model, control).added_mass / small, 3, 1e-9);
  Part part = steel();
  part.thickness.reset();
  set_parts(model, {part});
  EXPECT_FALSE(report_of(model, control).added_mass) << "what has no known mass gains none";
}

TEST(Report, triangles_and_worst_shells) {
  const Model model = test::make_shells({{0, 0, 0}, {5, 0, 0}, {5, 5, 0}, {0, 5, 0}, {30, 0, 0}, {30, 5, 0}, {15, 9, 0}},
                                        {{0, 1, 2, 3}, {1, 4, 5, 2}, {2, 5, 6, 6}, {0, 1, 3, 3}});
  const Report r = report_of(model);
  EXPECT_EQ(r.elements, 4u);
  EXPECT_DOUBLE_EQ(r.triangles_percent, 50);
  EXPECT_EQ(r.metrics[int(Metric::aspect)].worst, ShellIndex(std::size_t{1}));
  EXPECT_EQ(r.metrics[int(Metric::aspect)].max, 5);
  EXPECT_EQ(r.metrics[int(Metric::min_angle_tri)].worst, ShellIndex(std::size_t{2}));
  EXPECT_EQ(r.metrics[int(Metric::min_angle_tri)].measured, 2u);
  EXPECT_EQ(r.metrics[int(Metric::warpage)].measured, 2u);
  EXPECT_EQ(r.counts.ok + r.counts.warn + r.counts.fail, 4u);
  // of equal shells the first is the worst
  EXPECT_EQ(r.metrics[int(Metric::warpage)].worst, ShellIndex(std::size_t{0}));
}

TEST(Report, finds_what_is_worst_and_what_weighs_among_many_shells) {
  Model model = steel_grid(100, 90, 5);  // several ranges
  const std::size_t last = model.shell_count() - 1;
  model.positions.set(model.node_count() - 1, Vec3(497, 447, 0));  // the last shell's own corner
  const Report r = report_of(model);
  EXPECT_EQ(r.metrics[int(Metric::min_length)].worst, ShellIndex(last));
  EXPECT_EQ(r.metrics[int(Metric::max_angle_quad)].worst, ShellIndex(last));
  EXPECT_GT(r.metrics[int(Metric::max_angle_quad)].max, 100) << "of all ranges, not of the first";
  EXPECT_LT(r.metrics[int(Metric::min_length)].min, 4.5);
  EXPECT_LT(r.min_composite, report_of(steel_grid(2, 2, 5)).min_composite);
  ASSERT_TRUE(r.time_step);
  EXPECT_EQ(r.time_step->shell, ShellIndex(last));
  Part unknown;
  unknown.id = 7;
  set_parts(model, {steel(), unknown});
  for (std::size_t s = 100; s < model.shell_count(); ++s) model.shell_parts.set(s, PartIndex(std::size_t{1}));
  const Report first_row = report_of(model);
  ASSERT_TRUE(first_row.mass) << "only the first shells have one";
  EXPECT_NEAR(*first_row.mass, 100 * 25 * 1.5 * 7.85e-9, 1e-15);
}

TEST(Report, counts_averages_and_bounds_each_metric_over_many_shells) {
  // several ranges; a column of shells 4.6 times and one 6 times as long as wide
  const auto along = [](int i) { return 5.0 * i + (i > 10 ? 18 : 0) + (i > 20 ? 25 : 0); };
  const Model model = test::make_grid(100, 90, [&](int i, int j) { return Vec3(along(i), 5.0 * j, 0); });
  const Report r = report_of(model);
  const MetricSummary& aspect = r.metrics[int(Metric::aspect)];
  EXPECT_EQ(aspect.measured, 9000u);
  EXPECT_EQ(aspect.warn, 90u) << "what fails isn't counted among the warnings";
  EXPECT_EQ(aspect.fail, 90u);
  EXPECT_NEAR(aspect.min, 1, 1e-6);
  EXPECT_NEAR(aspect.max, 6, 1e-6);
  EXPECT_NEAR(aspect.mean, (98 + 4.6 + 6) / 100, 1e-6);
  EXPECT_EQ(aspect.worst, ShellIndex(std::size_t{20})) << "of equals the first";
  EXPECT_EQ(r.metrics[int(Metric::max_length)].fail, 180u);
  EXPECT_EQ(r.metrics[int(Metric::max_length)].warn, 0u);
  EXPECT_EQ(r.counts, (Counts{8820, 0, 180}));
  const ShellSet good{ShellIndex(std::size_t{0})}, bad{ShellIndex(std::size_t{20})}, longer{ShellIndex(std::size_t{10})};
  EXPECT_EQ(r.min_composite, report_of(model, {}, &bad).min_composite);
  EXPECT_NEAR(r.mean_composite,
              0.98 * report_of(model, {}, &good).mean_composite + 0.01 * report_of(model, {}, &bad).mean_composite +
                  0.01 * report_of(model, {}, &longer).mean_composite,
              1e-6);
}

TEST(Report, of_some_shells_only) {
  const Model model = steel_grid(10, 10, 5);
  const ShellSet shells = {ShellIndex(std::size_t{3}), ShellIndex(std::size_t{50})};
  const Report r = report_of(model, {}, &shells);
  EXPECT_EQ(r.elements, 2u);
  EXPECT_NEAR(*r.mass, 2 * 25 * 1.5 * 7.85e-9, 1e-18);
  EXPECT_EQ(r.metrics[int(Metric::aspect)].worst, ShellIndex(std::size_t{3}));
}

TEST(Report, by_part_adds_up_to_the_whole) {
  Model model = steel_grid(20, 10, 5);
  Part unknown;
  unknown.id = 7;
  set_parts(model, {steel(), Part(), unknown});
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    if (s % 3 == 0) model.shell_parts.set(s, PartIndex(std::size_t{2}));
  model.positions.set(100, model.positions[100] + Vec3(3, 3, 3));
  const std::vector<PartReport> parts = report_by_part(model, {default_criteria(), 5.0}, {});
  ASSERT_EQ(parts.size(), 2u);  // nothing is of the middle one
  EXPECT_EQ(parts[0].part, PartIndex(std::size_t{0}));
  EXPECT_EQ(parts[1].part, PartIndex(std::size_t{2}));
  const Report whole = report_of(model);
  EXPECT_EQ(parts[0].report.elements + parts[1].report.elements, 200u);
  EXPECT_EQ(parts[0].report.counts.fail + parts[1].report.counts.fail, whole.counts.fail);
  EXPECT_GT(whole.counts.fail, 0u);
  EXPECT_EQ(std::min(parts[0].report.min_composite, parts[1].report.min_composite), whole.min_composite);
  // one without material and thickness has neither
  EXPECT_EQ(parts[0].report.mass, whole.mass);
  EXPECT_FALSE(parts[1].report.mass);
  EXPECT_FALSE(parts[1].report.time_step);
  const ShellSet first = {ShellIndex(std::size_t{0})};
  EXPECT_EQ(report_by_part(model, {default_criteria(), 5.0}, {}, &first).size(), 1u);
}

TEST(Report, judging_again_what_changed_equals_judging_everything) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> away(-3, 3);
  Model model = steel_grid(120, 90, 5);  // several chunks
  ChunkedArray<ShellState> states = judge_model(model, {default_criteria(), 5.0});
  Counts counts = count(states);
  EXPECT_EQ(counts.ok, model.shell_count());
  for (int round = 0; round < 5; ++round) {
    NodeSet moved;
    for (std::size_t n = static_cast<std::size_t>(round); n < model.node_count(); n += 97) {
      model.positions.set(n, model.positions[n] + Vec3(away(random), away(random), away(random)));
      moved.emplace_back(n);
    }
    rejudge(model, {default_criteria(), 5.0}, shells_touching(model, moved), states, counts);
    const ChunkedArray<ShellState> fresh = judge_model(model, {default_criteria(), 5.0});
    for (std::size_t s = 0; s < model.shell_count(); ++s) ASSERT_EQ(states[s], fresh[s]) << s;
    EXPECT_EQ(counts, count(fresh));
    EXPECT_EQ(counts, report_of(model).counts);
    EXPECT_GT(counts.fail, 0u);
  }
}

TEST(Report, judging_again_keeps_what_is_shared) {
  const Model model = steel_grid(120, 90, 5);
  const ChunkedArray<ShellState> states = judge_model(model, {default_criteria(), 5.0});
  ChunkedArray<ShellState> again = states;
  Counts counts = count(states);
  rejudge(model, {default_criteria(), 5.0}, {ShellIndex(std::size_t{5000})}, again, counts);
  for (std::size_t c = 0; c < states.chunk_count(); ++c) EXPECT_TRUE(again.shares_chunk(states, c));
}

TEST(Report, target_size_is_the_median_edge_in_two_digits) {
  EXPECT_DOUBLE_EQ(guess_target_size(steel_grid(9, 9, 5.234)), 5.2);
  EXPECT_DOUBLE_EQ(guess_target_size(steel_grid(9, 9, 0.00098765)), 0.00099);
  EXPECT_DOUBLE_EQ(guess_target_size(steel_grid(9, 9, 129)), 130);
  Model broken = steel_grid(9, 9, 5);
  for (std::size_t n = 0; n < 70; ++n) broken.positions.set(n, Vec3::Constant(std::nan("")));
  EXPECT_DOUBLE_EQ(guess_target_size(broken), 5) << "of the edges that have a length";
  EXPECT_DOUBLE_EQ(guess_target_size(test::make_shells({}, {})), 1);
  EXPECT_DOUBLE_EQ(guess_target_size(test::make_shells({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2, 2}})), 1);
}

}  // namespace
}  // namespace prismesh::mesh::quality
