// The tools in a whole station: lasso, expressions, sliding, turning, typed numbers, files; and a view that moves in the middle.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/station/station_test_case.h"

namespace prismesh::test {
namespace {

using Pixel = std::array<double, 2>;

bool inside(const std::vector<Pixel>& outline, const Pixel& at) {
  bool in = false;
  for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++)
    if ((outline[i][1] > at[1]) != (outline[j][1] > at[1]) &&
        at[0] < (outline[j][0] - outline[i][0]) * (at[1] - outline[i][1]) / (outline[j][1] - outline[i][1]) + outline[i][0])
      in = !in;
  return in;
}

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double length(const Point& a) { return std::hypot(a[0], a[1], a[2]); }

class ToolsTest : public StationTestCase {
 protected:
  const Point& middle() const { return nodes_.at(kFirstNode + (kSheetSide / 2) * kSheetSide + kSheetSide / 2); }
  void select_by_expression(const std::string& expression, std::size_t nodes) {
    station_->key("e");
    station_->type(expression);
    EXPECT_EQ(station_->kiosk().wait_for("counted " + std::to_string(nodes)), "counted " + std::to_string(nodes) + " " + expression);
    station_->key("Return");
    ASSERT_TRUE(station_->wait_for_selection(nodes));
  }
  /// Moves with the left button down, and waits until a preview is seen.
  void pull(const Pixel& from, const std::vector<Pixel>& to) {
    station_->kiosk().skip_lines();
    station_->move(from[0], from[1]);
    station_->press();
    for (const Pixel& at : to) station_->move(at[0], at[1]);
    ASSERT_FALSE(station_->kiosk().wait_for("drag begun").empty());
    ASSERT_FALSE(station_->kiosk().wait_for("drag shown").empty());
  }
  /// The answer may come before the picture that select_by_expression() waits for, or after it.
  bool follow(std::size_t edges) {
    const std::string line = "followed edges " + std::to_string(edges);
    return station_->kiosk().last("followed edges ") == line || !station_->kiosk().wait_for(line).empty();
  }
  void committed() { ASSERT_FALSE(station_->kiosk().wait_for("drag committed").empty()) << "the drag became no edit"; }
  /// Displacement of each node that moved.
  std::map<std::int64_t, Point> moved(const std::string& saved) const {
    std::map<std::int64_t, Point> by;
    for (const auto& [id, at] : nodes_of_deck(saved))
      if (const Point d = minus(at, nodes_.at(id)); length(d) > 0) by[id] = d;
    return by;
  }
};

TEST_F(ToolsTest, a_lasso_takes_what_it_goes_round_though_the_view_moves_meanwhile) {
  station_->start_kiosk();
  const Pixel centre = station_->pixel_of(middle());
  std::vector<Pixel> way{{-90, -60}, {100, -45}, {60, 70}, {5, 10}, {-80, 65}};
  for (Pixel& at : way) at = {std::round(centre[0] + at[0]), std::round(centre[1] + at[1])};
  station_->kiosk().skip_lines();
  station_->move(way[0][0], way[0][1]);
  station_->press();
  station_->move(way[1][0], way[1][1]);
  station_->move(way[2][0], way[2][1]);
  station_->press(3);  // the view turns, the lasso waits
  station_->move(way[2][0] + 40, way[2][1] - 10);
  station_->move(way[2][0], way[2][1]);
  station_->release(3);
  station_->click(way[2][0], way[2][1], 4);
  for (std::size_t i = 3; i < way.size(); ++i) station_->move(way[i][0], way[i][1]);
  const Station::Aim aim = station_->settled_aim();
  station_->show_people("lasso");
  station_->kiosk().skip_lines();
  station_->release();
  ASSERT_FALSE(station_->kiosk().wait_for("generation ").empty());
  std::size_t expected = 0;
  for (const auto& [id, point] : nodes_) expected += inside(way, aim.pixel_of(point)) ? 1 : 0;
  ASSERT_GT(expected, 15u);
  EXPECT_NE(station_->kiosk().last("generation ").find("selected " + std::to_string(expected) + " "), std::string::npos)
      << "expected " << expected << ", got: " << station_->kiosk().last("generation ");
}

TEST_F(ToolsTest, expressions_are_counted_while_they_are_typed_and_come_back_with_up) {
  station_->start_kiosk();
  select_by_expression("1001-1025", 25);
  station_->key("e");
  station_->type("1001-1005,9");
  EXPECT_FALSE(station_->kiosk().wait_for("counted none 1001-1005,9").empty()) << "there is no node 9";
  station_->show_people("expression");
  station_->key("Escape");
  station_->key("e");
  station_->key("Up");
  ASSERT_FALSE(station_->kiosk().wait_for("counted 25 1001-1025").empty());
  station_->key("ctrl+Return");
  EXPECT_TRUE(station_->wait_for_selection(0)) << "Ctrl takes away";
}

TEST_F(ToolsTest, a_typed_number_is_the_edit_to_the_last_digit) {
  station_->start_kiosk();
  select_by_expression("all", nodes_.size());
  const auto handle = station_->handle();
  ASSERT_TRUE(handle.has_value());
  station_->kiosk().skip_lines();
  station_->move(handle->tip_x, handle->tip_y);
  station_->type("2.5");
  station_->show_people("number");
  station_->key("Return");
  EXPECT_EQ(station_->kiosk().wait_for("typed "), "typed Lift 2.5");
  committed();
  double most = 0;
  for (const auto& [id, by] : moved(station_->save_copy("typed.k"))) most = std::max(most, length(by));
  EXPECT_NEAR(most, 2.5, 2e-4);
}

TEST_F(ToolsTest, the_free_edges_that_follow_are_shown_before_the_pull) {
  station_->start_kiosk();
  select_by_expression("all", nodes_.size());
  EXPECT_TRUE(follow(96)) << "nothing holds: all four sides of 24 follow";
  station_->key("shift+f");  // by distance: where nothing holds, all follow
  station_->key("shift+f");
  EXPECT_TRUE(follow(0)) << "they hold now";
}

TEST_F(ToolsTest, the_disk_slides_on_the_sheet_and_goes_on_after_the_view_was_turned) {
  station_->start_kiosk();
  station_->select_middle();
  const auto handle = station_->handle();
  ASSERT_TRUE(handle.has_value());
  const Pixel on_disk{handle->foot_x + 24, handle->foot_y}, pulled{on_disk[0] + 30, on_disk[1]};
  pull(on_disk, {{on_disk[0] + 15, on_disk[1]}, pulled});
  station_->show_people("slide");
  station_->press(3);
  station_->move(pulled[0] + 60, pulled[1] - 20);
  station_->release(3);
  station_->click(pulled[0] + 60, pulled[1] - 20, 4);
  station_->move(pulled[0] + 75, pulled[1] - 20);
  station_->release();
  committed();
  const auto by = moved(station_->save_copy("slid.k"));
  ASSERT_GT(by.size(), 20u);
  double most = 0;
  for (const auto& [id, d] : by) most = std::max(most, length(d));
  EXPECT_GT(most, 3);
  for (const auto& [id, d] : by) {
    const Point normal = sheet_normal(nodes_.at(id));
    EXPECT_LT(std::abs(d[0] * normal[0] + d[1] * normal[1] + d[2] * normal[2]), 0.35 * length(d) + 0.05)
        << "node " << id << " left the sheet";
  }
}

TEST_F(ToolsTest, a_turn_about_a_picked_axis_keeps_each_nodes_distance_from_it) {
  station_->start_kiosk();
  station_->select_middle();
  station_->kiosk().skip_lines();
  const std::int64_t first = kFirstNode + 12 * kSheetSide + 2, second = kFirstNode + 16 * kSheetSide + 2;
  station_->key("a");
  const Pixel one = station_->pixel_of(nodes_.at(first));
  station_->click(one[0], one[1]);
  ASSERT_FALSE(station_->kiosk().wait_for("axis first node").empty());
  station_->drag(one[0], one[1], one[0] + 30, one[1] + 10, 3);  // the pick stays when the view changes
  const Pixel two = station_->settled_aim().pixel_of(nodes_.at(second));
  station_->click(two[0], two[1]);
  std::stringstream axis(station_->kiosk().wait_for("axis through two nodes"));
  std::string word;
  Point from{}, way{};
  axis >> word >> word >> word >> word >> from[0] >> from[1] >> from[2] >> way[0] >> way[1] >> way[2];
  ASSERT_TRUE(axis);
  EXPECT_LT(length(minus(from, nodes_.at(first))), 1e-9) << "the pick must stay when the view changes";
  ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
  const auto handle = station_->handle();
  ASSERT_TRUE(handle.has_value());
  const Pixel ball{handle->foot_x, handle->foot_y};
  pull(ball, {{ball[0], ball[1] - 10}, {ball[0], ball[1] - 24}});
  station_->show_people("turn");
  station_->release();
  committed();
  const auto by = moved(station_->save_copy("turned.k"));
  ASSERT_GT(by.size(), 20u);
  const auto distance = [&](const Point& at) {
    const Point d = minus(at, from);
    const double along = (d[0] * way[0] + d[1] * way[1] + d[2] * way[2]) / length(way);
    return std::sqrt(std::max(0.0, length(d) * length(d) - along * along));
  };
  double most = 0;
  for (const auto& [id, d] : by) {
    const Point& at = nodes_.at(id);
    EXPECT_NEAR(distance({at[0] + d[0], at[1] + d[1], at[2] + d[2]}), distance(at), 2e-3) << "node " << id;
    most = std::max(most, length(d));
  }
  EXPECT_GT(most, 1);
}

TEST_F(ToolsTest, a_pull_falls_off_along_a_picked_direction_only) {
  station_->start_kiosk();
  station_->select_middle();
  station_->kiosk().skip_lines();
  const std::int64_t first = kFirstNode + 2 * kSheetSide + 6, second = kFirstNode + 7 * kSheetSide + 9;
  station_->key("ctrl+g");
  for (const std::int64_t node : {first, second}) {
    const Pixel at = station_->pixel_of(nodes_.at(node));
    station_->click(at[0], at[1]);
    if (node == first) {
      ASSERT_FALSE(station_->kiosk().wait_for("falloff first node").empty());
    }
  }
  ASSERT_FALSE(station_->kiosk().wait_for("falloff along two nodes ").empty());
  station_->key("t");
  ASSERT_FALSE(station_->kiosk().wait_for("panel shaping").empty());
  station_->show_people("falloff direction");
  station_->key("t");
  station_->key("n");
  station_->type("6");
  station_->key("Return");
  committed();
  const auto by = moved(station_->save_copy("along.k"));
  ASSERT_GT(by.size(), 20u);
  // Across the direction all nodes move alike: along it the displacement only rises, then only falls.
  const Point way = minus(nodes_.at(second), nodes_.at(first));
  std::vector<std::pair<double, double>> along;
  for (const auto& [id, d] : by) {
    const Point& at = nodes_.at(id);
    along.emplace_back((at[0] * way[0] + at[1] * way[1] + at[2] * way[2]) / length(way), length(d));
  }
  std::sort(along.begin(), along.end());
  const auto top = std::max_element(along.begin(), along.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  EXPECT_NEAR(top->second, 6, 1e-3);
  for (auto each = along.begin(); each + 1 != along.end(); ++each) {
    const double rise = (each + 1)->second - each->second;
    EXPECT_GT(each < top ? rise : -rise, -1e-4) << "at " << each->first;
  }
  // The other sources of a direction.
  station_->kiosk().skip_lines();
  for (const char* which : {"right ", "up ", "depth "}) {
    station_->key("shift+v");
    EXPECT_FALSE(station_->kiosk().wait_for(std::string("falloff along view's ") + which).empty());
  }
  const Pixel on_sheet = station_->pixel_of(nodes_.at(kFirstNode + 2 * kSheetSide + 2));
  station_->move(on_sheet[0], on_sheet[1]);
  station_->key("ctrl+shift+g");
  EXPECT_FALSE(station_->kiosk().wait_for("falloff along element edge ").empty());
  station_->key("shift+g");
  EXPECT_FALSE(station_->kiosk().wait_for("falloff all ways").empty());
}

TEST_F(ToolsTest, the_file_under_the_pointer_is_locked_and_hidden_whole) {
  const HatDeck hat = write_closed_hat(station_->folder() / "hat.k");
  std::ofstream(station_->deck()) << "*KEYWORD\n*INCLUDE\nhat.k\n*END\n";
  station_->start_kiosk();
  station_->kiosk().skip_lines();
  station_->key("5");
  ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
  const Pixel roof = station_->pixel_of({4, 57, 30});
  station_->kiosk().skip_lines();
  station_->move(roof[0], roof[1]);
  station_->key("shift+k");
  ASSERT_FALSE(station_->kiosk().wait_for("generation ").empty());
  select_by_expression("all", hat.hat.size() + hat.plate.size());
  station_->kiosk().skip_lines();
  station_->key("n");
  station_->type("3");
  station_->key("Return");
  EXPECT_NE(station_->kiosk().wait_for("notice error").find("lock"), std::string::npos);
  station_->key("Escape");
  station_->move(roof[0], roof[1]);
  station_->key("shift+h");
  EXPECT_TRUE(station_->wait_for_selection(0)) << "hidden nodes must not be selected";
  station_->show_people("files");
}

}  // namespace
}  // namespace prismesh::test
