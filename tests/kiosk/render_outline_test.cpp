// Free edges, junctions and creases of visible shells; updates give the same lines as a new outline. Choice of glyphs; preview patches.
#include <algorithm>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kiosk/render/glyphs.h"
#include "kiosk/render/outline.h"
#include "kiosk/render/preview_patch.h"
#include "tests/kiosk/test_source.h"

namespace prismesh::kiosk::render {
namespace {

using test::TestSource;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using testing::UnorderedElementsAre;

/// Sheets around the edge from node 0 to node 1, each at its angle in degrees; `flipped` turns its normal.
TestSource fan(std::initializer_list<double> angles, bool flip_second = false) {
  TestSource source;
  source.add_node({0, 0, 0});
  source.add_node({1, 0, 0});
  std::uint32_t part = 0;
  for (const double degrees : angles) {
    const double a = degrees * std::numbers::pi / 180;
    const std::uint32_t c = source.add_node({1, std::cos(a), std::sin(a)}), d = source.add_node({0, std::cos(a), std::sin(a)});
    if (flip_second && part == 1)
      source.add_shell(1, 0, d, c, part++);
    else
      source.add_shell(0, 1, c, d, part++);
  }
  return source;
}

Outline outline_of(const TestSource& source) {
  Outline outline;
  outline.update(ModelTable(std::make_shared<TestSource>(source)), true, true, {});
  return outline;
}

TEST(Outline, a_flat_sheet_has_no_crease) {
  EXPECT_THAT(outline_of(fan({0, 180})).creases(), IsEmpty());
  EXPECT_THAT(outline_of(fan({0, 180})).borders(), SizeIs(6));
}

TEST(Outline, a_bend_is_a_crease_for_either_sense_of_the_normals) {
  for (const bool flipped : {false, true}) {
    EXPECT_THAT(outline_of(fan({0, 149}, flipped)).creases(), ElementsAre(NodePair{0, 1})) << flipped;
    EXPECT_THAT(outline_of(fan({0, 151}, flipped)).creases(), IsEmpty()) << flipped;
    EXPECT_THAT(outline_of(fan({0, 180}, flipped)).creases(), IsEmpty()) << flipped;
  }
}

TEST(Outline, the_rim_goes_round_the_shells_that_are_in) {
  const TestSource source = fan({0, 120, 240});
  const Outline outline = outline_of(source);
  const std::vector<std::uint8_t> corners(8, 1);
  const auto rim_of = [&](const std::vector<std::uint32_t>& in) {
    return outline.rim(corners, [&](std::uint32_t shell) { return std::ranges::find(in, shell) != in.end(); });
  };
  EXPECT_THAT(rim_of({}), IsEmpty());
  EXPECT_THAT(rim_of({1}), UnorderedElementsAre(NodePair{0, 1}, NodePair{1, 4}, NodePair{4, 5}, NodePair{0, 5}));
  EXPECT_THAT(rim_of({0, 1}),
              UnorderedElementsAre(NodePair{1, 2}, NodePair{2, 3}, NodePair{0, 3}, NodePair{1, 4}, NodePair{4, 5}, NodePair{0, 5}))
      << "the edge between two of them is inside";
  EXPECT_THAT(rim_of({0, 1, 2}), testing::Contains(NodePair{0, 1})) << "three sheets end there";
}

TEST(Outline, an_edge_of_three_sheets_is_a_border) {
  const Outline outline = outline_of(fan({0, 120, 240}));
  EXPECT_THAT(outline.borders(), testing::Contains(NodePair{0, 1}));
  EXPECT_THAT(outline.creases(), IsEmpty());
}

TEST(Outline, hidden_shells_do_not_count) {
  TestSource source = fan({0, 90});
  EXPECT_THAT(outline_of(source).borders(), testing::Not(testing::Contains(NodePair{0, 1})));
  source.hidden[1] = true;
  EXPECT_THAT(outline_of(source).borders(), SizeIs(4));
  EXPECT_THAT(outline_of(source).borders(), testing::Contains(NodePair{0, 1})) << "the neighbour is hidden, so this is a free edge";
}

TEST(Outline, triangles_and_degenerate_shells_have_their_own_sides) {
  TestSource source;
  for (const mesh::Vec3& at : {mesh::Vec3(0, 0, 0), mesh::Vec3(1, 0, 0), mesh::Vec3(0, 1, 0)}) source.add_node(at);
  source.add_shell(0, 1, 2, 2, 0);
  EXPECT_THAT(outline_of(source).borders(), UnorderedElementsAre(NodePair{0, 1}, NodePair{1, 2}, NodePair{0, 2}));
  source.add_shell(0, 0, 0, 0, 0);
  source.add_shell(0, 1, 2, 77, 0);  // no such node
  EXPECT_THAT(outline_of(source).borders(), SizeIs(3));
}

TEST(Outline, an_update_after_a_move_equals_a_new_outline) {
  auto source = std::make_shared<TestSource>();
  test::add_grid(*source, 120, 120, 0, [](double u, double v) { return mesh::Vec3(u, v, 0); });
  Outline outline;
  outline.update(ModelTable(source), true, true, {});
  ASSERT_THAT(outline.creases(), IsEmpty());
  const std::size_t node = 121 * 60 + 60;
  source->positions[node].z() = 0.3;
  const auto chunk = static_cast<std::uint32_t>(node / mesh::kChunkSize);
  outline.update(ModelTable(source), false, false, std::array{chunk});
  EXPECT_THAT(outline.creases(), testing::Not(IsEmpty()));
  EXPECT_EQ(outline.creases(), outline_of(*source).creases());
  EXPECT_EQ(outline.borders(), outline_of(*source).borders());
}

mesh::quality::ShellState state(std::initializer_list<mesh::quality::Metric> warn, std::initializer_list<mesh::quality::Metric> fail) {
  mesh::quality::ShellState made;
  for (const auto metric : warn) made.warn = static_cast<std::uint16_t>(made.warn | 1U << static_cast<unsigned>(metric));
  for (const auto metric : fail) made.fail = static_cast<std::uint16_t>(made.fail | 1U << static_cast<unsigned>(metric));
  return made;
}

TEST(Glyphs, failures_come_first_and_the_rest_is_counted) {
  auto source = std::make_shared<TestSource>();
  test::add_grid(*source, 100, 100, 0, [](double u, double v) { return mesh::Vec3(u, v, 0); });
  for (std::size_t s = 0; s < 1000; ++s) source->shell_quality[s] = state({mesh::quality::Metric::aspect}, {});
  for (std::size_t s = 5000; s < 5030; ++s) source->shell_quality[s] = state({mesh::quality::Metric::skew}, {mesh::quality::Metric::skew});
  const ModelTable table(source);
  GlyphList list;
  list.update(table, false, false, false);
  const auto failing = [](const std::vector<Glyph>& glyphs) {
    return std::count_if(glyphs.begin(), glyphs.end(), [](const Glyph& glyph) { return (glyph.kind & kFailingGlyph) != 0; });
  };
  const auto all = list.choose(table, 5000, {});
  EXPECT_EQ(all.glyphs.size(), 1030U);
  EXPECT_EQ(all.left_out, 0U);
  EXPECT_NE(all.glyphs.back().kind & kFailingGlyph, 0U) << "failures are drawn over warnings";
  const auto some = list.choose(table, 100, {});
  EXPECT_EQ(some.glyphs.size(), 100U);
  EXPECT_EQ(failing(some.glyphs), 30);
  EXPECT_EQ(some.left_out, 930U);
  const auto few = list.choose(table, 10, {});
  EXPECT_EQ(failing(few.glyphs), 10);
  EXPECT_EQ(few.left_out, 1020U);
  EXPECT_EQ(list.choose(table, 5000, {5000, 5001, 3}).glyphs.size(), 1027U);
}

TEST(PreviewPatch, takes_only_frames_of_its_drag) {
  auto source = std::make_shared<TestSource>();
  test::add_grid(*source, 4, 4, 0, [](double u, double v) { return mesh::Vec3(u, v, 0); });
  const std::vector<mesh::NodeIndex> nodes{mesh::NodeIndex(12), mesh::NodeIndex(999)};
  const std::vector<mesh::ShellIndex> shells{mesh::ShellIndex(5), mesh::ShellIndex(6), mesh::ShellIndex(4000)};
  PreviewPatch patch(ModelTable(source), mesh::Vec3::Zero(), nodes, shells);
  EXPECT_THAT(patch.positions(), SizeIs(6)) << "two neighbouring quads";
  EXPECT_THAT(patch.edges(), SizeIs(7));
  EXPECT_THAT(patch.glyphs(), IsEmpty());
  ipc::PreviewFrame frame;
  frame.positions = {{9, 9, 9}};
  EXPECT_FALSE(patch.update(frame));
  frame.positions = {{9, 9, 9}, {1, 1, 1}};
  frame.states = {state({}, {}), state({mesh::quality::Metric::aspect}, {mesh::quality::Metric::aspect}), state({}, {})};
  ASSERT_TRUE(patch.update(frame));
  EXPECT_THAT(patch.positions(), testing::Contains(std::array<float, 4>{9, 9, 9, 1}));
  ASSERT_THAT(patch.glyphs(), SizeIs(1));
  const std::uint32_t stretched = static_cast<std::uint32_t>(GlyphShape::stretched);
  EXPECT_EQ(patch.glyphs()[0].kind & 31U, stretched + kFailingGlyph);
  EXPECT_EQ(patch.glyphs()[0].shell, 1U) << "by its index in the patch";
  EXPECT_EQ(patch.corners().size(), 2U);
}

}  // namespace
}  // namespace prismesh::kiosk::render
