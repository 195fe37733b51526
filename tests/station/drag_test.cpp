// From end to end: a deck in the kiosk's window, a selection, a pull with the pointer, and what is in the file afterwards.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/station/station.h"

namespace prismesh::test {
namespace {

class DragTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_programs(); !missing.empty())
      GTEST_SKIP() << "SKIPPED: the station can't be tested here, install " << missing;
    station_ = std::make_unique<Station>();
    original_ = whole_file(station_->deck());
    station_->start_kiosk();
  }
  void commit() {
    station_->release();
    ASSERT_FALSE(station_->kiosk().wait_for("drag committed").empty());
    ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
  }
  /// Only cards of `selected` nodes differ, and these moved outward along one direction: the normal at the node that moved most.
  void expect_lifted(const std::string& saved, const std::vector<std::int64_t>& selected) const {
    const DeckDifference difference = compare_decks(original_, saved);
    EXPECT_TRUE(difference.same_line_count);
    EXPECT_TRUE(difference.other_changes.empty()) << difference.other_changes.front();
    const std::set<std::int64_t> allowed(selected.begin(), selected.end());
    for (const std::int64_t id : difference.nodes) EXPECT_TRUE(allowed.contains(id)) << "node " << id << " moved but was not selected";
    EXPECT_GT(difference.nodes.size(), selected.size() / 4);

    const std::map<std::int64_t, Point> before = nodes_of_deck(original_), after = nodes_of_deck(saved);
    Point farthest{};
    std::int64_t grab = 0;
    const auto moved = [&](std::int64_t id) {
      Point by{};
      for (std::size_t i = 0; i < 3; ++i) by[i] = after.at(id)[i] - before.at(id)[i];
      return by;
    };
    const auto length = [](const Point& by) { return std::hypot(by[0], by[1], by[2]); };
    for (const std::int64_t id : difference.nodes)
      if (length(moved(id)) > length(farthest)) farthest = moved(id), grab = id;
    ASSERT_GT(length(farthest), 1) << "nothing was lifted";
    const Point normal = sheet_normal(before.at(grab));
    for (const std::int64_t id : difference.nodes) {
      const Point by = moved(id);
      const double along = by[0] * normal[0] + by[1] * normal[1] + by[2] * normal[2];
      EXPECT_GT(along, 0) << "node " << id;
      EXPECT_NEAR(std::hypot(by[0] - along * normal[0], by[1] - along * normal[1], by[2] - along * normal[2]), 0, 1e-4) << "node " << id;
    }
  }

  std::unique_ptr<Station> station_;
  std::string original_;
};

TEST_F(DragTest, a_lift_by_the_pointer_changes_the_selected_nodes_lines_only) {
  const std::vector<std::int64_t> selected = station_->select_middle();
  station_->pull_arrow(60);
  commit();
  expect_lifted(station_->save_copy("lifted.k"), selected);
  EXPECT_EQ(whole_file(station_->deck()), original_) << "saving elsewhere must leave the deck alone";
}

TEST_F(DragTest, the_value_stands_beside_the_pointer_and_a_digit_opens_the_box_there) {
  const std::vector<std::int64_t> selected = station_->select_middle();
  station_->pull_arrow(60);
  station_->settled_aim();
  const auto value = station_->item("hand"), status = station_->item("status pointed");
  ASSERT_TRUE(value.has_value() && status.has_value());
  EXPECT_EQ(status->state.find("Lift " + value->state), 0U) << status->state << " but " << value->state;
  EXPECT_GT(std::stod(value->state), 1);
  station_->show_people("value_at_hand");
  station_->kiosk().skip_lines();
  station_->type("7");
  ASSERT_FALSE(station_->kiosk().wait_for("drag shown ").empty()) << "7 is shown before Enter";
  station_->settled_aim();
  EXPECT_FALSE(station_->item("hand").has_value()) << "the box stands there now";
  EXPECT_EQ(station_->item("status pointed")->state.find("Lift 7\u00a0mm"), 0U) << station_->item("status pointed")->state;
  station_->show_people("box_at_hand");
  station_->key("Return");
  EXPECT_EQ(station_->kiosk().wait_for("typed "), "typed Lift 7");
  ASSERT_FALSE(station_->kiosk().wait_for("drag committed").empty());
  station_->release();
  expect_lifted(station_->save_copy("typed.k"), selected);
}

TEST_F(DragTest, the_ring_of_the_falloff_is_dragged_to_a_flatter_pull) {
  const std::vector<std::int64_t> selected = station_->select_middle();
  // Another picture of the same ring tells it again: only another ring answers the key.
  std::string shown = station_->kiosk().last("falloff ring ");
  const auto ring_after = [&](const std::string& key) {
    station_->kiosk().skip_lines();
    station_->key(key);
    shown = station_->kiosk().wait_until([&](const std::string& line) { return line.starts_with("falloff ring ") && line != shown; });
    std::stringstream line(shown);
    std::string word;
    std::size_t pieces = 0;
    std::array<double, 2> at{};
    line >> word >> word >> pieces >> word >> at[0] >> at[1];
    EXPECT_TRUE(line) << "no ring: " << line.str();
    return at;
  };
  ring_after("ctrl+Up");
  const std::array<double, 2> ring = ring_after("ctrl+Down");
  const auto handle = station_->handle();
  ASSERT_TRUE(handle.has_value());
  const double away = std::hypot(ring[0] - handle->foot_x, ring[1] - handle->foot_y);
  ASSERT_GT(away, 14) << "the ring isn't in the handle";
  station_->move(ring[0], ring[1]);
  station_->settled_aim();
  ASSERT_TRUE(station_->item("hand").has_value());
  EXPECT_NE(station_->item("hand")->state.find("flat top 0 %"), std::string::npos) << station_->item("hand")->state;
  station_->show_people("ring_below_hand");
  station_->kiosk().skip_lines();
  station_->press();
  for (const double more : {5.0, 12.0, 18.0})
    station_->move(ring[0] + more * (ring[0] - handle->foot_x) / away, ring[1] + more * (ring[1] - handle->foot_y) / away);
  station_->release();
  const std::string flat = station_->kiosk().wait_for("falloff flat ");
  ASSERT_FALSE(flat.empty());
  EXPECT_GT(std::stod(flat.substr(13)), 0.1) << flat;
  station_->show_people("ring_dragged");

  station_->pull_arrow(60);
  commit();
  const std::map<std::int64_t, Point> before = nodes_of_deck(original_), after = nodes_of_deck(station_->save_copy("flat.k"));
  const auto way = [&](std::int64_t id) {
    double squares = 0;
    for (std::size_t i = 0; i < 3; ++i) squares += (after.at(id)[i] - before.at(id)[i]) * (after.at(id)[i] - before.at(id)[i]);
    return std::sqrt(squares);
  };
  double most = 0;
  for (const std::int64_t id : selected) most = std::max(most, way(id));
  const auto whole = std::ranges::count_if(selected, [&](std::int64_t id) { return way(id) > most - 1e-3; });
  EXPECT_GT(whole, 1) << "without a flat top the grab alone moves as far as the hand";
}

TEST_F(DragTest, save_writes_the_deck_itself) {
  const std::vector<std::int64_t> selected = station_->select_middle();
  station_->pull_arrow(40);
  commit();
  station_->key("ctrl+s");
  ASSERT_FALSE(station_->kiosk().wait_for("saved ").empty());
  expect_lifted(whole_file(station_->deck()), selected);
}

TEST_F(DragTest, a_click_selects_the_node_and_a_double_click_its_region) {
  const std::map<std::int64_t, Point> nodes = nodes_of_deck(original_);
  const std::array<double, 2> pixel = station_->pixel_of(nodes.at(kFirstNode + 10 * kSheetSide + 12));
  station_->kiosk().skip_lines();
  station_->click(pixel[0], pixel[1]);
  ASSERT_TRUE(station_->wait_for_selection(1));
  const auto handle = station_->handle();
  ASSERT_TRUE(handle.has_value());
  EXPECT_NEAR(handle->foot_x, pixel[0], 1);
  EXPECT_NEAR(handle->foot_y, pixel[1], 1);
  station_->key("Escape");  // closes what the deck is warned of
  station_->key("Escape");
  ASSERT_TRUE(station_->wait_for_selection(0));
  station_->double_click(pixel[0], pixel[1]);
  EXPECT_TRUE(station_->wait_for_selection(nodes.size())) << "a smooth sheet is one region";
}

TEST_F(DragTest, escape_during_a_pull_leaves_everything_as_it_was) {
  station_->select_middle();
  station_->pull_arrow(60);
  station_->key("Escape");
  ASSERT_FALSE(station_->kiosk().wait_for("drag cancelled").empty());
  station_->release();
  EXPECT_EQ(station_->save_copy("cancelled.k"), original_);
}

TEST_F(DragTest, undo_takes_the_lift_back_and_redo_brings_it_again) {
  const std::vector<std::int64_t> selected = station_->select_middle();
  station_->pull_arrow(60);
  commit();
  const std::string lifted = station_->save_copy("lifted.k");
  station_->key("ctrl+z");
  ASSERT_FALSE(station_->kiosk().wait_for("generation ").empty());
  EXPECT_EQ(station_->save_copy("undone.k"), original_);
  station_->key("ctrl+y");
  ASSERT_FALSE(station_->kiosk().wait_for("generation ").empty());
  EXPECT_EQ(station_->save_copy("redone.k"), lifted);
}

TEST_F(DragTest, a_killed_model_server_loses_no_edit_and_the_kiosk_goes_on) {
  const std::vector<std::int64_t> selected = station_->select_middle();
  station_->pull_arrow(60);
  commit();
  station_->kill_model_server();
  ASSERT_FALSE(station_->kiosk().wait_for("disconnected").empty());
  EXPECT_TRUE(station_->kiosk().running());
  station_->start_model_server();
  ASSERT_FALSE(station_->kiosk().wait_for("connected").empty());
  ASSERT_FALSE(station_->kiosk()
                   .wait_until([](const std::string& line) { return line.starts_with("generation ") && line.ends_with("changed 1"); })
                   .empty());
  expect_lifted(station_->save_copy("recovered.k"), selected);
}

TEST_F(DragTest, a_model_server_killed_in_the_middle_of_a_pull_undoes_the_pull_only) {
  station_->select_middle();
  station_->pull_arrow(60);
  station_->kill_model_server();
  ASSERT_FALSE(station_->kiosk().wait_for("drag lost").empty());
  station_->start_model_server();
  ASSERT_FALSE(station_->kiosk().wait_for("generation ").empty());
  station_->release();
  EXPECT_EQ(station_->save_copy("unpulled.k"), original_);
}

TEST_F(DragTest, two_stations_side_by_side_do_not_touch_each_other) {
  Station other;
  other.start_kiosk();
  const std::vector<std::int64_t> here = station_->select_middle();
  const std::vector<std::int64_t> there = other.select_middle();
  station_->pull_arrow(60);
  commit();
  EXPECT_EQ(other.save_copy("other.k"), original_) << "the second station's document changed with the first's";
  other.pull_arrow(30);
  other.release();
  ASSERT_FALSE(other.kiosk().wait_for("drag committed").empty());
  const std::string first = station_->save_copy("first.k"), second = other.save_copy("second.k");
  expect_lifted(first, here);
  expect_lifted(second, there);
  EXPECT_NE(first, second);
}

}  // namespace
}  // namespace prismesh::test
