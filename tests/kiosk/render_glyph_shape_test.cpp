// Glyphs of shells whose answer is known: shape and position; clusters, damage and part states.
#include "kiosk/render/glyph_shape.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kiosk/render/glyphs.h"
#include "kiosk/render/part_looks.h"
#include "tests/kiosk/test_source.h"

namespace prismesh::kiosk::render {
namespace {

using mesh::Vec3;
using mesh::quality::Metric;
using mesh::quality::ShellState;
using testing::ElementsAre;
using testing::IsEmpty;
using Corners = std::vector<Vec3>;

const Corners kSquare{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};

ShellState failing(std::initializer_list<Metric> metrics) {
  ShellState state;
  for (const Metric metric : metrics) state.fail = static_cast<std::uint16_t>(state.fail | 1U << static_cast<unsigned>(metric));
  state.warn = state.fail;
  return state;
}

/// The same shell, numbered from another corner.
Corners turned(const Corners& corners, std::size_t by) {
  Corners made;
  for (std::size_t k = 0; k < corners.size(); ++k) made.push_back(corners[(k + by) % corners.size()]);
  return made;
}

TEST(GlyphShape, the_diagonal_that_bends_more_is_thick) {
  // A kite 20 long and 8 wide, folded along its length: one corner 3 up at 4 from the fold, a bend of 36.9 degrees. About the short
  // diagonal, whose middle is 1.5 up, it bends by twice atan(1.5 cos 20.6 / 10), 16.0 degrees.
  const Corners kite{{0, 0, 0}, {10, -4, 0}, {20, 0, 0}, {10, 4, 3}};
  EXPECT_EQ(glyph_place(GlyphShape::warped, kite), 0U);
  EXPECT_EQ(glyph_place(GlyphShape::warped, turned(kite, 1)), 1U) << "the same diagonal with its other index";
  EXPECT_EQ(glyph_place(GlyphShape::warped, turned(kite, 2)), 0U);
  // With its tip 3 up: 16.7 degrees about the short diagonal, twice atan(1.5 cos 8.5 / 4), 40.7 degrees, about the long one.
  const Corners raised_tip{{0, 0, 0}, {10, -4, 0}, {20, 0, 3}, {10, 4, 0}};
  EXPECT_EQ(glyph_place(GlyphShape::warped, raised_tip), 0U);
  EXPECT_EQ(glyph_place(GlyphShape::warped, turned(raised_tip, 3)), 1U);
}

TEST(GlyphShape, edge_glyphs_are_on_the_shortest_and_longest_edge) {
  const Corners quad{{0, 0, 0}, {10, 0, 0}, {10, 4, 0}, {0, 9, 0}};  // edges 10, 4, 11.2, 9
  EXPECT_EQ(glyph_place(GlyphShape::short_edge, quad), 1U);
  EXPECT_EQ(glyph_place(GlyphShape::long_edge, quad), 2U);
  EXPECT_EQ(glyph_place(GlyphShape::stretched, quad), 2U);
  EXPECT_EQ(glyph_place(GlyphShape::short_edge, turned(quad, 1)), 0U);
}

TEST(GlyphShape, a_triangles_smallest_height_starts_opposite_its_longest_edge) {
  const Corners triangle{{0, 0, 0}, {10, 0, 0}, {5, 1, 0}};  // longest: edge 0; opposite: corner 2
  EXPECT_EQ(glyph_place(GlyphShape::short_edge, triangle), 2U);
  EXPECT_EQ(glyph_place(GlyphShape::short_edge, turned(triangle, 1)), 1U);
  EXPECT_EQ(glyph_place(GlyphShape::long_edge, triangle), 0U);
}

TEST(GlyphShape, angle_glyphs_are_at_the_smallest_and_largest_angle) {
  const Corners kite{{0, 0, 0}, {20, -2, 0}, {24, 0, 0}, {20, 2, 0}};  // smallest angle at 0, largest at 1, 2 or 3
  EXPECT_EQ(glyph_place(GlyphShape::small_angle, kite), 0U);
  EXPECT_EQ(glyph_place(GlyphShape::large_angle, {{{0, 0, 0}, {10, 0, 0}, {5, 1, 0}}}), 2U);
  EXPECT_EQ(glyph_place(GlyphShape::small_angle, {{{0, 0, 0}, {10, 0, 0}, {9, 2, 0}}}), 0U);
}

TEST(GlyphShape, a_reflex_corner_has_the_largest_angle) {
  const Corners dart{{0, 0, 0}, {10, 0, 0}, {2, 2, 0}, {0, 10, 0}};
  EXPECT_EQ(glyph_place(GlyphShape::large_angle, dart), 2U) << "more than 180 degrees";
  for (const std::size_t by : {1U, 2U, 3U}) EXPECT_EQ(glyph_place(GlyphShape::large_angle, turned(dart, by)), (6 - by) % 4);
}

TEST(GlyphShape, coordinates_that_are_not_finite_choose_position_zero) {
  Corners quad = kSquare;
  quad[2].x() = std::numeric_limits<double>::quiet_NaN();
  for (int shape = 0; shape < kGlyphShapeCount; ++shape) EXPECT_EQ(glyph_place(static_cast<GlyphShape>(shape), quad), 0U);
}

TEST(GlyphShape, each_metric_has_its_shape_and_other_gives_way) {
  EXPECT_THAT(shapes_of({}), IsEmpty());
  EXPECT_THAT(shapes_of(failing({Metric::warpage, Metric::aspect})), ElementsAre(GlyphShape::warped, GlyphShape::stretched));
  EXPECT_THAT(shapes_of(failing({Metric::min_length})), ElementsAre(GlyphShape::short_edge));
  EXPECT_THAT(shapes_of(failing({Metric::max_length})), ElementsAre(GlyphShape::long_edge));
  EXPECT_THAT(shapes_of(failing({Metric::min_angle_tri, Metric::max_angle_tri})),
              ElementsAre(GlyphShape::small_angle, GlyphShape::large_angle));
  EXPECT_THAT(shapes_of(failing({Metric::taper})), ElementsAre(GlyphShape::other));
  EXPECT_THAT(shapes_of(failing({Metric::taper, Metric::warpage})), ElementsAre(GlyphShape::warped));
  ShellState both = failing({Metric::skew});
  both.warn = static_cast<std::uint16_t>(both.warn | 1U << static_cast<unsigned>(Metric::warpage));
  EXPECT_THAT(shapes_of(both), ElementsAre(GlyphShape::other)) << "failures hide warnings";
  ShellState defect = failing({Metric::aspect});
  defect.fail = static_cast<std::uint16_t>(defect.fail | 1U << static_cast<unsigned>(mesh::quality::Defect::no_area));
  EXPECT_THAT(shapes_of(defect), ElementsAre(GlyphShape::defect)) << "a defect hides all other shapes";
  EXPECT_THAT(shapes_of(ShellState::removed()), IsEmpty());
}

/// A fan of triangles about a node in a grid of quads.
std::shared_ptr<test::TestSource> fan(int triangles) {
  auto source = std::make_shared<test::TestSource>();
  test::add_grid(*source, 2, 2, 0, [](double u, double v) { return Vec3(u * 20, v * 20 - 20, 0); });
  const std::uint32_t centre = 7;  // in the middle of the grid's upper side
  std::vector<std::uint32_t> rim;
  for (int i = 0; i <= triangles; ++i) {
    const double angle = 3.14159 * i / triangles;
    rim.push_back(source->add_node(source->positions[centre] + Vec3(10 * std::cos(angle), 10 * std::sin(angle), 0)));
  }
  for (int i = 0; i < triangles; ++i) source->add_shell(centre, rim[i], rim[i + 1], rim[i + 1], 0);
  return source;
}

TEST(Clusters, too_many_triangles_at_a_node_of_a_quad_get_a_glyph_there) {
  struct Case {
    int triangles;
    double max_triangles;
    std::size_t marks;
  };
  for (const auto& [triangles, max_triangles, marks] :
       {Case{4, 4, 0}, {5, 4, 1}, {7, 4, 1}, {4, 3, 1}, {3, 3, 0}, {7, 7, 0}, {5, 2.5, 1}}) {
    const auto source = fan(triangles);
    source->max_triangles = max_triangles;
    const ModelTable table(source);
    GlyphList list;
    list.update(table, true, true, false);
    const auto chosen = list.choose(table, 100, {});
    ASSERT_EQ(chosen.glyphs.size(), marks) << triangles << " of " << max_triangles;
    if (marks == 0) continue;
    EXPECT_EQ(chosen.glyphs[0].kind & 15U, static_cast<std::uint32_t>(GlyphShape::cluster));
    const std::uint32_t corner = chosen.glyphs[0].kind >> kGlyphPlaceShift & 3U;
    EXPECT_EQ(source->shell_nodes[chosen.glyphs[0].shell].node[corner].value, 7U) << "at the node itself";
  }
}

TEST(Clusters, a_mesh_of_triangles_has_no_clusters) {
  auto source = fan(6);
  source->shell_nodes.erase(source->shell_nodes.begin(), source->shell_nodes.begin() + 4);
  source->shell_quality.resize(source->shell_nodes.size());
  const ModelTable table(source);
  GlyphList list;
  list.update(table, true, true, false);
  EXPECT_THAT(list.choose(table, 100, {}).glyphs, IsEmpty());
}

TEST(Damage, with_damaged_only_what_edits_made_worse_gets_glyphs) {
  auto source = std::make_shared<test::TestSource>(test::two_plates());
  source->shell_damage.resize(source->shell_nodes.size());
  source->shell_quality[3] = failing({Metric::warpage});
  source->shell_quality[5] = failing({Metric::warpage, Metric::aspect});
  source->shell_damage[5] = failing({Metric::aspect});
  const ModelTable table(source);
  GlyphList list;
  list.update(table, false, false, false);
  EXPECT_EQ(list.choose(table, 100, {}).glyphs.size(), 3U);
  list.update(table, false, false, true);
  const auto chosen = list.choose(table, 100, {});
  ASSERT_EQ(chosen.glyphs.size(), 1U);
  EXPECT_EQ(chosen.glyphs[0].shell, 5U);
  EXPECT_EQ(chosen.glyphs[0].kind & 15U, static_cast<std::uint32_t>(GlyphShape::stretched)) << "the warpage was there before";
}

TEST(PartStates, a_part_is_redder_if_more_shells_fail) {
  auto source = std::make_shared<test::TestSource>(test::two_plates());
  for (std::size_t s = 0; s < 3; ++s) source->shell_quality[s] = failing({Metric::aspect});
  source->shell_quality[150].warn = 1;
  const std::vector<PartState> parts = part_states(ModelTable(source), false);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].shells, 100U);
  EXPECT_EQ(parts[0].fail, 3U);
  EXPECT_EQ(parts[1].warn, 1U);
  source->shell_damage.resize(source->shell_nodes.size());
  source->shell_quality[4] = ShellState::removed();
  EXPECT_EQ(part_states(ModelTable(source), false)[0].shells, 99U);
  EXPECT_EQ(part_states(ModelTable(source), true)[0].shells, 99U) << "removed shells don't count";
  EXPECT_EQ(colour_of_state({100, 0, 0}), grade_colours()[0]);
  EXPECT_EQ(colour_of_state({100, 0, 10}), grade_colours()[2]);
  EXPECT_EQ(colour_of_state({100, 50, 0}), grade_colours()[1]);
  EXPECT_GT(colour_of_state({100, 0, 1}).z(), colour_of_state({100, 0, 5}).z()) << "paler";
}

}  // namespace
}  // namespace prismesh::kiosk::render
