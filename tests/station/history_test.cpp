// The tab History, and the question before an edit gives up what was undone.
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/station/station_test_case.h"

namespace prismesh::test {
namespace {

class HistoryTest : public StationTestCase {
 protected:
  /// Hides the part, shows it again and locks it: three states that a key each makes, without the pointer on the model.
  void make_three_states() {
    station_->start_kiosk();
    station_->click_item("tab History");
    ASSERT_TRUE(says("state 0", "As opened, current"));
    station_->settled_aim();
    station_->click_item("tab Parts");
    station_->settled_aim();
    for (const char* action : {"hide", "show", "lock"}) {
      station_->click_item("parts actions");
      station_->settled_aim();
      station_->kiosk().skip_lines();
      station_->click_item(std::string("parts ") + action);
      ASSERT_FALSE(station_->kiosk().wait_for("generation ").empty());
      station_->settled_aim();
    }
    station_->click_item("tab History");
    ASSERT_TRUE(says("state 3", "Lock, current"));
    station_->settled_aim();
  }
};

TEST_F(HistoryTest, a_click_goes_to_any_state) {
  make_three_states();
  station_->click_item("state 1");
  ASSERT_TRUE(says("state 1", "Hide, current"));
  EXPECT_TRUE(says("state 3", "Lock, undone"));
  station_->settled_aim();
  EXPECT_TRUE(station_->kiosk().last("generation ").starts_with("generation 1 "));
  station_->click_item("state 3");
  ASSERT_TRUE(says("state 3", "Lock, current"));
  station_->settled_aim();
  station_->click_item("state 0");
  ASSERT_TRUE(says("state 0", "current"));
  EXPECT_TRUE(says("state 1", "undone"));
  station_->show_people("history");
}

TEST_F(HistoryTest, newer_states_are_set_aside_only_after_a_question_and_come_back_by_their_branch) {
  make_three_states();
  station_->click_item("state 1");
  ASSERT_TRUE(says("state 1", "current"));
  station_->settled_aim();
  const Station::Item view = *station_->item("view");
  station_->move(view.x + 5, view.y + 5);  // the ground
  station_->key("s");                      // shows the part: an edit
  EXPECT_FALSE(station_->kiosk().wait_for("asks set aside 2").empty());
  station_->settled_aim();
  station_->key("Escape");
  station_->settled_aim();
  EXPECT_TRUE(station_->kiosk().last("generation ").starts_with("generation 1 ")) << "nothing was edited";
  EXPECT_EQ(state_of("state 3"), "Lock, undone") << "and nothing is lost";
  station_->kiosk().skip_lines();
  station_->key("s");
  EXPECT_FALSE(station_->kiosk().wait_for("asks set aside 2").empty());
  station_->settled_aim();
  station_->key("g");
  EXPECT_TRUE(says("state 4", "Show, current"));
  EXPECT_EQ(state_of("state 3"), "");
  station_->kiosk().skip_lines();
  station_->key("ctrl+z");
  ASSERT_TRUE(says("state 1", "current"));
  station_->key("ctrl+y");
  ASSERT_TRUE(says("state 4", "current")) << "undo and redo ask nothing";
  ASSERT_TRUE(says("branch 1", "2 states, from Hide: Show, Lock"));
  station_->settled_aim();
  station_->show_people("history_branch");
  station_->kill_model_server();
  ASSERT_FALSE(station_->kiosk().wait_for("disconnected").empty());
  station_->start_model_server();
  ASSERT_FALSE(station_->kiosk().wait_for("connected").empty());
  ASSERT_TRUE(says("branch 1", "2 states, from Hide: Show, Lock")) << "the journal has it";
  station_->settled_aim();
  station_->click_item("branch 1");
  ASSERT_TRUE(says("state 3", "Lock, current"));
  EXPECT_EQ(state_of("state 4"), "");
  EXPECT_TRUE(says("branch 2", "1 state, from Hide: Show"));
}

TEST_F(HistoryTest, undone_selections_alone_are_given_up_without_a_question) {
  station_->start_kiosk();
  const auto selected = station_->select_middle();
  station_->settled_aim();
  station_->key("ctrl+z");
  ASSERT_TRUE(station_->wait_for_selection(0));
  station_->settled_aim();
  station_->kiosk().skip_lines();
  station_->drag_rectangle(station_->item("view")->middle()[0] - 40, station_->item("view")->middle()[1] - 40,
                           station_->item("view")->middle()[0] + 40, station_->item("view")->middle()[1] + 40);
  EXPECT_FALSE(station_->kiosk().wait_for("generation ").empty());
}

TEST_F(HistoryTest, the_status_line_says_what_an_edit_did_until_the_pointer_moves_on) {
  station_->start_kiosk();
  const auto selected = station_->select_middle();
  station_->kiosk().skip_lines();
  station_->pull_arrow(60);
  station_->release();
  const std::string line = station_->kiosk().wait_for("result Lifted ");
  ASSERT_FALSE(line.empty());
  station_->settled_aim();
  ASSERT_TRUE(says("status pointed", "Lifted "));
  EXPECT_EQ("result " + station_->item("status pointed")->state, line);
  EXPECT_EQ(station_->kiosk().last("reads ").find("Lifted"), std::string::npos) << "no notice covers the model";
  // The figures against the decks as they were written.
  const std::map<std::int64_t, Point> now = nodes_of_deck(station_->save_copy("lifted.k"));
  double farthest = 0;
  std::size_t moved = 0;
  for (const auto& [id, to] : now) {
    const Point& from = nodes_.at(id);
    const double way = std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
    farthest = std::max(farthest, way);
    moved += way > 1e-9 ? 1 : 0;
  }
  EXPECT_EQ(line.substr(line.find(": ") + 2, line.find(" nodes") - line.find(": ") - 2), std::to_string(moved)) << line;
  const std::size_t at = line.find("at most ");
  ASSERT_NE(at, std::string::npos) << line;
  EXPECT_NEAR(std::stod(line.substr(at + 8)), farthest, 0.006 * farthest) << line;
  station_->key("Escape");  // the notice of the copy
  const auto [x, y] = station_->settled_aim().pixel_of(nodes_.begin()->second);
  station_->move(x, y);
  EXPECT_TRUE(says("status pointed", "node " + std::to_string(nodes_.begin()->first) + " "));
  station_->kiosk().skip_lines();
  station_->key("ctrl+z");
  EXPECT_NE(station_->kiosk().wait_for("result Undid lift: " + std::to_string(moved) + " nodes, at most ").find("fail"), std::string::npos);
}

}  // namespace
}  // namespace prismesh::test
