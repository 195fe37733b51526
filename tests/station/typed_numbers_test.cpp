// Numbers that are typed for the handle: one number goes only where the box says, and nothing of another deck is left over.
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/station/station_test_case.h"

namespace prismesh::test {
namespace {

class TypedNumbersTest : public StationTestCase {
 protected:
  void select() {
    station_->key("e");
    station_->type("1200-1260");
    station_->key("Return");
    ASSERT_TRUE(station_->wait_for_selection(61));
  }
  /// Types into the number's box, which is open already or is opened; what the kiosk took then.
  std::string enter(const std::string& numbers, bool opens = true) {
    station_->key(opens ? "n" : "ctrl+a");
    station_->type(numbers);
    station_->key("Return");
    return numbers;
  }
};

TEST_F(TypedNumbersTest, one_number_for_a_slide_needs_a_direction_of_this_deck) {
  station_->start_kiosk();
  select();
  station_->key("shift+n");  // slide
  station_->kiosk().skip_lines();
  enter("5");
  station_->show_people("slide_without_direction");
  enter("1 0 0", false);
  EXPECT_EQ(station_->kiosk().wait_for("typed "), "typed Slide 1 0 0") << "5 has nowhere to go";
  ASSERT_FALSE(station_->kiosk().wait_for("drag committed").empty());
  station_->key("n");
  station_->type("2");
  ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
  station_->show_people("slide_along_the_last");
  station_->key("Return");
  EXPECT_EQ(station_->kiosk().wait_for("typed "), "typed Slide 2") << "the box says that it goes along x, as the last pull";
  ASSERT_FALSE(station_->kiosk().wait_for("drag committed").empty());

  const std::filesystem::path other = station_->folder() / "other.k";
  write_sheet(other);
  station_->key("ctrl+o");
  station_->key("ctrl+a");
  station_->type(other.string());
  station_->key("Return");
  ASSERT_FALSE(station_->kiosk().wait_for("asks unsaved").empty());
  station_->key("d");
  ASSERT_FALSE(station_->kiosk().wait_for("document " + other.string()).empty());
  select();
  station_->key("shift+n");
  station_->kiosk().skip_lines();
  enter("5");
  enter("0 0 1", false);
  EXPECT_EQ(station_->kiosk().wait_for("typed "), "typed Slide 0 0 1") << "the direction was of the other deck";
  ASSERT_FALSE(station_->kiosk().wait_for("drag committed").empty());
}

TEST_F(TypedNumbersTest, the_box_says_where_each_number_goes) {
  station_->start_kiosk();
  select();
  for (const char* name : {"lift", "turn"}) {
    if (name == std::string("turn")) station_->key("shift+y");
    station_->key("n");
    ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
    station_->show_people(std::string("typing_") + name);
    station_->key("Escape");
    ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
  }
}

TEST_F(TypedNumbersTest, a_number_is_previewed_before_enter_and_esc_leaves_nothing_of_it) {
  station_->start_kiosk();
  select();
  const auto before = station_->handle();
  ASSERT_TRUE(before.has_value());
  station_->kiosk().skip_lines();
  station_->key("n");
  station_->type("4");
  ASSERT_FALSE(station_->kiosk().wait_for("drag shown ").empty());
  station_->type("e");
  station_->type("1");  // 4e1; "4e" is no number
  ASSERT_FALSE(station_->kiosk().wait_for("drag shown ").empty());
  station_->settled_aim();
  const auto shown = station_->handle();
  ASSERT_TRUE(shown.has_value());
  EXPECT_GT(std::hypot(shown->foot_x - before->foot_x, shown->foot_y - before->foot_y), 20) << "the handle goes with the preview";
  station_->show_people("typed_preview");
  station_->key("Escape");
  ASSERT_FALSE(station_->kiosk().wait_for("drag cancelled").empty());
  station_->settled_aim();
  EXPECT_NEAR(station_->handle()->foot_x, before->foot_x, 0.2);
  EXPECT_NEAR(station_->handle()->foot_y, before->foot_y, 0.2);
  EXPECT_EQ(station_->save_copy("given_up.k"), original_);

  // The sign of one number is that of the direction before the first digit, whatever was previewed meanwhile.
  station_->key("shift+n");
  station_->key("shift+n");  // move
  station_->kiosk().skip_lines();
  enter("2 0 0");
  ASSERT_FALSE(station_->kiosk().wait_for("drag committed").empty());
  const std::map<std::int64_t, Point> moved = nodes_of_deck(station_->save_copy("moved.k"));
  enter(" -1.5");
  ASSERT_FALSE(station_->kiosk().wait_for("drag committed").empty());
  const std::map<std::int64_t, Point> back = nodes_of_deck(station_->save_copy("back.k"));
  double farthest = 0;
  for (const auto& [id, at] : back) farthest = std::min(farthest, at[0] - moved.at(id)[0]);
  EXPECT_NEAR(farthest, -1.5, 1e-5);
}

TEST_F(TypedNumbersTest, a_preview_does_not_ask_and_ends_when_something_else_is_edited) {
  station_->start_kiosk();
  select();
  station_->kiosk().skip_lines();
  enter("6");
  ASSERT_FALSE(station_->kiosk().wait_for("drag committed").empty());
  station_->key("ctrl+z");
  ASSERT_FALSE(station_->kiosk().wait_for("generation ").empty());
  station_->settled_aim();
  station_->key("n");
  station_->type("35");
  station_->settled_aim();
  EXPECT_EQ(station_->kiosk().last("asks "), "") << "in the middle of a number";
  station_->key("Return");
  ASSERT_FALSE(station_->kiosk().wait_for("asks set aside 1").empty());
  station_->key("Escape");
  station_->key("ctrl+y");
  ASSERT_FALSE(station_->kiosk().wait_for("generation ").empty());
  station_->settled_aim();
  station_->kiosk().skip_lines();
  station_->key("n");
  station_->type("3");
  ASSERT_FALSE(station_->kiosk().wait_for("drag shown ").empty());
  const auto [x, y] = station_->settled_aim().pixel_of(nodes_.at(kFirstNode + 2 * kSheetSide + 2));
  station_->click(x, y);
  ASSERT_FALSE(station_->kiosk().wait_for("drag cancelled").empty());
  EXPECT_TRUE(station_->wait_for_selection(1)) << "the click selects as ever";
}

}  // namespace
}  // namespace prismesh::test
