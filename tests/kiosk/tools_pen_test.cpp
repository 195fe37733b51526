// The haptic pen in the kiosk: where the model is in its space, what its buttons do, what it touches; in virtual time.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "kiosk/stereo/frustum.h"
#include "kiosk/tools/pen/pen_hand.h"
#include "kiosk/tools/pen/pen_section.h"
#include "kiosk/tools/pen/touched.h"
#include "tests/kiosk/test_source.h"

namespace prismesh::kiosk::tools::pen {
namespace {

using Act = PenHand::Act;
using ipc::PenStage;

stereo::View a_view() {
  stereo::View view;
  view.pivot = {100, 20, -7};
  view.rotation = *stereo::named_rotation("iso");
  view.mm_per_unit = 3;
  view.bounds = {{90, 10, 0}, 60};
  return view;
}

// --- the place in the view ---

TEST(PenPlaceTest, the_hands_axes_are_the_screens_and_its_lengths_are_the_settings) {
  const stereo::View view = a_view();
  const Placement place = place_in_view(view, 0.5);
  const Vec3 node(103, 15, 4), right = node + view.rotation.conjugate() * Vec3(10, 0, 0);
  EXPECT_LT((place.to_pen(right) - place.to_pen(node) - Vec3(5, 0, 0)).norm(), 1e-9) << "ten lengths of the deck at half a mm each";
  const Vec3 nearer = node + view.rotation.conjugate() * Vec3(0, 0, 10);
  EXPECT_LT((place.to_pen(nearer) - place.to_pen(node) - Vec3(0, 0, 5)).norm(), 1e-9) << "depth isn't compressed for the hand";
  EXPECT_GT(stereo::to_screen(view, nearer).z(), stereo::to_screen(view, node).z());
}

TEST(PenPlaceTest, the_middle_of_the_pens_space_is_in_the_middle_of_the_screen_however_the_view_was_moved) {
  stereo::View view = a_view();
  EXPECT_LT(place_in_view(view, 2).to_pen(view.pivot).norm(), 1e-9) << "the pivot is there";
  view = stereo::zoom(stereo::orbit(stereo::pan(view, {35, -12}), 0.4, -0.2), 1.7, {10, 20});
  view.before_mm = 14;
  const Placement place = place_in_view(view, 2);
  EXPECT_LT(stereo::to_screen(view, place.to_model(Vec3::Zero())).norm(), 1e-9);
  EXPECT_LT((place.turn * place.turn.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_GT(place.turn.determinant(), 0);
}

TEST(PenPlaceTest, another_pivot_moves_nothing) {
  const stereo::View view = a_view(), other = stereo::with_pivot(view, {80, 33, 12});
  const Vec3 node(103, 15, 4);
  EXPECT_LT((place_in_view(other, 2).to_pen(node) - place_in_view(view, 2).to_pen(node)).norm(), 1e-9);
}

TEST(PenPlaceTest, modeld_is_told_the_same_map) {
  const Placement place = place_in_view(a_view(), 0.25);
  const link::PenPlace told = told_place(place, 3);
  const Eigen::Quaterniond turn(told.turn[0], told.turn[1], told.turn[2], told.turn[3]);
  const Vec3 node(103, 15, 4);
  EXPECT_NEAR(turn.norm(), 1, 1e-12);
  EXPECT_LT((told.scale * (turn * node) + Vec3(told.shift_mm.data()) - place.to_pen(node)).norm(), 1e-9);
  EXPECT_NE(told, told_place(place, 4)) << "of another document";
}

TEST(PenPlaceTest, a_left_hand_mirrors_where_the_shaft_points_and_nothing_else) {
  const PenPose pose;
  const Vec3 right = shaft_of(pose, false), left = shaft_of(pose, true);
  EXPECT_GT(right.x(), 0.2);
  EXPECT_EQ(left, Vec3(-right.x(), right.y(), right.z()));
  EXPECT_NEAR(right.norm(), 1, 1e-12);
  PenPose turned;
  turned.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitX()));
  EXPECT_LT((shaft_of(turned, true) - Vec3(0, -1, 0)).norm(), 1e-12) << "what the pen measures is never mirrored";
}

TEST(PenPlaceTest, the_picture_reaches_as_far_as_the_pen) {
  const stereo::DepthRange range{500, 700};
  const Vec3 eye(0, 0, 650);
  EXPECT_LT(stereo::with_depth(range, eye, 250).near_mm, 400);
  EXPECT_EQ(stereo::with_depth(range, eye, 250).far_mm, 700);
  EXPECT_GT(stereo::with_depth(range, eye, -400).far_mm, 1050);
  EXPECT_EQ(stereo::with_depth(range, eye, NAN).near_mm, 500);
  EXPECT_GT(stereo::with_depth(range, eye, 5000).near_mm, 0) << "behind the eye";
}

// --- what the page says ---

constexpr std::int64_t kNow = 1'000'000'000'000;

ipc::PenState a_state(PenStage stage) {
  ipc::PenState state;
  state.stage = stage;
  state.time_ns = state.measured_ns = kNow - 1'000'000;
  state.position_mm = {1, 2, 3};
  state.buttons = 3;
  return state;
}

TEST(PenPoseTest, only_a_pen_that_is_there_and_well_can_hold_something) {
  for (const PenStage stage : {PenStage::disarmed, PenStage::armed}) EXPECT_TRUE(pose_of(a_state(stage), kNow).usable) << name(stage);
  for (const PenStage stage : {PenStage::none, PenStage::absent, PenStage::setting_up, PenStage::homing, PenStage::latched})
    EXPECT_FALSE(pose_of(a_state(stage), kNow).usable) << name(stage);
  EXPECT_TRUE(can_be_shown(a_state(PenStage::latched), kNow));
  EXPECT_FALSE(can_be_shown(a_state(PenStage::homing), kNow));
}

TEST(PenPoseTest, old_and_impossible_poses_count_as_none) {
  EXPECT_FALSE(pose_of(a_state(PenStage::armed), kNow + kSilenceNs).usable);
  ipc::PenState state = a_state(PenStage::armed);
  state.measured_ns = 0;
  EXPECT_FALSE(pose_of(state, kNow).usable);
  state = a_state(PenStage::armed);
  state.position_mm[1] = INFINITY;
  EXPECT_FALSE(pose_of(state, kNow).usable);
  state = a_state(PenStage::armed);
  state.has_orientation = true;
  state.orientation = {NAN, 0, 0, 0};
  EXPECT_FALSE(pose_of(state, kNow).orientation);
  state.orientation = {0, 0, 0, 0};
  EXPECT_FALSE(pose_of(state, kNow).orientation);
}

TEST(PenPoseTest, has_position_buttons_and_orientation) {
  ipc::PenState state = a_state(PenStage::armed);
  state.buttons = 2;
  PenPose pose = pose_of(state, kNow);
  EXPECT_EQ(pose.position_mm, Vec3(1, 2, 3));
  EXPECT_FALSE(pose.grab);
  EXPECT_TRUE(pose.clutch);
  EXPECT_FALSE(pose.orientation);
  state.buttons = 1;
  state.has_orientation = true;
  state.orientation = {0, 2, 0, 0};
  pose = pose_of(state, kNow);
  EXPECT_TRUE(pose.grab);
  EXPECT_FALSE(pose.clutch);
  EXPECT_NEAR(pose.orientation->x(), 1, 1e-12);
}

// --- the buttons ---

/// The view turns the deck's x to the hand's y; two millimetres of the pen are one length of the deck.
Placement turned_view() {
  Placement view;
  view.turn = Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitZ()).toRotationMatrix();
  view.scale = 2;
  return view;
}

class PenHandTest : public ::testing::Test {
 protected:
  static PenPose at(const Vec3& mm, bool grab = false, bool clutch = false) {
    PenPose pose;
    pose.usable = true;
    pose.position_mm = mm;
    pose.grab = grab;
    pose.clutch = clutch;
    return pose;
  }
  static PenPose rolled(const Vec3& mm, double degrees, const Vec3& about) {
    PenPose pose = at(mm, true);
    pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, about));
    return pose;
  }
  void press(const Vec3& mm) {
    hand_.turn(at(mm), view_);
    ASSERT_EQ(hand_.turn(at(mm, true), view_), Act::press);
    hand_.hold(Vec3::UnitZ());
    ASSERT_TRUE(hand_.holds());
  }
  void expect_pulled(const Vec3& by, double degrees = 0) const {
    EXPECT_LT((hand_.pulled().by - by).norm(), 1e-9) << hand_.pulled().by.transpose();
    EXPECT_NEAR(hand_.pulled().degrees, degrees, 1e-9);
  }

  Placement view_ = turned_view();
  PenHand hand_;
};

TEST_F(PenHandTest, what_is_held_goes_with_the_pen_and_stays_where_it_is_released) {
  press({5, 5, 5});
  expect_pulled(Vec3::Zero());
  EXPECT_EQ(hand_.turn(at({5, 9, 5}, true), view_), Act::pull);
  expect_pulled({2, 0, 0});
  EXPECT_EQ(hand_.turn(at({5, 9, 11}), view_), Act::release);
  expect_pulled({2, 0, 3});
  EXPECT_FALSE(hand_.holds());
  EXPECT_EQ(hand_.turn(at({9, 9, 9}), view_), Act::none);
  expect_pulled({2, 0, 3});
}

TEST_F(PenHandTest, a_trembling_hand_pulls_nothing) {
  press({5, 5, 5});
  hand_.turn(at({5.3, 5, 5}, true), view_);
  hand_.turn(at({5, 5.2, 4.7}, true), view_);
  expect_pulled(Vec3::Zero());
  hand_.turn(at({5, 5, 5.6}, true), view_);
  expect_pulled({0, 0, 0.3});
  hand_.turn(at({5, 5, 5.2}, true), view_);
  expect_pulled({0, 0, 0.1});
}

TEST_F(PenHandTest, a_press_that_took_nothing_takes_nothing_until_the_button_was_released) {
  hand_.turn(at({0, 0, 0}), view_);
  EXPECT_EQ(hand_.turn(at({0, 0, 0}, true), view_), Act::press);
  EXPECT_EQ(hand_.turn(at({4, 0, 0}, true), view_), Act::none);
  EXPECT_EQ(hand_.turn(at({4, 0, 0}), view_), Act::none);
  EXPECT_EQ(hand_.turn(at({4, 0, 0}, true), view_), Act::press);
}

TEST_F(PenHandTest, what_esc_gave_up_is_not_taken_again_by_the_same_press) {
  press({5, 5, 5});
  hand_.turn(at({5, 9, 5}, true), view_);
  hand_.let_go();
  EXPECT_EQ(hand_.turn(at({5, 12, 5}, true), view_), Act::none);
  EXPECT_EQ(hand_.turn(at({5, 12, 5}), view_), Act::none) << "no release: there is nothing to keep";
}

TEST_F(PenHandTest, a_pen_that_goes_or_latches_takes_back_what_it_held) {
  press({5, 5, 5});
  hand_.turn(at({5, 9, 5}, true), view_);
  EXPECT_EQ(hand_.turn(PenPose{}, view_), Act::cancel);
  EXPECT_FALSE(hand_.holds());
  EXPECT_EQ(hand_.turn(PenPose{}, view_), Act::none);
  EXPECT_EQ(hand_.turn(at({5, 9, 5}, true), view_), Act::none) << "the button was down when the pen came back";
  hand_.turn(at({5, 9, 5}), view_);
  EXPECT_EQ(hand_.turn(at({5, 9, 5}, true), view_), Act::press);
}

TEST_F(PenHandTest, the_death_of_its_process_takes_back_what_it_held) {
  EXPECT_FALSE(hand_.leave());
  press({5, 5, 5});
  EXPECT_TRUE(hand_.leave());
  EXPECT_FALSE(hand_.leave());
  hand_.hold(Vec3::UnitZ());
  EXPECT_FALSE(hand_.holds()) << "there is no pen";
}

TEST_F(PenHandTest, the_clutch_moves_the_space_and_not_the_model) {
  hand_.turn(at({0, 0, 0}), view_);
  const Vec3 under = hand_.place().to_model(Vec3(0, 0, 0));
  hand_.turn(at({0, 0, 0}, false, true), view_);
  hand_.turn(at({10, 0, 0}, false, true), view_);
  hand_.turn(at({10, 20, 0}, false, true), view_);
  EXPECT_LT((hand_.place().to_model(Vec3(10, 20, 0)) - under).norm(), 1e-12) << "the pen stands where it stood in the model";
  EXPECT_EQ(hand_.turn(at({10, 20, 0}, true, true), view_), Act::none) << "nothing is taken meanwhile";
  hand_.turn(at({30, 20, 0}), view_);
  EXPECT_GT((hand_.place().to_model(Vec3(30, 20, 0)) - under).norm(), 9);
  EXPECT_LT((hand_.place().to_model(Vec3(10, 20, 0)) - under).norm(), 1e-12) << "it stays so";
  hand_.forget_clutch();
  hand_.turn(at({0, 0, 0}), view_);
  EXPECT_LT((hand_.place().to_model(Vec3(0, 0, 0)) - under).norm(), 1e-12);
}

TEST_F(PenHandTest, a_clutch_during_a_pull_leaves_what_is_held_where_it_is) {
  press({0, 0, 0});
  hand_.turn(at({0, 4, 0}, true), view_);
  expect_pulled({2, 0, 0});
  hand_.turn(at({0, 4, 0}, true, true), view_);
  hand_.turn(at({0, -50, 0}, true, true), view_);
  expect_pulled({2, 0, 0});
  hand_.turn(at({0, -50, 0}, true), view_);
  hand_.turn(at({0, -44, 0}, true), view_);
  expect_pulled({5, 0, 0});
}

TEST_F(PenHandTest, a_turn_of_the_view_during_a_pull_leaves_what_is_held_where_it_is) {
  press({0, 0, 0});
  hand_.turn(at({0, 4, 0}, true), view_);
  view_ = {};
  hand_.turn(at({0, 4, 0}, true), view_);
  expect_pulled({2, 0, 0});
  hand_.turn(at({0, 4, 7}, true), view_);
  expect_pulled({2, 0, 7});
}

TEST_F(PenHandTest, a_roll_about_the_shaft_turns_what_is_held_more_than_once_round) {
  hand_.turn(at({0, 0, 0}), view_);
  hand_.turn(rolled({0, 0, 0}, 10, Vec3::UnitZ()), view_);
  hand_.hold(Vec3::UnitZ());
  for (const double degrees : {12.0, 100.0, 190.0, 300.0, 410.0}) hand_.turn(rolled({0, 0, 0}, degrees, Vec3::UnitZ()), view_);
  expect_pulled(Vec3::Zero(), 400);
  view_ = {};
  hand_.turn(rolled({0, 0, 0}, 410, Vec3::UnitZ()), view_);
  hand_.turn(rolled({0, 0, 0}, 380, Vec3::UnitZ()), view_);
  expect_pulled(Vec3::Zero(), 370);
}

TEST_F(PenHandTest, a_tilt_of_the_shaft_turns_nothing) {
  hand_.turn(at({0, 0, 0}), view_);
  hand_.turn(rolled({0, 0, 0}, 0, Vec3::UnitX()), view_);
  hand_.hold(Vec3::UnitZ());
  hand_.turn(rolled({0, 0, 2}, 40, Vec3::UnitX()), view_);
  expect_pulled({0, 0, 1}, 0);
}

// --- what is touched ---

/// Two quads of side 10 in the plane z = 0 and a triangle above the first; the second quad's part is hidden.
test::TestSource two_quads() {
  test::TestSource source;
  for (const double x : {0.0, 10.0, 20.0})
    for (const double y : {0.0, 10.0}) source.add_node({x, y, 0});
  source.add_shell(0, 2, 3, 1, 0);
  source.add_shell(2, 4, 5, 3, 1);
  const std::uint32_t top = source.add_node({5, 5, 9});
  source.add_shell(0, 2, top, top, 0);
  source.add_node({0.2, 0.2, 0});  // no shell has it
  source.hidden = {false, true};
  return source;
}

TEST(PenTouchTest, a_touched_shell_counts_only_where_it_is) {
  const test::TestSource source = two_quads();
  EXPECT_EQ(touched_shell(source, 0, {3, 3, 1}, 1.5), mesh::ShellIndex(0));
  EXPECT_EQ(touched_shell(source, 0, {8, 2, -1}, 1.5), mesh::ShellIndex(0)) << "in its other half";
  EXPECT_EQ(touched_shell(source, 0, {2, 8, -1}, 1.5), mesh::ShellIndex(0));
  EXPECT_FALSE(touched_shell(source, 1, {3, 3, 1}, 1.5)) << "of another state of the model";
  EXPECT_FALSE(touched_shell(source, 0, {3, 3, 2}, 1.5));
  for (const std::int32_t element : {-1, 3, 1 << 30}) EXPECT_FALSE(touched_shell(source, element, {3, 3, 1}, 1.5)) << element;
  test::TestSource broken = two_quads();
  broken.shell_nodes[0].node[2] = mesh::NodeIndex(99);
  EXPECT_FALSE(touched_shell(broken, 0, {3, 3, 1}, 1.5));
}

TEST(PenTouchTest, its_nearest_corner_would_be_taken) {
  const test::TestSource source = two_quads();
  EXPECT_EQ(nearest_corner(source, mesh::ShellIndex(0), {7, 1, 0}), mesh::NodeIndex(2));
  EXPECT_EQ(nearest_corner(source, mesh::ShellIndex(0), {1, 7, 0}), mesh::NodeIndex(1));
  EXPECT_EQ(edges_of(source, mesh::ShellIndex(0)).size(), 4u);
  EXPECT_EQ(edges_of(source, mesh::ShellIndex(2)).size(), 3u) << "a triangle";
}

TEST(PenTouchTest, the_nearest_node_is_one_of_a_visible_shell_within_reach) {
  const test::TestSource source = two_quads();
  EXPECT_EQ(nearest_node(source, {0.3, 0.3, 0}, 2), mesh::NodeIndex(0)) << "the nearer one has no shell";
  EXPECT_EQ(nearest_node(source, {11, 1, 1}, 2), mesh::NodeIndex(2));
  EXPECT_FALSE(nearest_node(source, {20, 0, 0}, 2)) << "hidden";
  EXPECT_FALSE(nearest_node(source, {5, 2, 0}, 2));
}

// --- in words ---

TEST(PenSectionTest, says_what_to_do_next) {
  ipc::PenInfo pen;
  pen.state = "disarmed";
  EXPECT_EQ(advice_for(pen, false), "Ctrl+Shift+P arms it: then it pushes back.");
  pen.state = "armed";
  EXPECT_NE(advice_for(pen, false).find("Ctrl+Shift+P disarms it"), std::string::npos);
  EXPECT_NE(advice_for(pen, true).find("Esc takes it back"), std::string::npos);
  pen.state = "latched";
  pen.trouble = "no pose came for more than 10 ms, so its force is zero until it is armed again";
  EXPECT_EQ(advice_for(pen, false), "no pose came for more than 10 ms, so its force is zero until it is armed again (Ctrl+Shift+P)");
  pen.state = "absent";
  pen.trouble = "its line can't be opened";
  EXPECT_EQ(advice_for(pen, false), "its line can't be opened");
}

}  // namespace
}  // namespace prismesh::kiosk::tools::pen
