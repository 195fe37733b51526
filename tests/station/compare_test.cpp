// Two views side by side, colours by a field, and two kiosks that move together.
#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include "tests/station/station_test_case.h"
#include "tests/support/places.h"

namespace prismesh::test {
namespace {

class CompareTest : public StationTestCase {
 protected:
  /// Lifts a few nodes in the middle by typing how far.
  void lift() {
    station_->key("e");
    station_->type("1200-1260");
    ASSERT_FALSE(station_->kiosk().wait_for("counted 61").empty());
    station_->key("Return");
    ASSERT_TRUE(station_->wait_for_selection(61));
    station_->kiosk().skip_lines();
    station_->key("n");
    station_->type("6");
    station_->key("Return");
    ASSERT_FALSE(station_->kiosk().wait_for("generation ").empty());
  }
};

TEST_F(CompareTest, the_opened_deck_stands_beside_the_edited_one) {
  station_->start_kiosk();
  lift();
  const Station::Aim alone = Station::aim_from(station_->kiosk().last("aim "));
  station_->kiosk().skip_lines();
  station_->key("ctrl+c");
  ASSERT_FALSE(station_->kiosk().wait_for("compare nothing views 2").empty());
  const std::string view = station_->kiosk().wait_for("view beside generation ");
  ASSERT_FALSE(view.empty());
  EXPECT_NE(view.substr(view.rfind(' ') + 1), station_->kiosk().last("generation ").substr(11, 1)) << "an older state";
  ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
  station_->show_people("two_views");
  // What is picked is picked in the right half.
  const Station::Aim aim = Station::aim_from(station_->kiosk().last("aim "));
  const auto nodes = nodes_of_deck(whole_file(station_->deck()));
  const Point middle = nodes.at(kFirstNode + (kSheetSide / 2) * kSheetSide + kSheetSide / 2);
  EXPECT_GT(aim.pixel_of(middle)[0], 500);
  EXPECT_NEAR(alone.pixel_of(middle)[0], 500, 120);
  station_->kiosk().skip_lines();
  station_->click(aim.pixel_of(middle)[0], aim.pixel_of(middle)[1]);
  EXPECT_TRUE(station_->wait_for_selection(1));
  station_->kiosk().skip_lines();
  station_->key("ctrl+c");
  EXPECT_FALSE(station_->kiosk().wait_for("compare nothing views 1").empty());
}

TEST_F(CompareTest, the_view_beside_is_only_shown) {
  station_->start_kiosk();
  lift();
  station_->key("ctrl+c");
  ASSERT_FALSE(station_->kiosk().wait_for("view beside generation ").empty());
  // So near that the edited sheet would reach into the left half, were it not cut.
  const Station::Item view = *station_->item("view");
  const double left = view.middle()[0] - 0.05 * view.width, right = view.middle()[0] + 0.2 * view.width;
  for (int i = 0; i < 12; ++i) station_->click(right, 320, 4);
  station_->settled_aim();
  station_->kiosk().skip_lines();
  station_->move(left, 320);
  station_->key("ctrl+d");
  ASSERT_FALSE(station_->kiosk().wait_for("operation split").empty());
  station_->key("j");
  ASSERT_FALSE(station_->kiosk().wait_for("quality generation").empty()) << "the server answers one after the other";
  for (const char* said : {"operation previewed", "operation refused"}) EXPECT_TRUE(station_->kiosk().last(said).empty()) << said;
  station_->move(right, 320);
  station_->key("ctrl+d");
  EXPECT_FALSE(station_->kiosk().wait_for("operation previewed").empty()) << "in the right one there is a shell";
}

TEST_F(CompareTest, one_panel_stands_at_the_left) {
  station_->start_kiosk();
  station_->kiosk().skip_lines();
  const std::pair<const char*, const char*> keys[] = {{"j", "quality"},         {"t", "shaping"}, {"j", "quality"},
                                                      {"shift+c", "comparing"}, {"j", "quality"}, {"j", "document"}};
  for (const auto& [key, panel] : keys) {
    station_->key(key);
    EXPECT_FALSE(station_->kiosk().wait_for(std::string("panel ") + panel).empty()) << key;
  }
}

TEST_F(CompareTest, a_click_or_the_wheel_on_a_panel_is_the_panels_alone) {
  station_->start_kiosk();
  lift();
  ASSERT_TRUE(station_->handle());
  const Station::Aim aim = station_->settled_aim();
  const std::string generation = station_->kiosk().last("generation ");
  station_->click(940, 450);     // on the dock
  station_->click(60, 500);      // on the rail, below its buttons
  station_->click(940, 450, 4);  // the wheel
  station_->drag(940, 450, 900, 470);
  // Whatever the picture had made of these would be there before what this key does.
  station_->kiosk().skip_lines();
  station_->key("ctrl+c");
  ASSERT_FALSE(station_->kiosk().wait_for("compare nothing views 2").empty());
  EXPECT_EQ(station_->kiosk().last("generation "), generation) << "the selection stays";
  station_->key("ctrl+c");
  ASSERT_FALSE(station_->kiosk().wait_for("compare nothing views 1").empty());
  const Station::Aim after = station_->settled_aim();
  for (const Point& point : {Point{0, 0, 80}, Point{20, 100, 100}})
    for (const std::size_t i : {0U, 1U}) EXPECT_NEAR(after.pixel_of(point)[i], aim.pixel_of(point)[i], 0.01) << "the view stays";
}

TEST_F(CompareTest, kiosks_that_follow_move_together) {
  station_->start_kiosk({"--follow"});
  const std::filesystem::path programs = test::programs_folder();
  Process other({(programs / "prismesh-kiosk").string(), "--runtime-dir", (station_->folder() / "run").string(), "--follow", "--trace",
                 "--headless-frames", "1000", "--pace", "0.5", "--shots", (station_->folder() / "shots").string(), "--size", "320x240"},
                {});
  ASSERT_FALSE(other.wait_for("shot ").empty()) << other.standard_error();
  EXPECT_TRUE(other.last("view follows").empty());
  station_->key("1");
  EXPECT_FALSE(other.wait_for("view follows").empty());
}

}  // namespace
}  // namespace prismesh::test
