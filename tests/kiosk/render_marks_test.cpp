// Marks that don't bury the model: glyphs thin out at a distance, and selected faces are tinted where dots would lie on each other.
#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "kiosk/render/glyph_levels.h"
#include "tests/kiosk/render_test.h"

namespace prismesh::kiosk::render {
namespace {

using ipc::SnapshotArray;
using mesh::Vec3;
using test::TestSource;

/// A plate of n x n shells of edge 1, of which each warns.
TestSource warning_plate(std::uint32_t n) {
  TestSource source;
  test::add_grid(source, n, n, 0, [&](double u, double v) { return Vec3(n * u, n * v, 0); });
  for (auto& state : source.shell_quality) state.warn = 1;
  return source;
}

std::vector<Glyph> glyphs_of(const TestSource& source) {
  std::vector<Glyph> glyphs;
  for (std::uint32_t s = 0; s < source.shell_nodes.size(); ++s) {
    const bool fails = source.shell_quality[s].fail != 0;
    glyphs.push_back({s, static_cast<std::uint32_t>(GlyphShape::warped) | (fails ? kFailingGlyph : 0)});
    glyphs.push_back({s, static_cast<std::uint32_t>(GlyphShape::other) | (fails ? kFailingGlyph : 0)});
  }
  std::stable_sort(glyphs.begin(), glyphs.end(),
                   [](const Glyph& a, const Glyph& b) { return (a.kind & kFailingGlyph) < (b.kind & kFailingGlyph); });
  return glyphs;
}

std::size_t shown_at(const std::vector<Glyph>& glyphs, double spacing) {
  return static_cast<std::size_t>(std::count_if(
      glyphs.begin(), glyphs.end(), [&](const Glyph& glyph) { return glyph.kind >> kGlyphLevelShift >= needed_glyph_level(spacing); }));
}

TEST(GlyphLevels, thin_out_with_the_distance_and_failures_stay) {
  TestSource source = warning_plate(64);
  source.shell_quality[20 * 64 + 20].fail = 1;
  const ModelTable table(std::make_shared<TestSource>(source));
  std::vector<Glyph> glyphs = glyphs_of(source);
  set_glyph_levels(table, 1, glyphs);
  EXPECT_EQ(shown_at(glyphs, 0.4), glyphs.size()) << "shells are larger than the spacing";
  std::size_t before = glyphs.size();
  for (const double spacing : {2.0, 4.0, 8.0, 16.0, 32.0}) {
    const std::size_t shown = shown_at(glyphs, spacing);
    EXPECT_EQ(shown, before / 4) << spacing;
    before = shown;
  }
  EXPECT_EQ(shown_at(glyphs, 1e9), 2U) << "one shell, with both of its glyphs";
  for (const Glyph& glyph : glyphs) {
    EXPECT_EQ(glyph.kind >> kGlyphLevelShift == kShownAtEveryLevel, glyph.shell == 20 * 64 + 20) << "the one that fails";
    EXPECT_EQ(glyph.kind & 15U, glyph.kind & 0xffU & 15U);
  }
  // At any distance some glyph is near each shell that has one.
  for (const double spacing : {2.0, 8.0, 32.0})
    for (const Glyph& glyph : glyphs) {
      Vec3 at, other;
      ASSERT_TRUE(table.shell_centre(glyph.shell, at));
      const bool near = std::any_of(glyphs.begin(), glyphs.end(), [&](const Glyph& each) {
        return each.kind >> kGlyphLevelShift >= needed_glyph_level(spacing) && table.shell_centre(each.shell, other) &&
               (other - at).cwiseAbs().maxCoeff() <= spacing;
      });
      ASSERT_TRUE(near) << spacing;
    }
}

TEST(GlyphLevels, of_absurd_places) {
  TestSource source = warning_plate(2);
  for (Vec3& at : source.positions) at *= 1e200;
  source.positions[0] = Vec3(std::nan(""), 0, 0);
  const ModelTable table(std::make_shared<TestSource>(source));
  std::vector<Glyph> glyphs = glyphs_of(source);
  for (const double least : {1.0, 0.0, 1e300, std::nan("")}) set_glyph_levels(table, least, glyphs);
  EXPECT_GT(shown_at(glyphs, 1e300), 0U);
  std::vector<Glyph> none;
  set_glyph_levels(table, 1, none);
  EXPECT_EQ(needed_glyph_level(0), 0U);
  EXPECT_EQ(needed_glyph_level(std::nan("")), 0U);
  EXPECT_EQ(needed_glyph_level(1e300), kShownAtEveryLevel);
}

class MarkPictures : public RenderTest {
 protected:
  static constexpr int kSide = 300;
  std::size_t pixels_that_differ(const Image& a, const Image& b) {
    std::size_t count = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        if (std::abs(brightness(a, x, y) - brightness(b, x, y)) > 24) ++count;
    return count;
  }
  Picture of(const TestSource& source) {
    show(source);
    Picture picture = fitted("mono", "top", kSide, kSide);
    picture.element_edges = picture.outlines = false;
    return picture;
  }
};

TEST_F(MarkPictures, glyphs_leave_most_of_a_far_plate_free_and_are_all_there_near_by) {
  Picture picture = of(warning_plate(100));
  const Image with = draw(picture, kSide, kSide);
  picture.quality_glyphs = false;
  const Image without = draw(picture, kSide, kSide);
  const double covered = static_cast<double>(pixels_that_differ(with, without)) / (kSide * kSide);
  EXPECT_GT(covered, 0.02);
  EXPECT_LT(covered, 0.5) << "of 10,000 glyphs on shells of 3 pixels";
}

TEST_F(MarkPictures, selected_faces_are_tinted_and_have_dots_only_where_those_are_apart) {
  // A block of faces, and a node alone.
  const auto selected = [](std::uint32_t n) {
    TestSource source;
    source.key = n;  // another document
    test::add_grid(source, n, n, 0, [&](double u, double v) { return Vec3(100 * u, 100 * v, 0); });
    for (std::uint32_t j = n / 4; j <= n / 2; ++j)
      for (std::uint32_t i = n / 4; i <= n / 2; ++i) source.node_marks[j * (n + 1) + i] = mesh::document::kSelected;
    source.node_marks[(3 * n / 4) * (n + 1) + 3 * n / 4] = mesh::document::kSelected;
    return source;
  };
  const auto at = [&](const Picture& picture, const Image& image, double x, double y) {
    const Eigen::Vector2d pixel = *stereo::pixel_of(aim_of(picture, kSide, kSide), Vec3(x, y, 0));
    return brightness(image, static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
  };
  for (const std::uint32_t n : {100U, 8U}) {
    Picture picture = of(selected(n));
    const Image image = draw(picture, kSide, kSide);
    picture.selected_nodes = false;
    const Image without_dots = draw(picture, kSide, kSide);
    const double side = 100.0 / n;
    EXPECT_GT(at(picture, without_dots, 37.5 + side / 2, 37.5 + side / 2), at(picture, without_dots, 12.5 + side / 2, 12.5 + side / 2) + 20)
        << "faces are tinted";
    // White on a tint that is nearly white: its dark rim tells a dot.
    const Eigen::Vector2d dot = *stereo::pixel_of(aim_of(picture, kSide, kSide), Vec3(37.5, 37.5, 0));
    bool dots = false;
    for (int y = static_cast<int>(dot.y()) - 6; y <= static_cast<int>(dot.y()) + 6; ++y)
      for (int x = static_cast<int>(dot.x()) - 6; x <= static_cast<int>(dot.x()) + 6; ++x)
        dots = dots || std::abs(brightness(image, x, y) - brightness(without_dots, x, y)) > 30;
    EXPECT_EQ(dots, n == 8) << n;
    EXPECT_GT(at(picture, image, 75, 75), at(picture, without_dots, 75, 75) + 20) << "a node alone has its dot: " << n;
  }
}

TEST_F(MarkPictures, the_tint_goes_with_the_selection) {
  TestSource source;
  test::add_grid(source, 10, 10, 0, [&](double u, double v) { return Vec3(100 * u, 100 * v, 0); });
  Picture picture = of(source);
  picture.selected_nodes = false;
  const Image before = draw(picture, kSide, kSide);
  for (const std::uint32_t node : {0U, 1U, 11U, 12U}) source.node_marks[node] = mesh::document::kSelected;
  source.touch(SnapshotArray::node_marks, 0);
  show(source);
  EXPECT_GT(pixels_that_differ(draw(picture, kSide, kSide), before), 200U);
  source.node_marks[12] = 0;
  source.touch(SnapshotArray::node_marks, 0);
  show(source);
  EXPECT_EQ(pixels_that_differ(draw(picture, kSide, kSide), before), 0U) << "three corners select no face";
}

}  // namespace
}  // namespace prismesh::kiosk::render
