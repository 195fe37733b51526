// Whether a change of a patch may be: each reason against it alone.
#include "mesh/repair/acceptance.h"

#include <cmath>

#include <gtest/gtest.h>

#include "mesh/repair/redivide.h"
#include "tests/mesh/repair/patch_fixture.h"

namespace prismesh::mesh::repair {
namespace {

/// Judges all shells as they are; changes begin there.
void begin_judged(PatchFixture& fixture) {
  fixture.patch.begin();
  std::vector<LocalShell> all;
  for (std::size_t s = 0; s < fixture.patch.shell_count(); ++s) all.emplace_back(s);
  judge_shells(fixture.context, all);
  fixture.patch.keep();
  fixture.patch.begin();
}

LocalNode node_at(const PatchFixture& fixture, const Grid& grid, std::size_t i, std::size_t j) {
  return fixture.patch.find(at(grid.node(i, j)));
}

bool harms_after(PatchFixture& fixture, LocalNode node, const Vec3& place) {
  begin_judged(fixture);
  fixture.patch.move(node, place);
  judge_shells(fixture.context, fixture.patch.changed_shells());
  return adds_failures(fixture.patch);
}

TEST(Harms, when_a_shell_that_passed_fails) {
  const Grid grid = flat(4, 4);
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  EXPECT_FALSE(harms_after(fixture, node_at(fixture, grid, 2, 2), Vec3(2.1, 2, 0)));
  EXPECT_TRUE(harms_after(fixture, node_at(fixture, grid, 2, 2), Vec3(2.9, 2, 0)));
}

TEST(Harms, not_when_shells_that_failed_still_do) {
  const Grid grid = flat(4, 4);
  std::vector<Vec3> positions = grid.positions();
  positions[grid.node(2, 2)].x() = 2.9;
  PatchFixture fixture(model_of(positions, grid.shells()));
  EXPECT_FALSE(harms_after(fixture, node_at(fixture, grid, 2, 2), Vec3(2.88, 2, 0)));
}

/// Flat quads of a tenth's width side by side: all of them fail.
struct Slats {
  Grid grid{3, 1, [](double x, double y) { return Vec3(0.1 * x, y, 0); }, {}};
  PatchFixture fixture{model_of(grid.positions(), grid.shells())};
};

TEST(Harms, when_a_new_shell_fails_and_none_is_cured) {
  Slats slats;
  begin_judged(slats.fixture);
  ASSERT_FALSE(split_quad(slats.fixture.context, slats.fixture.shell(1), 0));
  judge_shells(slats.fixture.context, slats.fixture.patch.changed_shells());
  EXPECT_TRUE(adds_failures(slats.fixture.patch));
}

TEST(Harms, not_when_a_new_shell_fails_and_more_are_cured) {
  Slats slats;
  begin_judged(slats.fixture);
  Patch& patch = slats.fixture.patch;
  const Corners corners = patch.shell(slats.fixture.shell(0)).corners;
  patch.remove_shell(slats.fixture.shell(0));
  patch.remove_shell(slats.fixture.shell(1));
  patch.add_shell(corners, slats.fixture.shell(2));
  judge_shells(slats.fixture.context, patch.changed_shells());
  EXPECT_FALSE(adds_failures(patch));
}

/// Whether a mesh conforms in which nothing has changed.
bool conforms_as_it_is(PatchFixture& fixture) {
  fixture.patch.begin();
  for (std::size_t n = 0; n < fixture.patch.node_count(); ++n) fixture.patch.move(LocalNode(n), fixture.patch.position(LocalNode(n)));
  return conforms(fixture.patch);
}

TEST(Conforms, whole_sheets_with_holes_and_creases) {
  for (const Grid& grid : {flat(4, 4), cylinder(), l_profile()}) {
    PatchFixture fixture(model_of(grid.positions(), grid.shells()));
    EXPECT_TRUE(conforms_as_it_is(fixture));
  }
}

TEST(Conforms, not_a_shell_with_a_corner_twice) {
  const Grid grid = flat(1, 1);
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  fixture.patch.begin();
  const Corners c = fixture.patch.shell(fixture.shell(0)).corners;
  fixture.patch.set_corners(fixture.shell(0), {c[0], c[1], c[2], c[1]});
  EXPECT_FALSE(conforms(fixture.patch));
}

TEST(Conforms, not_two_shells_with_three_corners_in_common) {
  // two quads whose common node has no other shells: flat, and every edge has its two shells
  PatchFixture fixture(model_of({{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}}, {{0, 1, 2, 3}, {0, 4, 2, 1}}));
  EXPECT_FALSE(conforms_as_it_is(fixture));
}

TEST(Conforms, not_an_edge_inside_a_sheet_with_one_shell) {
  const Grid grid = flat(4, 4);
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  fixture.patch.begin();
  fixture.patch.remove_shell(fixture.shell(5));
  for (std::size_t n = 0; n < fixture.patch.node_count(); ++n) fixture.patch.move(LocalNode(n), fixture.patch.position(LocalNode(n)));
  EXPECT_FALSE(conforms(fixture.patch));
}

TEST(Conforms, not_a_free_edge_with_two_shells) {
  const Grid grid = flat(3, 3);
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  fixture.patch.begin();
  // a tent over the sheet's four corners: its edges have two shells, those of the sheet one too many
  const Corners c = fixture.patch.shell(fixture.shell(0)).corners;
  const std::array<double, 4> quarters{0.25, 0.25, 0.25, 0.25};
  const LocalNode top = fixture.patch.add_node(Vec3(0.5, -0.5, -2), c, quarters, relax::Freedom::surface);
  fixture.patch.add_shell(triangle(c[0], c[1], top), fixture.shell(0));
  EXPECT_FALSE(conforms(fixture.patch));
}

TEST(Conforms, not_a_sheet_folded_where_it_has_no_crease) {
  // two flanges 30 degrees apart
  const auto folded = [](double x, double y) { return x <= 3 ? Vec3(x, y, 0) : Vec3(3 - std::sqrt(0.75) * (x - 3), y, 0.5 * (x - 3)); };
  const Grid crease{6, 4, folded, {}};
  PatchFixture sharp(model_of(crease.positions(), crease.shells()));
  EXPECT_TRUE(conforms_as_it_is(sharp)) << "a crease may be sharp";
  const Grid grid = flat(6, 4);
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  fixture.patch.begin();
  for (std::size_t n = 0; n < fixture.patch.node_count(); ++n) {
    const Vec3& place = fixture.patch.position(LocalNode(n));
    fixture.patch.move(LocalNode(n), folded(place.x(), place.y()));
  }
  EXPECT_FALSE(conforms(fixture.patch));
}

TEST(KeepsToSurface, within_what_is_allowed_or_was_there) {
  const Grid grid = flat(4, 4);
  PatchFixture fixture(model_of(grid.positions(), grid.shells()));
  ASSERT_EQ(fixture.options.max_off_surface, 0.02);
  const LocalNode node = node_at(fixture, grid, 2, 2);
  const auto keeps_at = [&](double height) {
    fixture.patch.begin();
    fixture.patch.move(node, Vec3(2, 2, height));
    const bool keeps = stays_on_surface(fixture.context);
    fixture.patch.take_back();
    return keeps;
  };
  // an edge's middle is half as far off as the node
  EXPECT_TRUE(keeps_at(0.039));
  EXPECT_FALSE(keeps_at(0.041));
  fixture.patch.begin();
  fixture.patch.move(node, Vec3(2, 2, 0.4));
  fixture.patch.keep();
  EXPECT_TRUE(keeps_at(0.4));
  EXPECT_TRUE(keeps_at(-0.1)) << "better than it was";
  EXPECT_FALSE(keeps_at(0.7));
}

}  // namespace
}  // namespace prismesh::mesh::repair
