// From end to end: a measure that follows an edit and its undoing, and a cut that is dragged, typed and selected in.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "tests/station/station_test_case.h"

namespace prismesh::test {
namespace {

class MeasuringTest : public StationTestCase {
 protected:
  void SetUp() override {
    StationTestCase::SetUp();
    if (IsSkipped()) return;
    station_->start_kiosk();
  }
  std::int64_t node(int i, int j) const { return kFirstNode + j * kSheetSide + i; }
  void click_node(std::int64_t id) {
    const auto at = station_->pixel_of(nodes_.at(id));
    station_->click(at[0], at[1]);
  }
  double distance(std::int64_t a, std::int64_t b) const {
    const Point &p = nodes_.at(a), &q = nodes_.at(b);
    return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
  }
  static std::string four_digits(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
  }
  /// Of a line "cut x = 12.5 mm ..".
  static double place_of(const std::string& line) { return std::stod(line.substr(line.find('=') + 1)); }
  std::string heard(const std::string& beginning) { return station_->kiosk().wait_for(beginning); }
};

TEST_F(MeasuringTest, a_distance_follows_the_edits) {
  const std::int64_t a = node(8, 12), b = node(16, 12);
  station_->key("F4");
  ASSERT_FALSE(heard("panel measure").empty());
  click_node(a);
  click_node(b);
  const std::string measured = heard("measure nodes ");
  EXPECT_TRUE(measured.starts_with("measure nodes " + std::to_string(a) + " \u2192 " + std::to_string(b) + ": " +
                                   four_digits(distance(a, b)) + "\u00a0mm"))
      << measured;
  station_->key("Escape");
  ASSERT_FALSE(heard("panel document").empty());
  // The first node goes up by 5.
  station_->key("e");
  station_->type(std::to_string(a));
  ASSERT_FALSE(heard("counted 1").empty());
  station_->key("Return");
  ASSERT_TRUE(station_->wait_for_selection(1));
  station_->kiosk().skip_lines();
  station_->key("n");
  station_->type("5");
  station_->key("Return");
  const std::string moved = heard("measure nodes ");
  EXPECT_FALSE(moved.empty());
  EXPECT_NE(moved, measured);
  station_->show_people("measure");
  station_->kiosk().skip_lines();
  station_->key("ctrl+z");
  EXPECT_EQ(heard("measure nodes "), measured);
  station_->kiosk().skip_lines();
  station_->key("ctrl+F4");
  EXPECT_EQ(heard("measure none"), "measure none");
}

TEST_F(MeasuringTest, a_cut_is_dragged_and_typed_and_only_what_is_left_is_selected) {
  station_->key("F6");
  const std::string cut = heard("cut x = ");
  ASSERT_FALSE(cut.empty());
  EXPECT_NE(cut.find(" shells 24 "), std::string::npos) << "a row of shells: " << cut;
  double foot_x = 0, foot_y = 0, tip_x = 0, tip_y = 0;
  ASSERT_EQ(std::sscanf(cut.substr(cut.find(" at ")).c_str(), " at %lf %lf %lf %lf", &foot_x, &foot_y, &tip_x, &tip_y), 4) << cut;
  station_->kiosk().skip_lines();
  const double x = (foot_x + tip_x) / 2, y = (foot_y + tip_y) / 2;
  station_->move(x, y);
  station_->settled_aim();
  ASSERT_TRUE(station_->item("hand").has_value());
  EXPECT_EQ(station_->item("hand")->state, "drag: move the cut");
  station_->drag(x, y, x + (tip_x - foot_x) / 2, y + (tip_y - foot_y) / 2);
  const std::string dragged = heard("cut x = ");
  EXPECT_NE(dragged.substr(0, dragged.find(" shells")), cut.substr(0, cut.find(" shells")));
  station_->settled_aim();
  station_->show_people("cut");
  // A number over the arrow sets the place.
  const std::string now = station_->kiosk().last("cut x = ");
  ASSERT_EQ(std::sscanf(now.substr(now.find(" at ")).c_str(), " at %lf %lf %lf %lf", &foot_x, &foot_y, &tip_x, &tip_y), 4) << now;
  double low = 1e300, high = -1e300;
  for (const auto& [id, at] : nodes_) low = std::min(low, at[0]), high = std::max(high, at[0]);
  const double place = low + (high - low) * 14.4 / (kSheetSide - 1);
  station_->move((foot_x + tip_x) / 2, (foot_y + tip_y) / 2);
  station_->kiosk().skip_lines();
  station_->type(std::to_string(place));
  station_->key("Return");
  ASSERT_FALSE(heard("cut x = ").empty());
  // The arrow was pulled towards greater x, so what is left is on the other side. A rectangle about the whole sheet takes just that.
  EXPECT_GT(place_of(dragged), 0);
  const Station::Aim aim = station_->settled_aim();
  std::size_t left = 0;
  std::array<double, 2> from{1e9, 1e9}, to{-1e9, -1e9};
  for (const auto& [id, at] : nodes_) {
    if (at[0] < place) ++left;
    const std::array<double, 2> pixel = aim.pixel_of(at);
    for (std::size_t k = 0; k < 2; ++k) from[k] = std::min(from[k], pixel[k] - 6), to[k] = std::max(to[k], pixel[k] + 6);
  }
  station_->drag_rectangle(from[0], from[1], to[0], to[1]);
  EXPECT_TRUE(station_->wait_for_selection(left));
  station_->kiosk().skip_lines();
  station_->key("Escape");
  station_->key("Escape");
  EXPECT_EQ(heard("cut none"), "cut none");
}

}  // namespace
}  // namespace prismesh::test
