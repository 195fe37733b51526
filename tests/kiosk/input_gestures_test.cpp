// Gestures of the mouse: clicks, double clicks, drags, and which tool receives them.
#include "kiosk/input/gestures.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace prismesh::kiosk::input {
namespace {

using display::ButtonChanged;
using display::Modifiers;
using display::MouseButton;
using display::PointerMoved;
using mesh::document::SelectMode;

class GesturesTest : public ::testing::Test {
 protected:
  std::vector<Gesture> press(double x, double y, MouseButton button = MouseButton::left, Modifiers modifiers = {},
                             Under under = Under::picture) {
    return gestures_.button(ButtonChanged{button, true, x, y, modifiers, time_ms_}, under);
  }
  std::vector<Gesture> release(double x, double y, MouseButton button = MouseButton::left, Modifiers modifiers = {}) {
    return gestures_.button(ButtonChanged{button, false, x, y, modifiers, time_ms_}, Under::picture);
  }
  std::vector<Gesture> move(double x, double y) { return gestures_.moved(PointerMoved{x, y, {}}); }
  std::vector<Gesture> click(double x, double y, MouseButton button = MouseButton::left, Modifiers modifiers = {}) {
    EXPECT_TRUE(press(x, y, button, modifiers).empty());
    return release(x, y, button, modifiers);
  }
  template <class Kind>
  Kind only(const std::vector<Gesture>& made) {
    EXPECT_EQ(made.size(), 1u);
    if (made.size() != 1 || !std::holds_alternative<Kind>(made[0])) {
      ADD_FAILURE() << "another gesture than expected";
      return {};
    }
    return std::get<Kind>(made[0]);
  }

  Gestures gestures_;
  std::int64_t time_ms_ = 1000;
};

TEST_F(GesturesTest, a_click_selects_the_node_under_it) {
  const auto made = only<NodeClicked>(click(100, 50));
  EXPECT_EQ(made.at, Pixel(100, 50));
  EXPECT_EQ(made.mode, SelectMode::set);
}

TEST_F(GesturesTest, shift_adds_ctrl_removes_and_so_does_the_right_button) {
  EXPECT_EQ(only<NodeClicked>(click(1, 1, MouseButton::left, {true, false, false})).mode, SelectMode::add);
  time_ms_ += 5000;
  EXPECT_EQ(only<NodeClicked>(click(1, 1, MouseButton::left, {false, true, false})).mode, SelectMode::subtract);
  EXPECT_EQ(only<NodeClicked>(click(1, 1, MouseButton::right)).mode, SelectMode::subtract);
}

TEST_F(GesturesTest, a_middle_click_takes_back) { only<TakeBackClicked>(click(9, 9, MouseButton::middle)); }

TEST_F(GesturesTest, a_second_click_soon_after_takes_the_region_at_the_first) {
  only<NodeClicked>(click(100, 50));
  time_ms_ += kDoubleClickMs;
  const auto region = only<RegionClicked>(click(102, 51));
  EXPECT_EQ(region.at, Pixel(100, 50));
  time_ms_ += 10;
  only<NodeClicked>(click(102, 51));  // a third click begins anew
}

TEST_F(GesturesTest, a_late_or_distant_second_click_is_a_click) {
  only<NodeClicked>(click(100, 50));
  time_ms_ += kDoubleClickMs + 1;
  only<NodeClicked>(click(100, 50));
  time_ms_ += 10;
  only<NodeClicked>(click(100 + kClickRadius + 1, 50));
}

TEST_F(GesturesTest, a_double_click_is_one_though_the_first_click_brought_the_handle) {
  only<NodeClicked>(click(100, 50));
  time_ms_ += 150;
  EXPECT_TRUE(press(101, 50, MouseButton::left, {}, Under::move_handle).empty());
  EXPECT_EQ(only<RegionClicked>(release(101, 50)).at, Pixel(100, 50));
}

TEST_F(GesturesTest, a_handle_pulled_right_after_the_click_that_brought_it_is_pulled) {
  only<NodeClicked>(click(100, 50));
  time_ms_ += 150;
  EXPECT_TRUE(press(100, 50, MouseButton::left, {}, Under::lift_handle).empty());
  EXPECT_TRUE(move(102, 50).empty());
  const auto made = move(110, 50);
  ASSERT_EQ(made.size(), 2u);
  ASSERT_TRUE(std::holds_alternative<HandleTaken>(made[0]));
  EXPECT_EQ(std::get<HandleTaken>(made[0]).at, Pixel(100, 50));
  EXPECT_EQ(std::get<HandleTaken>(made[0]).handle, Under::lift_handle);
  EXPECT_EQ(std::get<HandleMoved>(made[1]).at, Pixel(110, 50));
  EXPECT_EQ(only<HandleMoved>(move(120, 50)).at, Pixel(120, 50));
  only<HandleReleased>(release(120, 50));
  time_ms_ += 10;
  only<NodeClicked>(click(120, 50));  // no second click of anything
}

TEST_F(GesturesTest, what_was_cancelled_is_not_half_a_double_click) {
  only<NodeClicked>(click(100, 50));
  gestures_.cancel();
  time_ms_ += 10;
  only<NodeClicked>(click(100, 50));
}

TEST_F(GesturesTest, a_hand_that_trembles_still_clicks) {
  press(100, 50);
  EXPECT_TRUE(move(100 + kClickRadius, 50).empty());
  only<NodeClicked>(release(102, 50));
}

TEST_F(GesturesTest, a_left_drag_draws_an_outline_from_where_the_button_went_down) {
  press(100, 50, MouseButton::left, {true, false, false});
  const auto drawn = only<OutlineDrawn>(move(160, 90));
  EXPECT_EQ(drawn.way.front(), Pixel(100, 50));
  EXPECT_EQ(drawn.way.back(), Pixel(160, 90));
  EXPECT_FALSE(drawn.other_kind);
  move(200, 40);
  const auto done = only<OutlineDone>(release(170, 95));
  EXPECT_EQ(done.way.front(), Pixel(100, 50));
  EXPECT_EQ(done.way.back(), Pixel(170, 95));
  EXPECT_GE(std::count(done.way.begin(), done.way.end(), Pixel(160, 90)), 1) << "its corners stay";
  EXPECT_GE(std::count(done.way.begin(), done.way.end(), Pixel(200, 40)), 1);
  EXPECT_EQ(done.mode, SelectMode::add);
}

TEST_F(GesturesTest, a_slow_picture_loses_no_corner_of_an_outline) {
  press(100, 50);
  gestures_.moved(PointerMoved{200, 60, {}, {{150, 20}, {190, 90}}});
  gestures_.moved(PointerMoved{120, 160, {}, {{220, 130}}});
  const auto done = only<OutlineDone>(release(110, 150));
  for (const Pixel& corner : {Pixel(100, 50), Pixel(150, 20), Pixel(190, 90), Pixel(200, 60), Pixel(220, 130), Pixel(120, 160)})
    EXPECT_GE(std::count(done.way.begin(), done.way.end(), corner), 1) << corner.transpose();
}

TEST_F(GesturesTest, a_trembling_pointer_doesnt_lengthen_the_outline) {
  press(100, 50);
  move(160, 90);
  for (int i = 0; i < 1000; ++i) move(160 + 0.5 * (i % 2), 90);
  EXPECT_LT(only<OutlineDone>(release(160, 90)).way.size(), 6u);
}

TEST_F(GesturesTest, shift_and_ctrl_say_how_an_outline_selects) {
  const auto mode_with = [&](Modifiers modifiers) {
    press(0, 0, MouseButton::left, modifiers);
    move(50, 50);
    return only<OutlineDone>(release(90, 0)).mode;
  };
  EXPECT_EQ(mode_with({}), SelectMode::set);
  EXPECT_EQ(mode_with({true, false, false}), SelectMode::add);
  EXPECT_EQ(mode_with({false, true, false}), SelectMode::subtract);
  EXPECT_EQ(mode_with({true, true, false}), SelectMode::intersect);
}

TEST_F(GesturesTest, alt_draws_the_other_kind_of_outline) {
  press(0, 0, MouseButton::left, {false, false, true});
  EXPECT_TRUE(only<OutlineDrawn>(move(20, 0)).other_kind);
  EXPECT_TRUE(only<OutlineDone>(release(20, 20)).other_kind);
}

TEST_F(GesturesTest, the_disk_is_taken_by_a_drag_and_lets_clicks_through) {
  EXPECT_TRUE(press(100, 50, MouseButton::left, {}, Under::slide_handle).empty());
  only<NodeClicked>(release(100, 50));
  time_ms_ += 5000;
  press(100, 50, MouseButton::left, {}, Under::slide_handle);
  const auto made = move(120, 50);
  ASSERT_EQ(made.size(), 2u);
  EXPECT_EQ(std::get<HandleTaken>(made[0]).handle, Under::slide_handle);
  only<HandleReleased>(release(120, 50));
  press(100, 50, MouseButton::left, {true, false, false}, Under::slide_handle);
  only<OutlineDrawn>(move(120, 50));  // with Shift something is added
}

TEST_F(GesturesTest, a_right_drag_orbits_by_what_the_pointer_moved_and_selects_nothing) {
  press(100, 50, MouseButton::right);
  const auto first = only<Orbited>(move(110, 53));
  EXPECT_EQ(first.dx, 10);
  EXPECT_EQ(first.dy, 3);
  const auto second = only<Orbited>(move(111, 53));
  EXPECT_EQ(second.dx, 1);
  EXPECT_EQ(second.from, Pixel(100, 50));
  EXPECT_TRUE(release(111, 53, MouseButton::right).empty());
}

TEST_F(GesturesTest, a_middle_drag_pans_and_so_does_alt_with_the_right_button) {
  press(0, 0, MouseButton::middle);
  only<Panned>(move(20, 0));
  release(20, 0, MouseButton::middle);
  press(0, 0, MouseButton::right, {false, false, true});
  only<Panned>(move(20, 0));
}

TEST_F(GesturesTest, a_press_on_the_handle_takes_it_at_once) {
  const auto taken = only<HandleTaken>(press(100, 50, MouseButton::left, {}, Under::lift_handle));
  EXPECT_EQ(taken.handle, Under::lift_handle);
  only<HandleMoved>(move(101, 50));  // no trembling allowance: the hand pulls
  EXPECT_EQ(only<HandleReleased>(release(120, 40)).at, Pixel(120, 40));
}

TEST_F(GesturesTest, a_press_on_a_panel_is_the_panels_until_it_is_released) {
  EXPECT_TRUE(press(10, 10, MouseButton::left, {}, Under::panel).empty());
  EXPECT_TRUE(move(500, 500).empty());
  EXPECT_TRUE(release(500, 500).empty());
  EXPECT_TRUE(gestures_.wheel(display::WheelTurned{1, 10, 10, {}}, Under::panel).empty());
  only<Zoomed>(gestures_.wheel(display::WheelTurned{1, 10, 10, {}}, Under::picture));
}

TEST_F(GesturesTest, another_button_moves_the_view_while_a_handle_waits) {
  press(100, 50, MouseButton::left, {}, Under::lift_handle);
  only<HandleMoved>(move(120, 50));
  EXPECT_TRUE(press(120, 50, MouseButton::right).empty());
  const auto orbited = only<Orbited>(move(130, 55));
  EXPECT_EQ(orbited.dx, 10);
  EXPECT_EQ(orbited.at, Pixel(130, 55));
  EXPECT_TRUE(release(130, 55, MouseButton::right).empty());
  only<HandleMoved>(move(140, 55));
  only<HandleReleased>(release(140, 55));
}

TEST_F(GesturesTest, the_view_moves_in_the_middle_of_an_outline_without_a_trace_in_it) {
  press(100, 50);
  move(160, 90);
  press(160, 90, MouseButton::middle);
  only<Panned>(move(400, 400));
  release(400, 400, MouseButton::middle);
  only<Zoomed>(gestures_.wheel(display::WheelTurned{1, 400, 400, {}}, Under::picture));
  move(200, 30);
  const auto done = only<OutlineDone>(release(200, 30));
  for (const Pixel& at : done.way) EXPECT_LT(at.y(), 100) << "the way of the view isn't the outline's";
}

TEST_F(GesturesTest, letting_the_first_button_go_ends_what_it_began_though_the_view_moves) {
  press(100, 50, MouseButton::left, {}, Under::move_handle);
  press(100, 50, MouseButton::right);
  move(130, 55);
  only<HandleReleased>(release(130, 55));
  EXPECT_TRUE(move(150, 55).empty());
  EXPECT_TRUE(release(150, 55, MouseButton::right).empty());
  only<NodeClicked>(click(130, 50));
}

TEST_F(GesturesTest, cancelling_makes_the_release_do_nothing) {
  press(100, 50, MouseButton::left, {}, Under::lift_handle);
  move(120, 50);
  EXPECT_TRUE(gestures_.cancel());
  EXPECT_TRUE(move(130, 50).empty());
  EXPECT_TRUE(release(130, 50).empty());
  only<NodeClicked>(click(130, 50));
  EXPECT_FALSE(gestures_.cancel());
}

}  // namespace
}  // namespace prismesh::kiosk::input
