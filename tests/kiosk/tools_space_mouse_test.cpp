// A SpaceMouse in the kiosk's hand: where view and selection go, and what its buttons do; in virtual time.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "kiosk/tools/space_mouse/space_mouse_hand.h"

namespace prismesh::kiosk::tools::space_mouse {
namespace {

using Act = SpaceMouseHand::Act;
using Mode = SpaceMouseHand::Mode;

constexpr double kHeightMm = 200;
constexpr std::int64_t kMs = 1'000'000;

stereo::View view_for_space_mouse() {
  stereo::View view;
  view.pivot = {100, 20, -7};
  view.rotation = *stereo::named_rotation("iso");
  view.mm_per_unit = 3;
  view.middle_mm = {12, -5};
  view.depth_strength = 1;
  view.comfort = {1e6, 1e6};  // depth isn't compressed
  view.bounds = {{90, 10, 0}, 60};
  return view;
}

enum CapAxis { kRight, kTowardUser, kDown };
SpaceMouseMotion shifted(CapAxis axis, double by = 1) {
  SpaceMouseMotion motion;
  motion.shift[axis] = by;
  return motion;
}
SpaceMouseMotion turned(CapAxis axis, double by = 1) {
  SpaceMouseMotion motion;
  motion.turn[axis] = by;
  return motion;
}

// --- the view ---

TEST(SpaceMouseViewTest, the_model_goes_where_the_cap_is_pushed) {
  const stereo::View view = view_for_space_mouse();
  const auto moved = [&](const SpaceMouseMotion& motion) -> Vec3 {
    return stereo::to_screen(steered(view, motion, 0.1, kHeightMm), view.pivot) - stereo::to_screen(view, view.pivot);
  };
  EXPECT_LT((moved(shifted(kRight)) - Vec3(20, 0, 0)).norm(), 1e-6) << "a tenth of a second at a height a second";
  EXPECT_LT((moved(shifted(kDown)) - Vec3(0, -20, 0)).norm(), 1e-6);
  EXPECT_LT((moved(shifted(kDown, -0.5)) - Vec3(0, 10, 0)).norm(), 1e-6);
}

TEST(SpaceMouseViewTest, it_grows_about_the_views_middle_as_the_cap_is_pulled_toward_the_user) {
  const stereo::View view = view_for_space_mouse();
  const stereo::View nearer = steered(view, shifted(kTowardUser), 0.5, kHeightMm);
  EXPECT_NEAR(nearer.mm_per_unit, 3 * std::exp(0.6), 1e-9);
  const Vec3 middle = stereo::to_deck(view, Vec3(12, -5, 0));
  const Vec3 stays = stereo::to_screen(nearer, middle);
  EXPECT_NEAR(stays.x(), 12, 1e-6);
  EXPECT_NEAR(stays.y(), -5, 1e-6);
  EXPECT_NEAR(steered(nearer, shifted(kTowardUser, -1), 0.5, kHeightMm).mm_per_unit, 3, 1e-9) << "pushed away it shrinks as fast";
}

TEST(SpaceMouseViewTest, it_turns_as_the_cap_does) {
  const stereo::View view = view_for_space_mouse();
  const auto goes = [&](const SpaceMouseMotion& motion, const Vec3& from_pivot_on_screen) -> Vec3 {
    const Vec3 point = view.pivot + view.rotation.conjugate() * from_pivot_on_screen;
    return stereo::to_screen(steered(view, motion, 0.01, kHeightMm), point) - stereo::to_screen(view, point);
  };
  const Vec3 near_side(0, 0, 10), top(0, 10, 0);
  // About the axis to the right, right-handed: the top comes toward the user, the near side goes down.
  EXPECT_GT(goes(turned(kRight), top).z(), 0.1);
  EXPECT_LT(goes(turned(kRight), near_side).y(), -0.1);
  // About the axis down: clockwise as seen from above, so the near side goes to the left.
  EXPECT_LT(goes(turned(kDown), near_side).x(), -0.1);
  // About the axis toward the user: the top goes to the left.
  EXPECT_LT(goes(turned(kTowardUser), top).x(), -0.1);
  const stereo::View orbited = stereo::orbit(view, -0.01 * kTurnRadians, 0);
  EXPECT_LT(steered(view, turned(kDown), 0.01, kHeightMm).rotation.angularDistance(orbited.rotation), 1e-9) << "as the mouse orbits";
  EXPECT_NEAR(steered(view, turned(kDown), 1, kHeightMm).rotation.angularDistance(view.rotation), kTurnRadians, 1e-9);
}

TEST(SpaceMouseViewTest, the_way_depends_on_the_time_and_not_on_the_number_of_pictures) {
  SpaceMouseMotion motion = shifted(kRight, 0.7);
  motion.turn = {0.3, -0.2, 0.5};
  motion.shift[kTowardUser] = 0.4;
  stereo::View few = view_for_space_mouse(), many = few;
  for (int i = 0; i < 5; ++i) few = steered(few, motion, 0.1, kHeightMm);
  for (int i = 0; i < 100; ++i) many = steered(many, motion, 0.005, kHeightMm);
  EXPECT_LT(few.rotation.angularDistance(many.rotation), 1e-9);
  EXPECT_NEAR(few.mm_per_unit, many.mm_per_unit, 1e-9);
  EXPECT_LT((few.pan_mm - many.pan_mm).norm(), 6) << "of 70 mm: zoom and pan within a step don't commute";
}

TEST(SpaceMouseMoveTest, the_selection_goes_as_the_screen_shows_it) {
  const stereo::View view = view_for_space_mouse();
  EXPECT_LT((view.rotation * carried(view, shifted(kRight), 1, kHeightMm) - Vec3(50 / 3.0, 0, 0)).norm(), 1e-9);
  EXPECT_LT((view.rotation * carried(view, shifted(kDown), 1, kHeightMm) - Vec3(0, -50 / 3.0, 0)).norm(), 1e-9);
  EXPECT_LT((view.rotation * carried(view, shifted(kTowardUser), 1, kHeightMm) - Vec3(0, 0, 50 / 3.0)).norm(), 1e-9);
  EXPECT_EQ(carried(view, turned(kRight), 1, kHeightMm).norm(), 0);
}

// --- the hand ---

class SpaceMouseHandTest : public ::testing::Test {
 protected:
  SpaceMouseHand::Answer after(std::int64_t ms, const SpaceMouseMotion& motion, std::uint64_t pressed = 0, bool there = true) {
    now_ns_ += ms * kMs;
    SpaceMouseHand::Answer answer = hand_.turn({motion, pressed, there}, view_, kHeightMm, now_ns_);
    if (answer.act == Act::steer) view_ = answer.view;
    return answer;
  }
  /// In the mode that moves the selection, holding it, with the cap deflected.
  void take() {
    after(10, {}, kSwitch);
    ASSERT_EQ(after(10, push_).act, Act::take);
    hand_.hold();
  }
  static constexpr std::uint64_t kFit = 1, kSwitch = 2;
  const SpaceMouseMotion push_ = shifted(kRight);
  stereo::View view_ = view_for_space_mouse();
  SpaceMouseHand hand_;
  std::int64_t now_ns_ = 5'000'000'000;
};

TEST_F(SpaceMouseHandTest, a_motion_begins_softly_however_long_ago_the_last_turn_was) {
  const double before = view_.pan_mm.x();
  EXPECT_EQ(after(900, push_).act, Act::steer);
  EXPECT_EQ(view_.pan_mm.x(), before);
  after(10, push_);
  EXPECT_NEAR(view_.pan_mm.x(), before + 2, 1e-9);
}

TEST_F(SpaceMouseHandTest, a_picture_that_took_long_makes_no_larger_step_than_a_tenth_of_a_second) {
  after(10, push_);
  const double before = view_.pan_mm.x();
  after(2000, push_);
  EXPECT_NEAR(view_.pan_mm.x(), before + 20, 1e-9);
}

TEST_F(SpaceMouseHandTest, its_buttons_fit_and_switch) {
  EXPECT_TRUE(after(10, {}, kFit).fits);
  EXPECT_EQ(hand_.mode(), Mode::view);
  EXPECT_FALSE(after(10, {}, kSwitch).fits);
  EXPECT_EQ(hand_.mode(), Mode::move);
  EXPECT_TRUE(after(10, {}, kFit).fits) << "nothing is held";
  after(10, {}, kSwitch);
  EXPECT_EQ(hand_.mode(), Mode::view);
  EXPECT_FALSE(after(10, {}, 4).fits) << "the third button does nothing";
}

TEST_F(SpaceMouseHandTest, it_carries_what_it_holds_and_keeps_it_when_it_has_rested) {
  take();
  EXPECT_EQ(hand_.by().norm(), 0);
  EXPECT_EQ(after(100, push_).act, Act::pull);
  EXPECT_LT((view_.rotation * hand_.by() - Vec3(5 / 3.0, 0, 0)).norm(), 1e-9);
  const Vec3 by = hand_.by();
  EXPECT_EQ(after(490, {}).act, Act::none);
  EXPECT_EQ(after(9, {}).act, Act::none);
  EXPECT_TRUE(hand_.holds());
  EXPECT_EQ(after(1, {}).act, Act::commit);
  EXPECT_FALSE(hand_.holds());
  EXPECT_EQ(hand_.by(), by);
  EXPECT_EQ(after(10, push_).act, Act::take) << "the next move";
}

TEST_F(SpaceMouseHandTest, a_short_rest_goes_on_with_the_same_move) {
  take();
  after(100, push_);
  after(300, {});
  EXPECT_EQ(after(100, push_).act, Act::pull);
  EXPECT_EQ(after(400, {}).act, Act::none) << "the rest counts from the last deflection";
}

TEST_F(SpaceMouseHandTest, a_button_keeps_it_at_once_and_the_cap_must_rest_before_the_next_move) {
  take();
  after(100, push_);
  const auto pressed = after(10, push_, kFit);
  EXPECT_EQ(pressed.act, Act::commit);
  EXPECT_FALSE(pressed.fits);
  EXPECT_EQ(after(10, push_).act, Act::none);
  EXPECT_EQ(after(10, {}).act, Act::none);
  EXPECT_EQ(after(10, push_).act, Act::take);
}

TEST_F(SpaceMouseHandTest, the_switch_keeps_it_and_the_view_stays_until_the_cap_has_rested) {
  take();
  after(100, push_);
  EXPECT_EQ(after(10, push_, kSwitch).act, Act::commit);
  EXPECT_EQ(hand_.mode(), Mode::view);
  EXPECT_EQ(after(10, push_).act, Act::none);
  after(10, {});
  EXPECT_EQ(after(10, push_).act, Act::steer);
}

TEST_F(SpaceMouseHandTest, a_device_that_goes_gives_back_what_it_held) {
  take();
  after(100, push_);
  EXPECT_EQ(after(10, {}, 0, false).act, Act::cancel);
  EXPECT_FALSE(hand_.holds());
  EXPECT_EQ(after(10, {}, 0, false).act, Act::none);
  EXPECT_EQ(after(10, push_).act, Act::take) << "another one is plugged in; it still moves the selection";
}

TEST_F(SpaceMouseHandTest, what_it_may_not_take_is_asked_for_once) {
  after(10, {}, kSwitch);
  EXPECT_EQ(after(10, push_).act, Act::take);
  EXPECT_EQ(after(10, push_).act, Act::none);
  EXPECT_EQ(after(10, {}).act, Act::none);
  EXPECT_EQ(after(10, push_).act, Act::take);
}

TEST_F(SpaceMouseHandTest, what_was_taken_back_isnt_taken_again_before_the_cap_has_rested) {
  take();
  after(100, push_);
  hand_.let_go();  // Esc
  EXPECT_EQ(after(10, push_).act, Act::none);
  after(10, {});
  EXPECT_EQ(after(10, push_).act, Act::take);
}

}  // namespace
}  // namespace prismesh::kiosk::tools::space_mouse
