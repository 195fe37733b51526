#include "mesh/document/field.h"
#include "mesh/document/distance_fields.h"
#include "mesh/document/field_wish.h"
#include "mesh/document/make_field.h"
#include "mesh/document/quality_fields.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "mesh/model/topology_change.h"
#include "mesh/quality/measure.h"
#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {
namespace {

constexpr LengthUnit mm = LengthUnit::mm;

Model flat_sheet(int columns, int rows, double z) {
  return test::make_grid(columns, rows, [z](int i, int j) { return Vec3(5.0 * i, 5.0 * j, z); });
}

TEST(FieldTest, displacement_is_each_nodes_own_way) {
  const Model before = flat_sheet(20, 10, 0);
  Model now = before;
  for (std::size_t n = 0; n < now.node_count(); n += 3) now.positions.set(n, Vec3(before.positions[n] + Vec3(0, 3, 4)));
  const auto field = displacement_field(before, now, mm);
  ASSERT_TRUE(field) << field.error().text();
  EXPECT_TRUE(field->on_nodes);
  EXPECT_EQ(field->unit, "mm");
  ASSERT_EQ(field->values.size(), now.node_count());
  for (std::size_t n = 0; n < now.node_count(); ++n) EXPECT_EQ(field->values[n], n % 3 == 0 ? 5.0F : 0.0F);
  EXPECT_EQ(field->figures.measured, now.node_count());
  EXPECT_EQ(field->figures.max, 5);
  EXPECT_EQ(field->figures.max_at, 0u);
  EXPECT_EQ(field->figures.min, 0);
  EXPECT_EQ(field->figures.min_at, 1u);
  EXPECT_NEAR(field->figures.mean, 5.0 * 77 / 231, 1e-12);
  EXPECT_EQ(field->limits, (FieldLimits{1, 5}));
}

TEST(FieldTest, limits_are_the_same_lengths_in_another_unit) {
  const Model before = flat_sheet(2, 2, 0);
  const auto field = displacement_field(before, before, LengthUnit::m);
  ASSERT_TRUE(field);
  EXPECT_DOUBLE_EQ(field->limits.clear, 0.001);
  EXPECT_DOUBLE_EQ(field->limits.full, 0.005);
}

TEST(FieldTest, a_copy_moved_along_itself_is_displaced_but_on_the_surface) {
  const Model before = flat_sheet(40, 40, 0);
  Model now = before;
  for (std::size_t n = 0; n < now.node_count(); ++n)
    if (const Vec3 at = before.positions[n]; at.x() > 1 && at.x() < 199 && at.y() > 1 && at.y() < 199)
      now.positions.set(n, Vec3(at + Vec3(1.5, 0.5, 0)));
  const auto moved = displacement_field(before, now, mm);
  const auto off = surface_distance_field(before, now, mm);
  ASSERT_TRUE(moved && off);
  EXPECT_NEAR(moved->figures.max, std::hypot(1.5, 0.5), 1e-12);
  EXPECT_NEAR(off->figures.max, 0, 1e-12);
  EXPECT_EQ(off->limits, (FieldLimits{0.05, 1}));
}

TEST(FieldTest, distance_of_parallel_plates_is_between_them_whatever_the_ids) {
  const Model below = flat_sheet(10, 10, 0);
  std::vector<test::NodeSpec> nodes;
  for (int k = 0; k < 4; ++k) nodes.push_back({9000 + k, Vec3(10 + 7.0 * (k == 1 || k == 2), 10 + 7.0 * (k > 1), 2.5)});
  const Model above = test::make_model(nodes, {{77, 3, {9000, 9001, 9002, 9003}}});
  const auto field = surface_distance_field(below, above, mm);
  ASSERT_TRUE(field) << field.error().text();
  EXPECT_EQ(field->figures.measured, 4u);
  EXPECT_DOUBLE_EQ(field->figures.min, 2.5);
  EXPECT_DOUBLE_EQ(field->figures.max, 2.5);
  const auto moved = displacement_field(below, above, mm);
  ASSERT_FALSE(moved);
  EXPECT_NE(moved.error().message.find("no node in common"), std::string::npos);
}

TEST(FieldTest, looking_only_near_what_moved_gives_what_looking_everywhere_gives) {
  const Model before =
      test::make_grid(30, 30, [](int i, int j) { return Vec3(5.0 * i, 5.0 * j, 3 * std::sin(0.7 * i) * std::cos(0.4 * j)); });
  Model now = before;
  for (std::size_t n = 200; n < 420; ++n) now.positions.set(n, Vec3(before.positions[n] + Vec3(0.3, -0.2, 0.01 * static_cast<double>(n))));
  // Under other ids no node has a counterpart: everything is asked.
  Model renumbered = now;
  std::vector<std::int64_t> ids;
  for (std::size_t n = 0; n < now.node_count(); ++n) {
    renumbered.node_ids.set(n, now.node_ids[n] + 1000000);
    ids.push_back(renumbered.node_ids[n]);
  }
  renumbered.node_index = std::make_shared<const IdIndex>(ids);
  const auto near = surface_distance_field(before, now, mm);
  const auto everywhere = surface_distance_field(before, renumbered, mm);
  ASSERT_TRUE(near && everywhere);
  for (std::size_t n = 0; n < now.node_count(); ++n) EXPECT_NEAR(near->values[n], everywhere->values[n], 1e-6) << n;
  EXPECT_GT(near->figures.max, 1);
}

TEST(FieldTest, added_nodes_are_measured_from_between_their_origins_and_count_in_no_figure) {
  const Model before = flat_sheet(4, 4, 0);
  Model now = before;
  // In the middle of an edge whose one end moves by 4, and one on the middle of that edge's half; both have gone up by 0.5 besides.
  const NodeIndex a = now.shell_nodes[0].node[0], b = now.shell_nodes[0].node[1];
  now.positions.set(b.value, Vec3(before.position(b) + Vec3(0, 0, 4)));
  const NodeIndex middle = add_node(now, 5000, Vec3(0.5 * (now.position(a) + now.position(b)) + Vec3(0, 0, 0.5)), edge_origin(a, b));
  const NodeIndex quarter = add_node(now, 5001, Vec3(0.5 * (now.position(a) + now.position(middle))), edge_origin(a, middle));
  const NodeIndex gone = add_node(now, 5002, now.position(middle), edge_origin(a, b));
  remove_node(now, gone);
  const auto field = displacement_field(before, now, mm);
  ASSERT_TRUE(field);
  EXPECT_FLOAT_EQ(field->values[middle.value], 2.5);
  EXPECT_FLOAT_EQ(field->values[quarter.value], 1.25);
  EXPECT_TRUE(std::isnan(field->values[gone.value]));
  EXPECT_EQ(field->new_nodes, 2u);
  EXPECT_EQ(field->figures.measured, before.node_count()) << "what a comparison of the saved decks would count";
  EXPECT_EQ(field->figures.max, 4);
  // Against a state that has the node it is a node like any other.
  Model after = now;
  after.positions.set(middle.value, Vec3(now.position(middle) + Vec3(3, 0, 0)));
  const auto since = displacement_field(now, after, mm);
  ASSERT_TRUE(since);
  EXPECT_EQ(since->new_nodes, 0u);
  EXPECT_EQ(since->figures.max_at, middle.value);
  EXPECT_EQ(since->figures.measured, before.node_count() + 2);
}

TEST(FieldTest, a_node_that_was_removed_before_has_no_displacement) {
  const Model now = flat_sheet(4, 4, 0);
  Model before = now;
  const NodeIndex gone(std::size_t{12});
  remove_node(before, gone);
  const auto field = displacement_field(before, now, mm);
  ASSERT_TRUE(field);
  EXPECT_TRUE(std::isnan(field->values[gone.value]));
  EXPECT_EQ(field->figures.measured, now.node_count() - 1);
}

TEST(FieldTest, added_and_removed_nodes) {
  const Model before = flat_sheet(4, 4, 0);
  Model now = before;
  const NodeIndex added = add_node(now, 5000, Vec3(2.5, 2.5, 1), centre_origin(now.shell_nodes[0]));
  remove_shell(now, ShellIndex(std::size_t{15}));
  const NodeIndex corner = now.shell_nodes[10].node[2];
  const ShellNodes first = now.shell_nodes[0];
  set_shell_nodes(now, ShellIndex(std::size_t{0}), {{first.node[0], first.node[1], added, added}});
  const auto field = displacement_field(before, now, mm);
  ASSERT_TRUE(field);
  ASSERT_EQ(field->values.size(), now.node_count());
  EXPECT_FLOAT_EQ(field->values[added.value], 1) << "one above the middle of the quad it was made of";
  EXPECT_EQ(field->values[corner.value], 0);
  const auto off = surface_distance_field(before, now, mm);
  ASSERT_TRUE(off);
  EXPECT_FLOAT_EQ(off->values[added.value], 1) << "an added node lies off the old surface";
  const std::size_t lone = now.node_count() - 2;  // the sheet's last corner: its only shell is gone
  EXPECT_TRUE(std::isnan(off->values[lone]));
  const auto warpage = metric_field(now, quality::Metric::warpage, {quality::Criteria{}, 1}, mm);
  ASSERT_TRUE(warpage);
  EXPECT_TRUE(std::isnan(warpage->values[15])) << "a removed shell";
  EXPECT_TRUE(std::isnan(warpage->values[0])) << "a triangle has no warpage";
  EXPECT_EQ(warpage->figures.measured, 14u);
  EXPECT_EQ(shells_without_value(now, *warpage), 1u) << "removed shells aren't missed";
  EXPECT_EQ(shells_without_value(now, *field), 0u);
}

TEST(FieldTest, the_distance_of_two_parts_is_that_of_the_firsts_nodes) {
  const Document document = make_document(make_assembly());
  const auto from = shape_named(document.current(), "part:1");
  const auto to = shape_named(document.current(), "part:2");
  ASSERT_TRUE(from && to);
  const auto field = gap_field(document.current().model, *from, *to, mm);
  ASSERT_TRUE(field) << field.error().text();
  EXPECT_EQ(field->figures.measured, 25u);
  EXPECT_EQ(field->figures.min, 0) << "they share the nodes at x = 20";
  EXPECT_EQ(field->figures.max, 20);
  EXPECT_EQ(field->limits, (FieldLimits{20, 0}));
  EXPECT_FALSE(shape_named(document.current(), "part:99"));
}

TEST(FieldTest, what_is_no_number_counts_for_nothing) {
  Model model = flat_sheet(4, 4, 0);
  Model now = model;
  now.positions.set(6, Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0));
  now.positions.set(7, Vec3(now.positions[7] + Vec3(0, 0, 2)));
  for (const auto& field : {displacement_field(model, now, mm), surface_distance_field(model, now, mm)}) {
    ASSERT_TRUE(field);
    EXPECT_TRUE(std::isnan(field->values[6]));
    EXPECT_EQ(field->figures.measured, 24u);
    EXPECT_TRUE(std::isfinite(field->figures.mean));
    EXPECT_DOUBLE_EQ(field->figures.max, 2);
    EXPECT_EQ(shells_without_value(now, *field), 4u) << "the shells at the node";
  }
  const auto warpage = metric_field(now, quality::Metric::warpage, {quality::Criteria{}, 1}, mm);
  ASSERT_TRUE(warpage);
  EXPECT_TRUE(std::isfinite(warpage->figures.mean));
}

TEST(FieldTest, what_is_no_shell_has_no_metric) {
  Model model = flat_sheet(4, 4, 0);
  model.positions.set(6, model.position(NodeIndex(std::size_t{7})));  // two shells have an edge without length
  for (const quality::Metric metric : {quality::Metric::aspect, quality::Metric::min_length, quality::Metric::jacobian}) {
    const auto field = metric_field(model, metric, {quality::Criteria{}, 1}, mm);
    ASSERT_TRUE(field);
    EXPECT_EQ(field->figures.measured, 14u);
    EXPECT_EQ(shells_without_value(model, *field), 2u);
  }
  EXPECT_LT(metric_field(model, quality::Metric::aspect, {quality::Criteria{}, 1}, mm)->figures.max, 5);
}

TEST(FieldTest, nothing_to_measure_is_a_sentence) {
  const Model sheet = flat_sheet(2, 2, 0);
  const Model empty = test::make_model({}, {});
  EXPECT_FALSE(displacement_field(empty, sheet, mm));
  EXPECT_FALSE(surface_distance_field(empty, sheet, mm));
  EXPECT_FALSE(surface_distance_field(sheet, empty, mm));
  EXPECT_FALSE(gap_field(sheet, {}, {}, mm));
  EXPECT_FALSE(metric_field(sheet, quality::Metric::min_angle_tri, {quality::Criteria{}, 1}, mm)) << "there are no triangles";
  const auto step = time_step_field(sheet, {});
  ASSERT_FALSE(step);
  EXPECT_NE(step.error().message.find("no time step"), std::string::npos);
}

TEST(FieldTest, a_measurement_stops_when_told_and_needs_what_it_compares_with) {
  const Document document = make_document(make_assembly());
  const Generation& now = document.current();
  const auto stop = [](double) { return false; };
  Model lifted = now.model;
  lifted.positions.set(0, Vec3(0, 0, 3));
  const auto off = surface_distance_field(lifted, now.model, mm, stop);
  ASSERT_FALSE(off);
  EXPECT_EQ(off.error().message, "cancelled");
  FieldWish gap;
  gap.of = FieldWish::Of::gap;
  gap.from = "part:1";
  gap.to = "part:2";
  const auto apart = make_field(gap, now, document, nullptr, stop);
  ASSERT_FALSE(apart);
  EXPECT_EQ(apart.error().message, "cancelled");
  ASSERT_TRUE(make_field(gap, now, document, nullptr));
  gap.to = "part:99";
  const auto to_nothing = make_field(gap, now, document, nullptr);
  ASSERT_FALSE(to_nothing);
  EXPECT_NE(to_nothing.error().text().find("99"), std::string::npos);
  for (const char* name : {"displacement", "distance-to-original"}) {
    const auto alone = make_field(*field_wish(name), now, document, nullptr);
    ASSERT_FALSE(alone);
    EXPECT_EQ(alone.error().text(), std::string(name) + ": needs another state to be compared with");
  }
}

TEST(FieldTest, metrics_are_those_of_the_shells) {
  const quality::SizedCriteria criteria{quality::default_criteria(), 5};
  Model model = flat_sheet(3, 3, 0);
  model.positions.set(5, Vec3(model.positions[5] + Vec3(0, 0, 1.5)));
  std::vector<quality::Values> values(model.shell_count());
  quality::measure_range(model, 0, model.shell_count(), values);
  for (const quality::Metric metric : {quality::Metric::warpage, quality::Metric::skew, quality::Metric::min_length}) {
    const auto field = metric_field(model, metric, criteria, mm);
    ASSERT_TRUE(field);
    EXPECT_FALSE(field->on_nodes);
    for (std::size_t s = 0; s < model.shell_count(); ++s) EXPECT_EQ(field->values[s], values[s][static_cast<std::size_t>(metric)]);
    EXPECT_NE(field->limits.clear, field->limits.full);
  }
  const auto warpage = metric_field(model, quality::Metric::warpage, criteria, mm);
  EXPECT_LT(warpage->limits.clear, warpage->limits.full);
  const auto length = metric_field(model, quality::Metric::min_length, criteria, mm);
  EXPECT_GT(length->limits.clear, length->limits.full) << "small ones are the worse ones";
  const auto composite = composite_field(model, criteria);
  ASSERT_TRUE(composite);
  EXPECT_LT(composite->figures.min, composite->figures.max);
}

TEST(FieldTest, names_lead_to_fields_and_back) {
  for (const char* text :
       {"displacement", "distance-to-original", "distance", "metric:warpage", "metric:min_length", "composite", "time-step"}) {
    const auto wish = field_wish(text);
    ASSERT_TRUE(wish) << text;
    EXPECT_EQ(name(*wish), text);
  }
  const auto wrong = field_wish("metric:warpige");
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message.find("metric:warpage"), std::string::npos);
}

}  // namespace
}  // namespace prismesh::mesh::document
