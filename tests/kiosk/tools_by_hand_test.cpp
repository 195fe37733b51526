// What a click means for an operation by hand, and how the view moves to an error.
#include "kiosk/tools/mesh_operations/by_hand.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kiosk/render/renderer.h"
#include "kiosk/toolkit/view_glide.h"
#include "tests/kiosk/test_source.h"

namespace prismesh::kiosk::tools::mesh_operations {
namespace {

using toolkit::ViewGlide;

using mesh::NodeIndex;
using mesh::ShellIndex;
using mesh::Vec3;
using mesh::repair::Operation;
using testing::ElementsAre;
using testing::UnorderedElementsAre;

/// Quads of 10 x 10 in the plane of the screen, three by two; 8 pixels a unit.
struct Board {
  test::TestSource source;
  stereo::Aim aim;
  Board() {
    test::add_grid(source, 3, 2, 0, [](double u, double v) { return Vec3(u * 30 - 15, v * 20 - 10, 0); });
    render::Picture picture;
    picture.profile = *stereo::find_profile("mono");
    picture.view.mm_per_unit = 8 * picture.profile.optics.pixel_pitch_mm;
    picture.view.bounds = {Vec3::Zero(), 20};
    aim = render::aim_for(picture, 640, 400);
  }
  std::optional<HandTarget> at(Operation operation, std::size_t shell, double x, double y) const {
    return hand_target(source, aim, operation, ShellIndex(shell), *stereo::pixel_of(aim, {x, y, 0}));
  }
};

TEST(ByHand, a_click_in_the_middle_means_the_shell_and_next_to_an_edge_the_two_at_it) {
  const Board board;  // shell 1 lies from x -5 to 5, y -10 to 0; shell 4 above it
  EXPECT_THAT(board.at(Operation::split, 1, 0, -5)->shells, ElementsAre(ShellIndex(1)));
  EXPECT_THAT(board.at(Operation::split, 1, 0.5, -0.5)->shells, UnorderedElementsAre(ShellIndex(1), ShellIndex(4)));
  EXPECT_THAT(board.at(Operation::split, 1, 0, -9.7)->shells, ElementsAre(ShellIndex(1))) << "a free edge has no other shell";
}

TEST(ByHand, next_to_an_edge_of_three_shells_a_split_means_the_shell_alone) {
  Board board;  // a rib stands on the edge between the shells 1 and 4
  const std::uint32_t a = board.source.add_node({-5, 0, 10}), b = board.source.add_node({5, 0, 10});
  board.source.add_shell(5, 6, b, a, 0);
  EXPECT_THAT(board.at(Operation::split, 1, 0.5, -0.5)->shells, ElementsAre(ShellIndex(1)));
  EXPECT_THAT(board.at(Operation::merge, 1, 0.5, -0.5)->shells, UnorderedElementsAre(ShellIndex(1), ShellIndex(4), ShellIndex(6)))
      << "which two of them, the operation says";
}

TEST(ByHand, merge_and_swap_mean_the_nearest_edges_shells_from_wherever_in_the_shell) {
  const Board board;
  for (const Operation operation : {Operation::merge, Operation::swap}) {
    EXPECT_THAT(board.at(operation, 1, 3, -5)->shells, UnorderedElementsAre(ShellIndex(1), ShellIndex(2)));
    EXPECT_THAT(board.at(operation, 1, -3, -5)->shells, UnorderedElementsAre(ShellIndex(1), ShellIndex(0)));
  }
}

TEST(ByHand, a_collapse_means_the_ends_of_the_nearest_edge) {
  const Board board;
  const std::optional<HandTarget> target = board.at(Operation::collapse, 1, 3, -5);
  ASSERT_TRUE(target);
  EXPECT_TRUE(target->shells.empty());
  EXPECT_THAT(target->nodes, UnorderedElementsAre(NodeIndex(2), NodeIndex(6))) << "x 5, y -10 and 0";
}

TEST(ByHand, what_is_no_shell_is_no_target) {
  Board board;
  EXPECT_FALSE(board.at(Operation::split, 999, 0, 0));
  board.source.shell_nodes[1].node[2] = NodeIndex(77777);
  EXPECT_FALSE(board.at(Operation::split, 1, 0, -5));
}

TEST(ViewGlide, brings_the_point_into_the_middle_at_the_scale_wanted_and_ends) {
  stereo::View view;
  view.mm_per_unit = 0.1;
  view.pan_mm = {30, -12};
  view.bounds = {Vec3::Zero(), 500};
  const Vec3 point(120, 40, -30);
  ViewGlide glide;
  EXPECT_EQ(glide.along(view, 5), view) << "nothing is under way";
  glide.begin(point, 2.5, 1000);
  stereo::View now = view;
  double before = (stereo::to_screen(view, point)).head<2>().norm();
  for (std::int64_t t = 1000; t < 1000 + ViewGlide::kGlideNs; t += ViewGlide::kGlideNs / 7) {
    now = glide.along(now, t);
    const double off = stereo::to_screen(now, point).head<2>().norm();
    EXPECT_LE(off, before + 1e-9);
    before = off;
  }
  EXPECT_TRUE(glide.moving());
  now = glide.along(now, 1000 + ViewGlide::kGlideNs);
  EXPECT_FALSE(glide.moving());
  EXPECT_LT(stereo::to_screen(now, point).head<2>().norm(), 1e-6);
  EXPECT_NEAR(now.mm_per_unit, 2.5, 1e-9);
  EXPECT_TRUE(now.rotation.isApprox(view.rotation)) << "from where one looked before";
}

TEST(ViewGlide, a_scale_at_which_an_element_can_be_seen_stays) {
  EXPECT_EQ(toolkit::scale_to_look_at(5, 2, 0.25), 2) << "40 pixels";
  EXPECT_DOUBLE_EQ(toolkit::scale_to_look_at(5, 0.1, 0.25), 48 * 0.25 / 5) << "2 pixels are too few";
  EXPECT_DOUBLE_EQ(toolkit::scale_to_look_at(5, 100, 0.25), 48 * 0.25 / 5) << "2000 are too many";
  EXPECT_EQ(toolkit::scale_to_look_at(0, 3, 0.25), 3);
}

}  // namespace
}  // namespace prismesh::kiosk::tools::mesh_operations
