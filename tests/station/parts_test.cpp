// The tab of parts, driven by what is on the screen: what is typed there fires no command, edits reach the model, colours don't.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/station/station_test_case.h"

namespace prismesh::test {
namespace {

using testing::HasSubstr;

class PartsTest : public StationTestCase {
 protected:
  void SetUp() override {
    StationTestCase::SetUp();
    if (IsSkipped()) return;
    hat_ = write_closed_hat(station_->deck());  // part 1 hides part 2
    station_->start_kiosk();
    ASSERT_TRUE(says("part 2", "shown"));
  }
  std::string pointed_part(const Point& at) {
    const auto [x, y] = station_->settled_aim().pixel_of(at);
    station_->move(x, y);
    EXPECT_TRUE(says("status pointed", "part "));
    const auto item = station_->item("status pointed");
    return item ? item->state.substr(item->state.find("part ")) : "";
  }
  HatDeck hat_;
};

TEST_F(PartsTest, typing_in_the_filter_fires_no_command_and_the_buttons_edit_what_matches) {
  const std::string generation = station_->kiosk().last("generation ");
  station_->click_item("parts filter");
  station_->settled_aim();
  station_->type("2hos");  // front view, hide, only, show all
  ASSERT_TRUE(says("parts filter", "2hos"));
  EXPECT_TRUE(says("parts acted on", "0 of 2 match"));
  for (int i = 0; i < 3; ++i) station_->key("BackSpace");
  ASSERT_TRUE(says("parts acted on", "1 of 2 match"));
  station_->settled_aim();
  EXPECT_EQ(station_->kiosk().last("generation "), generation);
  if (station_->item("parts actions")) {
    station_->click_item("parts actions");
    station_->settled_aim();
  }
  station_->click_item("parts hide");
  EXPECT_TRUE(says("part 2", "hidden"));
  station_->settled_aim();
  station_->click_item("parts clear");
  EXPECT_TRUE(says("parts acted on", "all 2 parts, 1 hidden"));
  EXPECT_TRUE(says("part 1", "shown"));
  station_->settled_aim();
  station_->key("ctrl+z");
  EXPECT_TRUE(says("part 2", "shown"));
}

TEST_F(PartsTest, a_transparent_part_is_seen_through_and_isn_t_edited) {
  station_->key("5");  // from above
  const Point middle = std::next(hat_.plate.begin(), static_cast<long>(hat_.plate.size() / 2))->second;
  EXPECT_THAT(pointed_part(middle), HasSubstr("part 1"));
  const std::string generation = station_->kiosk().last("generation ");
  station_->click_item("part 1");
  ASSERT_TRUE(says("part 1", "chosen"));
  station_->settled_aim();
  if (station_->item("parts actions")) {
    station_->click_item("parts actions");
    station_->settled_aim();
  }
  station_->click_item("parts transparent");
  ASSERT_TRUE(says("part 1", "transparent"));
  station_->show_people("transparent");
  EXPECT_THAT(pointed_part(middle), HasSubstr("part 2"));
  EXPECT_EQ(station_->kiosk().last("generation "), generation) << "no edit";
}

}  // namespace
}  // namespace prismesh::test
