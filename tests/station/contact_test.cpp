// From end to end: a part is dragged into another one, which is said before it is let go, and what the list of places says afterwards.
#include <string>

#include <gtest/gtest.h>

#include "tests/station/station_test_case.h"

namespace prismesh::test {
namespace {

class ContactTest : public StationTestCase {
 protected:
  void SetUp() override {
    StationTestCase::SetUp();
    if (IsSkipped()) return;
    hat_ = write_closed_hat(station_->deck());
    original_ = whole_file(station_->deck());
    station_->start_kiosk();
  }
  void select_hat() {
    station_->key("e");
    station_->type("part:1");
    const std::string counted = "counted " + std::to_string(hat_.hat.size());
    ASSERT_FALSE(station_->kiosk().wait_for(counted).empty());
    station_->key("Return");
    ASSERT_TRUE(station_->wait_for_selection(hat_.hat.size()));
  }
  std::string heard(const std::string& beginning) { return station_->kiosk().wait_for(beginning); }

  HatDeck hat_;
};

TEST_F(ContactTest, a_pull_that_keeps_parts_apart_stops_before_they_touch) {
  select_hat();
  station_->kiosk().skip_lines();
  station_->key("t");
  ASSERT_FALSE(heard("panel shaping").empty());
  station_->key("ctrl+shift+d");
  station_->settled_aim();
  EXPECT_NE(station_->item("status setting")->state.find("parts kept apart"), std::string::npos);
  station_->kiosk().skip_lines();
  station_->pull_arrow(-30);  // through the plate, were it free
  station_->release();
  EXPECT_FALSE(heard("drag committed").empty());
  EXPECT_TRUE(station_->kiosk().last("drag touches: ").empty());
  station_->kiosk().skip_lines();
  station_->key("ctrl+k");
  const std::string places = heard("contact generation ");
  EXPECT_NE(places.find(" cross 0 "), std::string::npos) << places;
}

TEST_F(ContactTest, a_touch_is_said_before_the_part_is_let_go_and_nothing_remains_of_it) {
  select_hat();
  station_->pull_arrow(-30);  // down through the plate that closes it, 3 below
  const std::string touch = heard("drag touches: ");
  EXPECT_TRUE(touch.starts_with("drag touches: 2 parts ")) << touch;
  EXPECT_NE(touch.find("1 Hat and 2 Closing plate"), std::string::npos) << touch;
  station_->show_people("contact_drag");
  station_->key("Escape");
  ASSERT_FALSE(heard("drag cancelled").empty());
  EXPECT_FALSE(heard("drag touches nothing").empty());
  station_->release();
  station_->kiosk().skip_lines();
  station_->key("ctrl+k");
  EXPECT_TRUE(heard("contact generation ").ends_with(" cross 0 close 0 gap 0"));
  EXPECT_EQ(station_->save_copy("cancelled.k"), original_);
}

TEST_F(ContactTest, places_are_listed_marked_and_gone_to) {
  station_->key("ctrl+k");
  ASSERT_TRUE(heard("contact generation ").ends_with(" cross 0 close 0 gap 0")) << "3 apart";
  select_hat();
  station_->pull_arrow(-30);
  station_->release();
  ASSERT_FALSE(heard("drag committed").empty());
  const std::string found = heard("contact generation ");
  EXPECT_EQ(found.find(" cross 0 "), std::string::npos) << "the hat's walls pass through the plate: " << found;
  const std::string marks = heard("contact marks ");
  EXPECT_EQ(marks.find("curve 0"), std::string::npos) << marks;
  station_->key("ctrl+Right");
  const std::string first = heard("contact 1 of ");
  EXPECT_NE(first.find("cross, "), std::string::npos) << first;
  EXPECT_NE(first.find("1 Hat and 2 Closing plate"), std::string::npos) << first;
  EXPECT_EQ(heard("contact marks ").find("ways 0"), std::string::npos) << "of the chosen place";
  const Station::Aim aim = station_->settled_aim();
  const Station::Item view = *station_->item("view");
  for (const auto& [id, node] : hat_.plate) {
    // The walls pass through the plate along its whole length: all of that is seen.
    const auto at = aim.pixel_of(node);
    EXPECT_TRUE(at[0] > view.x && at[0] < view.x + view.width && at[1] > view.y && at[1] < view.y + view.height) << id;
    if (HasFailure()) break;
  }
  station_->show_people("contact");
  station_->key("ctrl+z");
  EXPECT_TRUE(heard("contact generation ").ends_with(" cross 0 close 0 gap 0"));
  station_->key("ctrl+y");
  // Those of the undone state, none, may still come, and go, before.
  const auto marks_some = [](const std::string& line) {
    return line.starts_with("contact marks ") && !line.starts_with("contact marks 0");
  };
  ASSERT_FALSE(station_->kiosk().wait_until(marks_some).empty());
  station_->kiosk().skip_lines();
  station_->key("ctrl+k");
  EXPECT_EQ(heard("contact marks "), "contact marks 0");
}

}  // namespace
}  // namespace prismesh::test
