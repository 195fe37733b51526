// Rows of quads that are squeezed between two creases: how far leaning edges help, and that both creases stay.
#include "mesh/repair/row_slide.h"

#include <gtest/gtest.h>

#include "mesh/quality/judge.h"
#include "mesh/quality/measure.h"
#include "tests/mesh/repair/patch_fixture.h"
#include "tests/mesh/repair/validator.h"

namespace prismesh::mesh::repair {
namespace {

constexpr std::size_t kColumns = 20, kRows = 9, kNarrowRow = 4;

/// A step in a sheet: between two creases of 65 degrees along x a row as wide as `width`, at its ends and beyond 0.6.
Grid squeezed_step(double width) {
  return {kColumns,
          kRows,
          [width](double x, double y) {
            const double from_end = std::min(x, static_cast<double>(kColumns) - x);
            const double own = from_end < 3 ? 0.6 : from_end < 5 ? 0.6 + (width - 0.6) * (from_end - 3) / 2 : width;
            const double up = y <= kNarrowRow ? 0 : own;
            const double angle = 65 * M_PI / 180;
            return Vec3(x, y <= kNarrowRow ? y : y - 1 + up * std::cos(angle), up * std::sin(angle));
          },
          {}};
}

quality::Grade grade_in_step(const Model& model, ShellIndex shell) {
  std::vector<Vec3> corners;
  for (int i = 0; i < model.shell(shell).corners(); ++i)
    corners.push_back(model.position(model.shell(shell).node[static_cast<std::size_t>(i)]));
  return quality::judge(quality::measure(corners), {quality::default_criteria(), 1.0}).grade();
}
std::size_t bad_in_step(const Model& model) {
  std::size_t bad = 0;
  for (const ShellIndex shell : all_shells(model)) bad += grade_in_step(model, shell) != quality::Grade::ok ? 1 : 0;
  return bad;
}

Model repaired_step(const Model& model, const Rules& rules = {}) {
  const relax::ReferenceSurface surface(model, all_shells(model), 30);
  const quality::SizedCriteria criteria{quality::default_criteria(), 1.0};
  const auto result = repair({model, surface, rules, criteria, {}}, all_shells(model));
  EXPECT_TRUE(result.has_value());
  return carried_out(model, result->change);
}

TEST(RowSlide, lengthens_a_narrow_row_and_keeps_both_creases) {
  const Grid grid = squeezed_step(0.37);
  const Model before = model_of(grid.positions(), grid.shells());
  EXPECT_GE(bad_in_step(before), 10U);
  const Model after = repaired_step(before);
  EXPECT_EQ(bad_in_step(after), 0U);
  EXPECT_EQ(what_is_wrong(after), "");
  EXPECT_EQ(live_shells(after), live_shells(before)) << "no row was taken out";
  const Shape a = shape_of(before), b = shape_of(after);
  EXPECT_NEAR(a.crease_length, b.crease_length, 1e-3 * a.crease_length);
  EXPECT_NEAR(a.area, b.area, 1e-3 * a.area);
  for (const std::size_t row : {kNarrowRow, kNarrowRow + 1})
    for (std::size_t i = 0; i <= kColumns; ++i) {
      const Vec3 now = after.position(at(grid.node(i, row)));
      const Vec3 on_crease = grid.place(now.x(), static_cast<double>(row));
      EXPECT_LE((now - on_crease).norm(), 0.02) << "node " << i << " of row " << row;
    }
}

TEST(RowSlide, leaves_little_of_a_narrower_row) {
  const Grid grid = squeezed_step(0.33);
  const Model before = model_of(grid.positions(), grid.shells());
  EXPECT_GE(bad_in_step(before), 10U);
  EXPECT_LE(bad_in_step(repaired_step(before)), 2U);
}

/// The best that any quad between two parallel lines can do, without this module: all leans of both edges across, all lengths along.
bool some_quad_passes(double width) {
  for (double left = -0.6; left <= 0.6; left += 0.015)
    for (double right = -0.6; right <= 0.6; right += 0.015)
      for (double length = 0.4; length <= 1.5; length += 0.05) {
        const Vec3 corners[4] = {{0, 0, 0}, {length, 0, 0}, {length + right, width, 0}, {left, width, 0}};
        if (length + right - left <= 0) continue;
        if (quality::judge(quality::measure(corners), {quality::default_criteria(), 1.0}).grade() == quality::Grade::ok) return true;
      }
  return false;
}

TEST(RowSlide, below_a_width_no_quad_between_the_creases_can_pass) {
  // An edge of 0.4 across leans by the quad's smallest angle at most: 0.4 * sin(46 degrees).
  const double bound = 0.4 * std::sin(46 * M_PI / 180);
  EXPECT_FALSE(some_quad_passes(0.99 * bound));
  EXPECT_TRUE(some_quad_passes(1.03 * bound));
  const Grid grid = squeezed_step(0.26);
  const Model before = model_of(grid.positions(), grid.shells());
  const Model after = repaired_step(before);
  EXPECT_GE(bad_in_step(after), 8U) << "the row stays, and so do its bends";
  EXPECT_EQ(live_shells(after), live_shells(before));
}

TEST(RowSlide, nodes_that_must_stay_leave_the_sliding_to_the_others) {
  const Grid grid = squeezed_step(0.33);
  const Model before = model_of(grid.positions(), grid.shells());
  Rules rules;
  rules.node = [&](NodeIndex node) {
    const std::size_t row = node.value / (kColumns + 1);
    return static_cast<std::uint8_t>(row == kNarrowRow ? kStays | kNeeded : 0);
  };
  const Model after = repaired_step(before, rules);
  EXPECT_GE(bad_in_step(before), 10U);
  EXPECT_LE(bad_in_step(after), 2U);
  for (std::size_t i = 0; i <= kColumns; ++i)
    EXPECT_EQ(after.position(at(grid.node(i, kNarrowRow))), before.position(at(grid.node(i, kNarrowRow))));
}

TEST(RowSlide, is_offered_for_short_edges_between_lines_only) {
  const Grid grid = squeezed_step(0.33);
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  const LocalShell narrow = fixture.shell(grid.shell(10, kNarrowRow));
  EXPECT_EQ(row_slides(fixture.context, narrow).size(), 4U);
  EXPECT_TRUE(row_slides(fixture.context, fixture.shell(grid.shell(1, kNarrowRow))).empty()) << "wide enough";
  EXPECT_TRUE(row_slides(fixture.context, fixture.shell(grid.shell(10, kNarrowRow + 1))).empty()) << "one crease beside it";
  for (const RowSlide& slide : row_slides(fixture.context, narrow)) {
    fixture.patch.begin();
    EXPECT_FALSE(slide_row(fixture.context, slide));
    const Model after = fixture.after();
    for (std::size_t i = 6; i <= kColumns - 6; ++i)
      EXPECT_GE((after.position(at(grid.node(i, kNarrowRow))) - after.position(at(grid.node(i, kNarrowRow + 1)))).norm(), 0.4);
    fixture.patch.take_back();
  }
}

}  // namespace
}  // namespace prismesh::mesh::repair
