// C shows the state before the last edit and the newest one in turn. It is a view: what is saved, undone and edited is always the newest.
#include <string>

#include <unistd.h>

#include <gtest/gtest.h>

#include "tests/station/station_test_case.h"

namespace prismesh::test {
namespace {

class BeforeAfterTest : public StationTestCase {
 protected:
  void SetUp() override {
    StationTestCase::SetUp();
    if (IsSkipped()) return;
    station_->start_kiosk();
    station_->key("e");
    station_->type("1200-1260");
    ASSERT_FALSE(station_->kiosk().wait_for("counted 61").empty());
    station_->key("Return");
    ASSERT_TRUE(station_->wait_for_selection(61));
    lift();
  }
  void lift() {
    station_->kiosk().skip_lines();
    station_->key("n");
    station_->type("6");
    station_->key("Return");
    ASSERT_FALSE(station_->kiosk().wait_for("drag committed").empty());
  }
  void look_at_the_state_before() {
    station_->kiosk().skip_lines();
    station_->key("c");
    ASSERT_EQ(station_->kiosk().wait_for("comparing "), "comparing before lift");
  }
};

TEST_F(BeforeAfterTest, saving_while_the_older_state_is_shown_saves_the_newest_and_says_so) {
  look_at_the_state_before();
  station_->show_people("before");
  station_->key("ctrl+s");
  const std::string saved = station_->kiosk().wait_for("saved ");
  EXPECT_FALSE(saved.starts_with("saved 0 ")) << saved;
  EXPECT_NE(station_->kiosk().wait_for("notice ").find("newest state"), std::string::npos);
  EXPECT_FALSE(compare_decks(original_, whole_file(station_->deck())).nodes.empty());
  station_->kiosk().skip_lines();
  station_->key("c");
  EXPECT_EQ(station_->kiosk().wait_for("comparing "), "comparing after lift");
}

TEST_F(BeforeAfterTest, an_edit_asked_for_in_the_older_state_shows_the_newest_and_does_nothing) {
  const std::string newest = station_->kiosk().last("generation ");
  const auto refused = [&](const std::string& how) {
    EXPECT_NE(station_->kiosk().wait_for("notice information").find("state before lift"), std::string::npos) << how;
    EXPECT_EQ(station_->kiosk().last("generation "), newest) << how;
  };
  for (const char* key : {"ctrl+z", "ctrl+y", "g", "n", "e", "i", "h", "shift+h", "u", "ctrl+l", "ctrl+e", "ctrl+d", "r"}) {
    look_at_the_state_before();
    ::usleep(250'000);  // letters that follow each other faster are a word
    station_->key(key);
    refused(key);
  }
  look_at_the_state_before();
  station_->click(500, 320);
  refused("a click");
  look_at_the_state_before();
  station_->drag_rectangle(480, 300, 520, 340);
  refused("an outline");
  // Asked for again it is done.
  station_->kiosk().skip_lines();
  station_->key("ctrl+z");
  EXPECT_FALSE(station_->kiosk().wait_for("generation ").empty());
}

TEST_F(BeforeAfterTest, another_edit_ends_it_with_the_newest_state) {
  look_at_the_state_before();
  station_->key("c");
  ASSERT_EQ(station_->kiosk().wait_for("comparing "), "comparing after lift");
  lift();
  ASSERT_FALSE(station_->kiosk().wait_for("comparing over").empty());
  look_at_the_state_before();
  for (int notices = 0; notices < 2; ++notices) station_->key("Escape");
  station_->key("Escape");  // what lies below the notices
  EXPECT_EQ(station_->kiosk().wait_for("comparing "), "comparing over");
}

}  // namespace
}  // namespace prismesh::test
