// Checking and repairing in a whole station: figures, going from error to error, and an operation by hand with its preview.
#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/station/station_test_case.h"

namespace prismesh::test {
namespace {

/// Of shell cards in fixed columns of 8: id, part, four nodes.
std::map<std::int64_t, std::array<std::int64_t, 4>> shells_of_deck(const std::string& text) {
  std::map<std::int64_t, std::array<std::int64_t, 4>> shells;
  bool inside = false;
  for (const std::string& line : lines_of(text)) {
    if (line.empty() || line[0] == '$') continue;
    if (line[0] == '*') {
      inside = line.rfind("*ELEMENT_SHELL", 0) == 0;
      continue;
    }
    if (!inside || line.size() < 48) continue;
    std::array<std::int64_t, 6> number{};
    for (std::size_t i = 0; i < 6; ++i) number[i] = std::stoll(line.substr(8 * i, 8));
    shells[number[0]] = {number[2], number[3], number[4], number[5]};
  }
  return shells;
}

class QualityTest : public StationTestCase {
 protected:
  void SetUp() override {
    StationTestCase::SetUp();
    if (IsSkipped()) return;
    shells_ = shells_of_deck(original_);
  }
  /// One node pulled out of the sheet: the shells around it fail.
  void dent(std::int64_t node, const std::string& by) {
    station_->key("e");
    station_->type(std::to_string(node));
    ASSERT_FALSE(station_->kiosk().wait_for("counted 1").empty());
    station_->key("Return");
    ASSERT_TRUE(station_->wait_for_selection(1));
    station_->kiosk().skip_lines();
    station_->key("n");
    station_->type(by);
    station_->key("Return");
    ASSERT_FALSE(station_->kiosk().wait_for("drag committed").empty());
  }
  Point centre(std::int64_t shell, const std::map<std::int64_t, Point>& nodes) const {
    Point at{};
    for (const std::int64_t node : shells_.at(shell))
      for (std::size_t i = 0; i < 3; ++i) at[i] += nodes.at(node)[i] / 4;
    return at;
  }

  std::map<std::int64_t, std::array<std::int64_t, 4>> shells_;
};

TEST_F(QualityTest, errors_are_gone_to_worst_first_and_named) {
  const std::int64_t middle = kFirstNode + (kSheetSide / 2) * kSheetSide + kSheetSide / 2;
  station_->start_kiosk();
  dent(middle, "4");
  station_->kiosk().skip_lines();
  station_->key("j");
  ASSERT_FALSE(station_->kiosk().wait_for("quality generation").empty());
  station_->show_people("quality panel");
  const std::string saved = station_->save_copy("dented.k");
  const auto dented = nodes_of_deck(saved);
  std::set<std::int64_t> seen;
  for (int i = 1; i <= 3; ++i) {
    station_->kiosk().skip_lines();
    station_->key("Right");
    std::stringstream line(station_->kiosk().wait_for("error "));
    std::string word, of;
    int number = 0;
    std::int64_t total = 0, shell = 0;
    line >> word >> number >> of >> total >> word >> shell;
    ASSERT_TRUE(line) << "no error was gone to";
    EXPECT_EQ(number, i);
    ASSERT_TRUE(shells_.contains(shell)) << shell;
    seen.insert(shell);
    const auto& corners = shells_.at(shell);
    EXPECT_NE(std::find(corners.begin(), corners.end(), middle), corners.end()) << "the worst shells are those around the dent";
    const auto at = station_->settled_aim().pixel_of(centre(shell, dented));
    const std::array<double, 2> middle_of_view = station_->item("view")->middle();
    EXPECT_NEAR(at[0], middle_of_view[0], 3);
    EXPECT_NEAR(at[1], middle_of_view[1], 3);
  }
  EXPECT_EQ(seen.size(), 3u);
  station_->show_people("error");
  station_->kiosk().skip_lines();
  station_->key("Left");
  EXPECT_NE(station_->kiosk().wait_for("error ").find("error 2 of"), std::string::npos);
}

TEST_F(QualityTest, limits_that_are_typed_hold_for_relaxing) {
  const std::int64_t middle = kFirstNode + (kSheetSide / 2) * kSheetSide + kSheetSide / 2;
  station_->start_kiosk();
  station_->key("shift+n");  // numbers slide
  dent(middle, "0 2.5 0");
  const auto dented = nodes_of_deck(station_->save_copy("dented.k"));
  const auto type_limit = [&](const std::string& key, const std::string& number, const std::string& told) {
    station_->kiosk().skip_lines();
    station_->key(key);
    station_->type(number);
    station_->key("Return");
    EXPECT_EQ(station_->kiosk().wait_for("limits "), told);
  };
  type_limit("ctrl+t", "0.5", "limits sheet 0.5 line none threshold none");
  type_limit("ctrl+shift+t", "0", "limits sheet 0.5 line 0 threshold none");
  type_limit("ctrl+h", "100", "limits sheet 0.5 line 0 threshold 100");
  station_->key("j");
  ASSERT_FALSE(station_->kiosk().wait_for("quality generation").empty());
  station_->show_people("limits");
  const auto at = station_->pixel_of(dented.at(middle));
  station_->move(at[0], at[1]);
  station_->kiosk().skip_lines();
  station_->key("shift+l");
  ASSERT_FALSE(station_->kiosk().wait_for("generation ").empty());
  std::size_t moved = 0;
  for (const auto& [id, node] : nodes_of_deck(station_->save_copy("relaxed.k"))) {
    const Point& before = dented.at(id);
    const double by = std::hypot(node[0] - before[0], node[1] - before[1], node[2] - before[2]);
    if (by == 0) continue;
    ++moved;
    EXPECT_LT(by, 0.5 + 1e-4) << id;
    if (id == middle) {
      EXPECT_GT(by, 0.45) << "without the limit it goes most of the way back";
    }
    const std::int64_t row = (id - kFirstNode) / kSheetSide, column = (id - kFirstNode) % kSheetSide;
    EXPECT_LE(std::max(std::abs(row - kSheetSide / 2), std::abs(column - kSheetSide / 2)), 1) << id << " joined without need";
  }
  EXPECT_GT(moved, 0u);
}

TEST_F(QualityTest, a_node_that_was_removed_is_not_gone_to) {
  station_->start_kiosk();
  // The middle of an edge between two nodes: collapsing it removes one of them.
  const std::int64_t node = kFirstNode + 12 * kSheetSide + 12;
  const Point &a = nodes_.at(node), &b = nodes_.at(node + 1);
  const auto at = station_->pixel_of({(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2});
  station_->move(at[0], at[1]);
  station_->kiosk().skip_lines();
  station_->key("ctrl+b");
  ASSERT_FALSE(station_->kiosk().wait_for("operation previewed").empty());
  station_->kiosk().skip_lines();
  station_->key("Return");
  ASSERT_FALSE(station_->kiosk().wait_for("generation ").empty());
  const std::map<std::int64_t, Point> left = nodes_of_deck(station_->save_copy("collapsed.k"));
  const std::int64_t gone = left.contains(node) ? node + 1 : node;
  ASSERT_FALSE(left.contains(gone));
  station_->key("ctrl+p");
  station_->type("node " + std::to_string(gone));
  EXPECT_TRUE(says("find problem", "Node " + std::to_string(gone) + " belongs to no element"));
  const std::string aim = station_->kiosk().last("aim ");
  station_->key("Return");
  station_->settled_aim();
  EXPECT_EQ(station_->kiosk().last("aim "), aim);
}

TEST_F(QualityTest, an_operation_by_hand_is_shown_before_it_is_done) {
  station_->start_kiosk();
  const std::int64_t shell = shells_.begin()->first + 12 * (kSheetSide - 1) + 12;
  const auto at = station_->pixel_of(centre(shell, nodes_));
  station_->move(at[0], at[1]);
  station_->kiosk().skip_lines();
  station_->key("ctrl+d");
  const std::string previewed = station_->kiosk().wait_for("operation previewed");
  EXPECT_NE(previewed.find("shells 2 "), std::string::npos) << previewed;
  station_->show_people("split");
  station_->key("Escape");
  EXPECT_FALSE(station_->kiosk().wait_for("operation none").empty());
  EXPECT_EQ(station_->save_copy("untouched.k"), original_) << "a preview changes nothing";
  station_->kiosk().skip_lines();
  station_->move(at[0], at[1]);
  station_->key("ctrl+d");
  ASSERT_FALSE(station_->kiosk().wait_for("operation previewed").empty());
  station_->kiosk().skip_lines();
  station_->key("Return");
  ASSERT_FALSE(station_->kiosk().wait_for("generation ").empty());
  const auto split = shells_of_deck(station_->save_copy("split.k"));
  ASSERT_EQ(split.size(), shells_.size() + 1);
  std::set<std::int64_t> corners;
  for (const auto& [id, nodes] : split) {
    if (shells_.contains(id) && shells_.at(id) == nodes) continue;
    EXPECT_EQ(std::set(nodes.begin(), nodes.end()).size(), 3u) << "a triangle";
    corners.insert(nodes.begin(), nodes.end());
  }
  EXPECT_EQ(corners, std::set(shells_.at(shell).begin(), shells_.at(shell).end())) << "of the quad that was under the pointer";
}

}  // namespace
}  // namespace prismesh::test
