// From end to end: the tour is followed by doing what its cards say.
#include <string>

#include <gtest/gtest.h>

#include "tests/station/station_test_case.h"

namespace prismesh::test {
namespace {

class TourTest : public StationTestCase {
 protected:
  void SetUp() override {
    StationTestCase::SetUp();
    if (IsSkipped()) return;
    station_->start_kiosk();
    station_->key("Escape");  // closes what the deck is warned of
    ASSERT_EQ(heard("reads none"), "reads none");
  }
  std::string heard(const std::string& beginning) { return station_->kiosk().wait_for(beginning); }
};

TEST_F(TourTest, goes_on_when_what_it_says_was_done) {
  station_->key("shift+F1");
  ASSERT_EQ(heard("tour "), "tour 2 of 8 Look around") << "a deck is open";
  const auto middle = station_->item("view")->middle();
  station_->drag(middle[0] - 60, middle[1], middle[0] + 60, middle[1] + 10, 3);
  ASSERT_EQ(heard("tour "), "tour 3 of 8 Select a face");
  station_->show_people("tour");
  const auto at = station_->settled_aim().pixel_of(nodes_.at(kFirstNode + 12 * kSheetSide + 12));
  station_->double_click(at[0], at[1]);
  ASSERT_EQ(heard("tour "), "tour 4 of 8 Pull");
  ASSERT_TRUE(station_->wait_for_selection(nodes_.size()));
  station_->pull_arrow(60);
  station_->release();
  ASSERT_EQ(heard("tour "), "tour 5 of 8 Repair");
  station_->key("ctrl+shift+l");  // nothing got worse: relaxing does as well
  ASSERT_EQ(heard("tour "), "tour 6 of 8 Compare");
  station_->settled_aim();
  ASSERT_TRUE(station_->item("tour place").has_value()) << "a frame shows where";
  EXPECT_EQ(station_->item("tour place")->state, "rail Compare");
  EXPECT_EQ(station_->item("tour place")->x, station_->item("rail Compare")->x);
  station_->key("c");
  ASSERT_EQ(heard("tour "), "tour 7 of 8 Save a copy");
  station_->key("c");
  station_->kiosk().skip_lines();
  station_->key("ctrl+s");
  ASSERT_EQ(heard("tour "), "tour 8 of 8 That is all");
  station_->settled_aim();  // the card has its size
  station_->click_item("tour end");
  EXPECT_EQ(heard("tour "), "tour none");
}

TEST_F(TourTest, can_be_walked_by_its_buttons_and_ended) {
  station_->key("shift+F1");
  ASSERT_EQ(heard("tour "), "tour 2 of 8 Look around");
  station_->click_item("tour next");
  ASSERT_EQ(heard("tour "), "tour 3 of 8 Select a face");
  station_->click_item("tour back");
  ASSERT_EQ(heard("tour "), "tour 2 of 8 Look around");
  station_->key("shift+F1");
  EXPECT_EQ(heard("tour "), "tour none");
}

}  // namespace
}  // namespace prismesh::test
