// Numbers that are typed for the handle: one number goes only where the box says, and nothing of another deck is left over.
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

}  // namespace
}  // namespace prismesh::test
