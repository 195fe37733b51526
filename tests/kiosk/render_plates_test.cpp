// Shells drawn with their thickness: the shape of their plates, and pictures of them measured by their pixels.
#include "kiosk/render/plate_shape.h"

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/clock.h"
#include "tests/kiosk/render_test.h"

namespace prismesh::kiosk::render {
namespace {

using mesh::Vec3;
using test::TestSource;

constexpr int kPlatesWidth = 320, kPlatesHeight = 240;

ModelTable table_of(const TestSource& source) { return ModelTable(std::make_shared<TestSource>(source)); }

PlateShape shape_of(const TestSource& source) {
  PlateShape shape;
  shape.make(table_of(source), plate_thicknesses(source));
  return shape;
}

bool has_side(const PlateShape& shape, std::size_t shell, std::size_t side) { return (shape.row(shell)[side] & kPlateSide) != 0; }

std::size_t sides_of(const PlateShape& shape) {
  std::size_t sides = 0;
  for (std::size_t s = 0; s < shape.shell_count(); ++s)
    for (std::size_t k = 0; k < 4; ++k) sides += has_side(shape, s, k) ? 1 : 0;
  return sides;
}

/// 6 x 4 quads of 10 in the plane z = 0, 2 thick.
TestSource flat_sheet() {
  TestSource source;
  test::add_grid(source, 6, 4, 0, [](double u, double v) { return Vec3(60 * u, 40 * v, 0); });
  source.thickness = {{2, 2}};
  return source;
}

/// Two sheets of 3 x 3 quads that share an edge along y: one in the plane z = 0, one bent up from it by `degrees`.
TestSource folded(double degrees) {
  TestSource source;
  const double angle = degrees * std::numbers::pi / 180;
  test::add_grid(source, 6, 3, 0, [&](double u, double v) {
    const double along = 60 * u - 30;
    return along <= 1e-9 ? Vec3(along, 30 * v, 0) : Vec3(along * std::cos(angle), 30 * v, along * std::sin(angle));
  });
  source.thickness = {{2, 2}};
  return source;
}

TEST(PlateShape, of_a_flat_sheet_is_straight_up_and_has_sides_at_its_free_edges_only) {
  const PlateShape shape = shape_of(flat_sheet());
  ASSERT_EQ(shape.shell_count(), 24U);
  for (std::size_t s = 0; s < shape.shell_count(); ++s)
    for (const std::uint32_t corner : shape.row(s)) EXPECT_EQ(plate_way(corner), Vec3::UnitZ());
  EXPECT_EQ(sides_of(shape), 2U * (6 + 4));
  for (std::size_t s = 0; s < 6; ++s) EXPECT_TRUE(has_side(shape, s, 0)) << s;
  EXPECT_FALSE(has_side(shape, 0, 1));
  EXPECT_FALSE(has_side(shape, 0, 2));
  EXPECT_TRUE(has_side(shape, 0, 3));
}

TEST(PlateShape, of_a_fold_is_a_mitre_joint_with_outer_faces_half_a_thickness_from_both_sheets) {
  for (const double degrees : {10.0, 45.0, 90.0, -90.0}) {
    const TestSource source = folded(degrees);
    const PlateShape shape = shape_of(source);
    const double angle = degrees * std::numbers::pi / 180;
    // Shell 2 ends at the fold with corners 1 and 2, shell 3 begins there with corners 0 and 3.
    const Vec3 way = plate_way(shape.row(2)[1]);
    EXPECT_NEAR(way.dot(Vec3::UnitZ()), 1, 0.01) << degrees;
    EXPECT_NEAR(way.dot(Vec3(-std::sin(angle), 0, std::cos(angle))), 1, 0.01) << degrees;
    EXPECT_NEAR(way.norm(), 1 / std::cos(angle / 2), 0.01) << degrees;
    EXPECT_EQ(plate_way(shape.row(3)[0]), way) << degrees;
    EXPECT_FALSE(has_side(shape, 2, 1));
    EXPECT_FALSE(has_side(shape, 3, 3));
    EXPECT_EQ(sides_of(shape), 2U * (6 + 3)) << degrees;
  }
}

TEST(PlateShape, at_a_sharper_bend_ends_in_sides) {
  const PlateShape shape = shape_of(folded(130));
  EXPECT_EQ(plate_way(shape.row(2)[1]), Vec3::UnitZ());
  EXPECT_TRUE(has_side(shape, 2, 1));
  EXPECT_TRUE(has_side(shape, 3, 3));
  EXPECT_EQ(sides_of(shape), 2U * (6 + 3) + 2 * 3);
}

TEST(PlateShape, goes_on_over_shells_that_are_turned_over) {
  TestSource source = folded(45);
  std::swap(source.shell_nodes[3].node[1], source.shell_nodes[3].node[3]);
  source.shell_nodes[9] = {
      {source.shell_nodes[9].node[3], source.shell_nodes[9].node[2], source.shell_nodes[9].node[1], source.shell_nodes[9].node[0]}};
  const PlateShape turned = shape_of(source), shape = shape_of(folded(45));
  EXPECT_EQ(sides_of(turned), 2U * (6 + 3));
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(plate_way(turned.row(3)[(4 - k) % 4]), -plate_way(shape.row(3)[k]));
    EXPECT_EQ(plate_way(turned.row(9)[3 - k]), -plate_way(shape.row(9)[k]));
    EXPECT_EQ(plate_way(turned.row(4)[k]), plate_way(shape.row(4)[k]));
  }
}

TEST(PlateShape, ends_at_junctions_and_where_the_thickness_changes_or_a_part_is_hidden) {
  TestSource junction = folded(0);
  const std::uint32_t foot = 3;  // of 4 rows of 7 nodes
  const std::uint32_t top = junction.add_node({0, 0, 20}), next = junction.add_node({0, 10, 20});
  const std::uint32_t rib = junction.add_shell(foot, foot + 7, next, top, 0);
  const PlateShape joined = shape_of(junction);
  EXPECT_TRUE(has_side(joined, 2, 1));
  EXPECT_TRUE(has_side(joined, 3, 3));
  for (std::size_t k = 0; k < 4; ++k) EXPECT_TRUE(has_side(joined, rib, k)) << k;
  EXPECT_FALSE(has_side(joined, 8, 1)) << "the next row of shells has no rib";
  EXPECT_EQ(plate_way(joined.row(rib)[0]), Vec3::UnitX()) << "a rib keeps its own direction";
  EXPECT_EQ(plate_way(joined.row(2)[1]), Vec3::UnitZ());

  TestSource steps = folded(0);
  steps.hidden.resize(2);
  for (const std::size_t shell : {3U, 4U, 5U, 9U, 10U, 11U, 15U, 16U, 17U}) steps.shell_parts[shell] = mesh::PartIndex(1);
  steps.thickness = {{2, 2}, {1, 1}};
  EXPECT_TRUE(has_side(shape_of(steps), 2, 1));
  EXPECT_TRUE(has_side(shape_of(steps), 3, 3));
  steps.thickness = {{2, 2}, {2, 2}};
  EXPECT_FALSE(has_side(shape_of(steps), 2, 1)) << "another part of the same thickness";
  steps.thickness = {{2, 2}, {0, 0}};
  EXPECT_TRUE(has_side(shape_of(steps), 2, 1));
  EXPECT_EQ(shape_of(steps).row(3), PlateRow{}) << "no thickness";
  steps.thickness = {{2, 2}, {2, 2}};
  steps.hidden[1] = true;
  EXPECT_TRUE(has_side(shape_of(steps), 2, 1));
}

TEST(PlateShape, of_triangles_has_three_sides) {
  TestSource source;
  const std::uint32_t a = source.add_node({0, 0, 0}), b = source.add_node({10, 0, 0}), c = source.add_node({0, 10, 0});
  source.add_shell(a, b, c, c, 0);
  source.thickness = {{1, 1}};
  const PlateShape shape = shape_of(source);
  for (const std::uint32_t corner : shape.row(0)) EXPECT_EQ(plate_way(corner), Vec3::UnitZ());
  EXPECT_TRUE(has_side(shape, 0, 0));
  EXPECT_TRUE(has_side(shape, 0, 1));
  EXPECT_FALSE(has_side(shape, 0, 2));
  EXPECT_TRUE(has_side(shape, 0, 3));
}

/// Moves nodes of a sheet of several chunks here and there: the rows are those that are computed anew.
TEST(PlateShape, follows_moved_nodes) {
  TestSource source;
  test::add_grid(source, 150, 120, 0, [](double u, double v) { return Vec3(150 * u, 120 * v, 9 * std::sin(8 * u) * std::cos(5 * v)); });
  source.thickness = {{2, 2}};
  PlateShape shape = shape_of(source);
  for (const std::uint32_t node : {5U, 4095U, 4096U, 9000U, 18000U}) {
    source.positions[node].z() += 0.8;
    const std::uint32_t chunk = node / mesh::kChunkSize;
    const std::vector<std::uint32_t> changed = shape.move(table_of(source), std::span(&chunk, 1));
    EXPECT_FALSE(changed.empty());
    const PlateShape anew = shape_of(source);
    for (std::size_t s = 0; s < shape.shell_count(); ++s) ASSERT_EQ(shape.row(s), anew.row(s)) << node << ", " << s;
  }
}

TEST(PlateShape, survives_what_no_model_has) {
  TestSource source = flat_sheet();
  source.positions[8] = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  source.shell_nodes[20].node[2] = mesh::NodeIndex(100000);
  source.shell_nodes[21].node = {mesh::NodeIndex(2), mesh::NodeIndex(2), mesh::NodeIndex(2), mesh::NodeIndex(2)};
  source.shell_parts[22] = mesh::PartIndex(77);
  for (int i = 0; i < 40; ++i) source.add_shell(0, 1, 8, 7, 0);
  source.thickness = {{std::numeric_limits<float>::infinity(), 2}};
  EXPECT_EQ(shape_of(source).row(0), PlateRow{});
  source.thickness = {{2, 2}};
  const PlateShape shape = shape_of(source);
  EXPECT_EQ(shape.row(20), PlateRow{});
  EXPECT_EQ(plate_way(shape.row(17)[0]), Vec3::UnitZ());
}

class Plates : public RenderTest {
 protected:
  Picture plain(const std::string& view, const std::string& profile = "mono") {
    Picture picture = fitted(profile, view, kPlatesWidth, kPlatesHeight);
    picture.element_edges = picture.outlines = picture.quality_glyphs = false;
    return picture;
  }
  Image drawn(const Picture& picture) { return draw(picture, kPlatesWidth, kPlatesHeight); }
  Eigen::Vector2d pixel_of(const Picture& picture, const Vec3& at) {
    return *stereo::pixel_of(aim_of(picture, kPlatesWidth, kPlatesHeight), at);
  }
  std::array<int, 3> rgb(const Image& image, const Eigen::Vector2d& pixel) {
    const std::uint8_t* at = image.at(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
    return {at[0], at[1], at[2]};
  }
  /// By pixel: whether the model is drawn there, from the picture without it.
  std::vector<bool> covered(const Picture& picture, const TestSource& source) {
    const Image with = drawn(picture);
    EXPECT_TRUE(renderer_->set_model(nullptr));
    const Image ground = drawn(picture);
    show(source);
    std::vector<bool> covered(std::size_t{kPlatesWidth} * kPlatesHeight);
    for (int y = 0; y < kPlatesHeight; ++y)
      for (int x = 0; x < kPlatesWidth; ++x)
        covered[static_cast<std::size_t>(y) * kPlatesWidth + x] = !std::equal(with.at(x, y), with.at(x, y) + 3, ground.at(x, y));
    return covered;
  }
  static int height_at(const std::vector<bool>& covered, int x) {
    int height = 0;
    for (int y = 0; y < kPlatesHeight; ++y) height += covered[static_cast<std::size_t>(y) * kPlatesWidth + x] ? 1 : 0;
    return height;
  }
};

TEST_F(Plates, seen_along_the_sheet_are_as_high_as_they_are_thick) {
  TestSource source = flat_sheet();
  for (const float thickness : {3.0F, 6.0F}) {
    source.thickness = {{thickness, thickness}};
    show(source);
    Picture picture = plain("front");
    EXPECT_LE(height_at(covered(picture, source), kPlatesWidth / 2), 2) << "a surface seen along itself";
    picture.thickness = true;
    // The side nearest to the eye, at y = 0, is the highest.
    const double wanted = pixel_of(picture, {33, 0, -thickness / 2}).y() - pixel_of(picture, {33, 0, thickness / 2}).y();
    ASSERT_GT(wanted, 10);
    const int x = static_cast<int>(pixel_of(picture, {33, 0, 0}).x());
    EXPECT_NEAR(height_at(covered(picture, source), x), wanted, 1.5) << thickness;
  }
}

TEST_F(Plates, leave_parts_without_thickness_as_they_are) {
  TestSource source = test::two_plates();
  show(source);
  Picture picture = plain("iso");
  picture.element_edges = true;
  const Image surfaces = drawn(picture);
  picture.thickness = true;
  EXPECT_EQ(drawn(picture).rgb, surfaces.rgb);
  source.thickness = {{0, 0}, {0, 3}};
  show(source);
  EXPECT_EQ(drawn(picture).rgb, surfaces.rgb) << "not all shells of the part have a thickness";
  source.thickness = {{0, 0}, {3, 3}};
  show(source);
  EXPECT_NE(drawn(picture).rgb, surfaces.rgb);
}

/// A bent sheet, from outside and from inside: between the first and the last pixel of each row there is no gap.
TEST_F(Plates, of_curved_sheets_have_no_cracks) {
  TestSource source;
  test::add_grid(source, 12, 10, 0, [](double u, double v) {
    const double angle = (u - 0.5) * 0.9 * std::numbers::pi;
    return Vec3(40 * std::sin(angle), 60 * v, 40 * std::cos(angle));
  });
  source.thickness = {{8, 8}};
  for (const std::size_t shell : {17U, 31U, 64U}) std::swap(source.shell_nodes[shell].node[1], source.shell_nodes[shell].node[3]);
  show(source);
  for (const char* view : {"top", "bottom", "left"}) {
    Picture picture = plain(view);
    picture.thickness = true;
    const std::vector<bool> seen = covered(picture, source);
    int rows = 0;
    // Not the ends, which are arcs.
    const auto [low, high] = std::minmax(pixel_of(picture, {0, 8, 30}).y(), pixel_of(picture, {0, 52, 30}).y());
    const bool along = high - low < 20;  // seen along the rows
    for (int y = along ? 0 : static_cast<int>(low); y < (along ? kPlatesHeight : static_cast<int>(high)); ++y) {
      const auto begin = seen.begin() + static_cast<std::ptrdiff_t>(y) * kPlatesWidth, end = begin + kPlatesWidth;
      const auto first = std::find(begin, end, true);
      const auto last = std::find(std::make_reverse_iterator(end), std::make_reverse_iterator(begin), true).base();
      if (first == end) continue;
      ++rows;
      EXPECT_EQ(std::count(first, last, false), 0) << view << ", row " << y;
    }
    EXPECT_GT(rows, 100) << view;
  }
}

TEST_F(Plates, are_closed_from_every_side) {
  TestSource source = folded(60);
  source.thickness = {{6, 6}};
  show(source);
  // Seen through a hole one would see a surface turned away, which isn't drawn, so the ground: within the outline of the surface.
  for (const char* view : {"iso", "front", "back", "left", "right", "top", "bottom"}) {
    Picture picture = plain(view);
    const std::vector<bool> surface = covered(picture, source);
    picture.thickness = true;
    const std::vector<bool> plates = covered(picture, source);
    std::size_t missing = 0;
    for (std::size_t i = 0; i < surface.size(); ++i) missing += surface[i] && !plates[i] ? 1 : 0;
    EXPECT_EQ(missing, 0U) << view;
    EXPECT_GT(std::count(plates.begin(), plates.end(), true), std::count(surface.begin(), surface.end(), true)) << view;
  }
}

TEST_F(Plates, show_fields_and_the_selection_on_their_outer_faces_and_sides) {
  TestSource source = flat_sheet();
  source.thickness = {{6, 6}};
  show(source);
  Picture top = plain("top"), front = plain("front");
  top.thickness = front.thickness = true;
  const Eigen::Vector2d above = pixel_of(top, {33, 17, 3}), beside = pixel_of(front, {33, 0, 1});
  const auto grey = rgb(drawn(top), above), grey_side = rgb(drawn(front), beside);
  const std::vector<float> values(source.positions.size(), 9);
  ASSERT_TRUE(renderer_->set_field(Pane::model, values, true));
  for (Picture* picture : {&top, &front}) {
    picture->colour = ColourMode::field;
    picture->field[0] = {true, 2, 8, ColourMap::crimson, 0};
  }
  const Colour crimson = *top.field[0].colour_of(9);
  for (const auto& seen : {rgb(drawn(top), above), rgb(drawn(front), beside)}) {
    const Colour colour = Colour(static_cast<float>(seen[0]), static_cast<float>(seen[1]), static_cast<float>(seen[2]));
    EXPECT_LT((colour / colour.sum() - crimson / crimson.sum()).norm(), 0.02F);
  }
  for (Picture* picture : {&top, &front}) {
    picture->colour = ColourMode::parts;
    picture->selected_nodes = false;
  }
  for (std::uint8_t& marks : source.shell_marks) marks = mesh::document::kSelected;
  source.touch(ipc::SnapshotArray::shell_marks, 0);
  show(source);
  const auto chosen = rgb(drawn(top), above), chosen_side = rgb(drawn(front), beside);
  EXPECT_GT(chosen[2], grey[2] + 40) << "a tint toward white";
  EXPECT_GT(chosen_side[2], grey_side[2] + 40);
}

TEST_F(Plates, that_are_transparent_mix_once_with_what_is_behind) {
  TestSource source = test::two_plates();
  source.thickness = {{4, 4}, {4, 4}};
  show(source);
  Picture picture = plain("top");
  const std::array<PartPaint, 1> paints{{{std::nullopt, true}}};
  ASSERT_TRUE(renderer_->set_part_paints(paints));
  const Eigen::Vector2d at = pixel_of(picture, {4, 4, 20});
  const auto surfaces = rgb(drawn(picture), at);
  picture.thickness = true;
  const auto plates = rgb(drawn(picture), at);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(plates[c], surfaces[c], 3) << "one layer, not two";
}

TEST_F(Plates, that_are_cut_show_their_inside_darker_and_nothing_above_the_cut) {
  if (!Renderer::can_cut()) GTEST_SKIP() << "CUT PICTURES ARE NOT TESTED: the driver has no GL_EXT_clip_cull_distance";
  TestSource source = flat_sheet();
  source.thickness = {{8, 8}};
  show(source);
  Picture picture = plain("front");
  picture.thickness = true;
  const Eigen::Vector2d middle = pixel_of(picture, {33, 20, 0});
  const auto side = rgb(drawn(picture), middle);
  ASSERT_TRUE(renderer_->set_cut(CutPicture{{0, 20, 0}, -Vec3::UnitY(), {}}));  // what is nearer than y = 20 is away
  const auto inside = rgb(drawn(picture), middle);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_LT(inside[c], 0.8 * side[c]);
  const double wanted = pixel_of(picture, {33, 20, -4}).y() - pixel_of(picture, {33, 20, 4}).y();
  EXPECT_NEAR(height_at(covered(picture, source), static_cast<int>(middle.x())), wanted, 1.5);
}

TEST_F(Plates, dont_hide_the_marks_on_their_mid_surfaces) {
  TestSource source = flat_sheet();
  source.thickness = {{4, 4}};
  source.shell_quality[8].fail = 1;
  source.node_marks[17] = mesh::document::kSelected;  // at (30, 20)
  show(source);
  Picture picture = plain("top");
  picture.thickness = picture.quality_glyphs = picture.outlines = true;
  const Image marked = drawn(picture);
  picture.quality_glyphs = false;
  EXPECT_NE(drawn(picture).rgb, marked.rgb) << "glyphs";
  const auto node = rgb(drawn(picture), pixel_of(picture, {30, 20, 0}) + Eigen::Vector2d(-1, -1));
  picture.selected_nodes = false;
  const auto none = rgb(drawn(picture), pixel_of(picture, {30, 20, 0}) + Eigen::Vector2d(-1, -1));
  EXPECT_GT(node[0] + node[1] + node[2], none[0] + none[1] + none[2] + 60) << "a selected node";
  const Image lines = drawn(picture);
  picture.outlines = false;
  EXPECT_NE(drawn(picture).rgb, lines.rgb) << "free edges";
}

TEST_F(Plates, follow_edits_and_are_the_same_in_pieces) {
  TestSource source = folded(30);
  source.thickness = {{4, 4}};
  show(source);
  Picture picture = plain("iso", "side-by-side");
  picture.thickness = true;
  const Image before = drawn(picture);
  source.positions[10].z() += 6;
  source.touch(ipc::SnapshotArray::positions, 0);
  show(source);
  const Image moved = drawn(picture);
  EXPECT_NE(moved.rgb, before.rgb);
  source.thickness = {{5, 5}};
  show(source);
  const Image thicker = drawn(picture);
  EXPECT_NE(thicker.rgb, moved.rgb);
  make_renderer({.samples = 1});
  show(source);
  EXPECT_EQ(drawn(picture).rgb, thicker.rgb) << "as a renderer that saw nothing else";
  make_renderer({.samples = 1});
  show(source);
  MonotonicClock clock;
  for (int pieces = 0; pieces < 1000; ++pieces) {
    const Result<bool> whole = renderer_->draw_piece(picture, kPlatesWidth, kPlatesHeight, clock, 1);
    ASSERT_TRUE(whole) << whole.error().text();
    if (*whole) break;
  }
  EXPECT_EQ(drawn(picture).rgb, thicker.rgb);
}

}  // namespace
}  // namespace prismesh::kiosk::render
