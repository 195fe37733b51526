// Glyphs of shells whose answer is known: shape and position; clusters, damage and part states.
#include "kiosk/render/glyph_shape.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kiosk/render/glyphs.h"
#include "kiosk/render/part_looks.h"
#include "kiosk/render/preview_patch.h"
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

/// Two plates, the first shell of each a triangle; at its corner k is a cluster of which edits made only the second plate's.
std::shared_ptr<test::TestSource> plates_with_clusters(std::uint8_t k) {
  auto source = std::make_shared<test::TestSource>(test::two_plates());
  for (const std::size_t shell : {0U, 100U}) {
    source->shell_nodes[shell].node[3] = source->shell_nodes[shell].node[2];
    source->clusters.push_back({mesh::ShellIndex(shell), 5, k, static_cast<std::uint8_t>(shell > 0)});
  }
  source->shell_damage.resize(source->shell_nodes.size());
  return source;
}

TEST(Clusters, get_a_glyph_at_their_node) {
  for (const std::uint8_t k : {std::uint8_t{0}, std::uint8_t{1}, std::uint8_t{2}}) {
    const ModelTable table(plates_with_clusters(k));
    GlyphList list;
    list.update(table, true, true, false);
    const auto chosen = list.choose(table, 100, {});
    ASSERT_EQ(chosen.glyphs.size(), 2U);
    EXPECT_EQ(chosen.glyphs[1].shell, 100U);
    EXPECT_EQ(chosen.glyphs[1].kind, static_cast<std::uint32_t>(GlyphShape::cluster) | std::uint32_t{k} << kGlyphPlaceShift);
    EXPECT_EQ(list.choose(table, 100, {100U}).glyphs.size(), 1U) << "a preview shows the other";
  }
}

TEST(Clusters, of_hidden_parts_and_those_that_were_there_before_have_no_glyph_where_none_is_wanted) {
  const auto source = plates_with_clusters(1);
  source->hidden[0] = true;
  GlyphList list;
  list.update(ModelTable(source), true, false, false);
  EXPECT_EQ(list.choose(ModelTable(source), 100, {}).glyphs.size(), 1U);
  source->hidden[0] = false;
  source->hidden[1] = true;
  list.update(ModelTable(source), true, false, true);
  EXPECT_THAT(list.choose(ModelTable(source), 100, {}).glyphs, IsEmpty()) << "edits made that of the hidden plate only";
  source->hidden[1] = false;
  list.update(ModelTable(source), true, false, true);
  const auto chosen = list.choose(ModelTable(source), 100, {});
  ASSERT_EQ(chosen.glyphs.size(), 1U);
  EXPECT_EQ(chosen.glyphs[0].shell, 100U);
}

TEST(Clusters, that_name_no_shell_or_no_corner_are_left_out) {
  const auto source = plates_with_clusters(0);
  source->clusters.push_back({mesh::ShellIndex(9999), 5, 0, 0});
  source->clusters.push_back({mesh::ShellIndex(0), 5, 3, 0});
  EXPECT_EQ(ModelTable(source).clusters().size(), 2U);
}

TEST(Clusters, are_shown_while_their_nodes_are_dragged) {
  const auto source = plates_with_clusters(2);
  const ModelTable table(source);
  const std::vector<mesh::NodeIndex> nodes = {source->shell_nodes[100].node[2]};
  const std::vector<mesh::ShellIndex> shells = {mesh::ShellIndex(100), mesh::ShellIndex(101)};
  PreviewPatch patch(table, Vec3::Zero(), nodes, shells);
  ipc::PreviewFrame frame;
  frame.positions = {Vec3(1, 2, 3)};
  frame.states.resize(2);
  ASSERT_TRUE(patch.update(frame));
  for (const bool damaged : {false, true}) {
    const std::vector<Glyph> glyphs = patch.glyphs(damaged);
    ASSERT_EQ(glyphs.size(), 1U);
    EXPECT_EQ(glyphs[0].kind, static_cast<std::uint32_t>(GlyphShape::cluster) | 2U << kGlyphPlaceShift);
    const std::uint32_t at = patch.corners()[glyphs[0].shell][2];
    EXPECT_EQ(patch.positions()[at], (std::array<float, 4>{1, 2, 3, 1})) << "it follows the node";
  }
  source->clusters[1].worse = 0;
  PreviewPatch before(ModelTable(source), Vec3::Zero(), nodes, shells);
  ASSERT_TRUE(before.update(frame));
  EXPECT_EQ(before.glyphs(false).size(), 1U);
  EXPECT_THAT(before.glyphs(true), IsEmpty());
}

TEST(Clusters, of_an_operation_that_is_only_shown_have_glyphs) {
  MeshChange change;
  change.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  change.corners = {{0, 1, 2, 2}};
  change.states.resize(1);
  change.clusters = {2};
  const std::vector<Glyph> glyphs = PreviewPatch(Vec3::Zero(), change).glyphs();
  ASSERT_EQ(glyphs.size(), 1U);
  EXPECT_EQ(glyphs[0].kind, static_cast<std::uint32_t>(GlyphShape::cluster) | 1U << kGlyphPlaceShift);
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
