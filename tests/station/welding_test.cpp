// From end to end: welds are shown along a flange, set apart by dragging, made, mended and taken back.
#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "tests/station/station_test_case.h"

namespace prismesh::test {
namespace {

class WeldingTest : public StationTestCase {
 protected:
  void SetUp() override {
    StationTestCase::SetUp();
    if (IsSkipped()) return;
    write_flange(station_->deck());
    original_ = whole_file(station_->deck());
    station_->start_kiosk();
    station_->key("F7");
    ASSERT_FALSE(heard("panel weld").empty());
  }
  std::string heard(const std::string& beginning) { return station_->kiosk().wait_for(beginning); }
  /// The number behind a word of the line.
  static double behind(const std::string& line, const std::string& word) {
    const std::size_t at = line.find(word + " ");
    return at == std::string::npos ? -1 : std::stod(line.substr(at + word.size() + 1));
  }
  static std::size_t beams(const std::string& deck) {
    std::size_t count = 0;
    bool inside = false;
    for (const std::string& line : lines_of(deck)) {
      if (line.starts_with("*"))
        inside = line.starts_with("*ELEMENT_BEAM");
      else if (inside)
        ++count;
    }
    return count;
  }

  std::string original_;
};

TEST_F(WeldingTest, welds_are_shown_set_apart_by_dragging_and_made) {
  const auto middle = station_->settled_aim().pixel_of({60, 10, 1.5});
  station_->click(middle[0], middle[1]);
  const std::string shown = heard("weld previewed ");
  // Five sides of a shell apart, from half of it on: 12.5, 36.25, 60, 83.75, 107.5; a weld is near the first and the last one already.
  EXPECT_EQ(shown, "weld previewed welds 3 left 2 pitch 25 like beam:90001");
  station_->show_people("welding");
  station_->kiosk().skip_lines();
  const Station::Aim aim = station_->aim();
  const auto from = aim.pixel_of({60, 10, 0.75}), to = aim.pixel_of({83.75 + 1.6 * (60 - 83.75), 10, 0.75});  // the first is at 83.75
  station_->move(from[0], from[1]);
  station_->settled_aim();
  ASSERT_TRUE(station_->item("hand").has_value());
  EXPECT_EQ(station_->item("hand")->state, "drag: set the pitch");
  station_->drag(from[0], from[1], to[0], to[1]);
  // Fewer welds, as far apart as the pointer says; perspective makes 1.6 of the way a little less than 1.6 of the pitch.
  const std::string dragged = station_->kiosk().wait_until([](const std::string& line) {
    return line.starts_with("weld previewed ") && behind(line, "pitch") > 36 && behind(line, "pitch") < 44;
  });
  ASSERT_FALSE(dragged.empty()) << station_->kiosk().last("weld previewed ");
  EXPECT_LT(behind(dragged, "welds"), 3) << dragged;
  station_->kiosk().skip_lines();
  station_->key("shift+F7");
  station_->key("ctrl+a");
  station_->type("12");
  station_->key("Return");
  // The answer to the drag's last step may come first.
  const std::string nearer = station_->kiosk().wait_until(
      [](const std::string& line) { return line.starts_with("weld previewed ") && behind(line, "pitch") == 12; });
  ASSERT_FALSE(nearer.empty()) << station_->kiosk().last("weld previewed ");
  const double more = behind(nearer, "welds");
  EXPECT_GE(more, 7) << nearer;
  EXPECT_TRUE(station_->save_copy("shown.k") == original_) << "a preview is no edit";
  station_->key("Return");
  const std::string checked = heard("weld checks ");
  EXPECT_EQ(behind(checked, "welds"), 2 + more) << checked;
  EXPECT_EQ(behind(checked, "findings"), 1) << checked;
  EXPECT_EQ(static_cast<double>(beams(station_->save_copy("welded.k"))), 2 + more);
}

TEST_F(WeldingTest, a_fault_is_listed_gone_to_and_mended) {
  const std::string checked = heard("weld checks ");
  EXPECT_EQ(behind(checked, "welds"), 2) << checked;
  EXPECT_EQ(behind(checked, "findings"), 1) << checked;
  station_->key("F8");
  EXPECT_EQ(heard("weld finding "), "weld finding 1 of 1: beam:90002: node:80004 lies 8 from the nearest sheet");
  const auto at = station_->settled_aim().pixel_of({100, 10, 4.75});
  const Station::Item view = *station_->item("view");
  EXPECT_NEAR(at[0], view.middle()[0], 40) << "the weld is in the middle of the view";
  EXPECT_NEAR(at[1], view.middle()[1], 40);
  station_->show_people("weld_fault");
  station_->kiosk().skip_lines();
  station_->key("ctrl+F8");
  EXPECT_EQ(behind(heard("weld checks "), "findings"), 0);
  const auto nodes = nodes_of_deck(station_->save_copy("mended.k"));
  EXPECT_NEAR(nodes.at(80004)[2], 1.5, 1e-6);
  station_->kiosk().skip_lines();
  station_->key("ctrl+z");
  EXPECT_EQ(behind(heard("weld checks "), "findings"), 1);
  EXPECT_TRUE(station_->save_copy("back.k") == original_);
}

TEST_F(WeldingTest, escape_gives_up_the_welds_and_then_the_tool) {
  const auto middle = station_->settled_aim().pixel_of({60, 10, 1.5});
  station_->click(middle[0], middle[1]);
  ASSERT_FALSE(heard("weld previewed ").empty());
  station_->key("Escape");
  EXPECT_EQ(heard("weld none"), "weld none");
  station_->key("Escape");
  EXPECT_FALSE(heard("panel document").empty());
  EXPECT_TRUE(station_->save_copy("untouched.k") == original_);
}

}  // namespace
}  // namespace prismesh::test
