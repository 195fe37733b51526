// Decks and displays that nobody sane would make: the kiosk shows what there is, and says what is wrong.
#include <array>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/station/station_test_case.h"
#include "tests/station/unplugged.h"
#include "tests/support/places.h"

namespace prismesh::test {
namespace {

using testing::HasSubstr;

class OddDecksTest : public StationTestCase {
 protected:
  /// A deck of square patches, each `side` x `side` shells and a part; in rows of 70, from below.
  void write_patches(int patches, int side, double size, const std::string& title) {
    std::string parts, nodes, shells;
    int node = 0, shell = 0;
    for (int p = 0; p < patches; ++p) {
      parts += fmt::format("*PART\n{}\n{:10d}{:10d}{:10d}\n", title, p + 1, 1, 1);
      const double x = p % 70 * (side + 1) * size, y = p / 70 * (side + 1) * size;
      const int first = node + 1;
      for (int j = 0; j <= side; ++j)
        for (int i = 0; i <= side; ++i) {
          deck_[++node] = {x + i * size, y + j * size, 0};
          nodes += fmt::format("{:8d}{:16.8g}{:16.8g}{:16.8g}\n", node, deck_[node][0], deck_[node][1], 0.0);
        }
      for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
          const int at = first + j * (side + 1) + i;
          shells += fmt::format("{:8d}{:8d}{:8d}{:8d}{:8d}{:8d}\n", ++shell, p + 1, at, at + 1, at + side + 2, at + side + 1);
        }
    }
    std::ofstream(station_->deck()) << "*KEYWORD\n"
                                    << parts << "*SECTION_SHELL\n         1         2\n       1.5       1.5       1.5       1.5\n"
                                    << "*MAT_ELASTIC\n         1   7.8e-9  210000.0       0.3\n*NODE\n"
                                    << nodes << "*ELEMENT_SHELL\n"
                                    << shells << "*END\n";
  }
  void click_on(std::int64_t node) {
    const auto [x, y] = station_->settled_aim().pixel_of(deck_.at(node));
    station_->kiosk().skip_lines();
    station_->click(x, y);
    ASSERT_TRUE(station_->wait_for_selection(1));
  }
  double pixels_between(std::int64_t a, std::int64_t b) {
    const Station::Aim aim = station_->settled_aim();
    const auto from = aim.pixel_of(deck_.at(a)), to = aim.pixel_of(deck_.at(b));
    return std::hypot(to[0] - from[0], to[1] - from[1]);
  }
  std::map<std::int64_t, Point> deck_;
};

TEST_F(OddDecksTest, one_shell_is_seen_picked_fitted_and_repaired_without_a_step_of_history) {
  write_patches(1, 1, 10, "One");
  station_->start_kiosk();
  EXPECT_TRUE(says("parts acted on", "the only part"));
  const auto middle = station_->item("view")->middle();
  station_->move(middle[0], middle[1]);
  EXPECT_TRUE(says("status pointed", "shell 1   part 1 One  1.5 mm thick"));
  click_on(1);
  for (int step = 0; step < 6; ++step) station_->click(middle[0], middle[1], 5);  // the wheel
  EXPECT_LT(pixels_between(1, 2), 150);
  station_->kiosk().skip_lines();
  station_->key("f");
  ASSERT_FALSE(station_->kiosk().wait_for("aim ").empty());
  EXPECT_GT(pixels_between(1, 2), 200);
  const std::string generation = station_->kiosk().last("generation ");
  station_->kiosk().skip_lines();
  station_->key("ctrl+shift+j");
  EXPECT_EQ(station_->kiosk().wait_for("result "), "result Repaired: nothing was changed");
  station_->settled_aim();
  EXPECT_EQ(station_->kiosk().last("generation "), generation);
  EXPECT_EQ(station_->item("undo")->state, "can") << "the selection";
  EXPECT_TRUE(says("status pointed", "Repaired"));
  station_->key("h");
  EXPECT_TRUE(says("part 1", "hidden"));
  EXPECT_EQ(state_of("status pointed").find("Repaired"), std::string::npos) << "that was the edit before";
  station_->key("ctrl+z");
  EXPECT_TRUE(says("part 1", "shown"));
  station_->key("ctrl+z");
  EXPECT_TRUE(says("undo", "can't"));
}

TEST_F(OddDecksTest, a_picked_node_is_fitted_with_its_shells_in_any_unit) {
  for (const double size : {1e-6, 1e6}) {
    SCOPED_TRACE(size);
    station_ = std::make_unique<Station>();
    station_->set_picture_size(1000, 640);
    deck_.clear();
    write_patches(1, 8, size, "Patch");
    station_->start_kiosk();
    click_on(41);
    station_->kiosk().skip_lines();
    station_->key("f");
    ASSERT_FALSE(station_->kiosk().wait_for("aim ").empty());
    const double apart = pixels_between(41, 42);
    EXPECT_GT(apart, 60);
    EXPECT_LT(apart, 600);
    station_->kiosk().skip_lines();
    station_->pull_arrow(40);
    station_->release();
    EXPECT_FALSE(station_->kiosk().wait_for("drag committed").empty());
    const std::string line = station_->kiosk().last("result Lifted ");
    const double lifted = std::stod(line.substr(line.find("Lifted ") + 7));
    EXPECT_GT(lifted, 0.01 * size) << line;
    EXPECT_LT(lifted, 100 * size) << line;
  }
}

TEST_F(OddDecksTest, thousands_of_parts_without_names_are_listed_and_filtered) {
  write_patches(5000, 1, 8, "");
  station_->start_kiosk();
  ASSERT_TRUE(says("parts acted on", "000 parts"));
  EXPECT_TRUE(says("part 1", "shown"));
  station_->click_item("parts filter");
  station_->settled_aim();
  station_->type("4711");
  EXPECT_TRUE(says("parts acted on", "1 of 5"));
  EXPECT_TRUE(says("part 4711", "shown"));
  station_->click_item("part 4711");
  EXPECT_TRUE(says("parts acted on", "1 chosen"));
}

TEST_F(OddDecksTest, names_that_are_no_utf8_are_told_with_their_bytes) {
  write_patches(1, 4, 10, "T\xfcr \xff\xc3( \x01");
  station_->start_kiosk();
  click_on(13);
  EXPECT_TRUE(says("status pointed", R"(part 1 T\xfcr \xff\xc3()"));
  station_->key("ctrl+p");
  station_->type("T r");
  station_->settled_aim();
  station_->key("Escape");
  station_->settled_aim();
  EXPECT_TRUE(station_->kiosk().running());
}

TEST_F(OddDecksTest, a_window_of_any_size_is_drawn_and_comes_back) {
  station_->start_kiosk();
  const auto before = station_->item("view");
  for (const auto& [width, height] : {std::pair{40, 30}, {1, 1}, {1200, 12}, {12, 800}}) {
    station_->kiosk().skip_lines();
    station_->resize_window(width, height);
    EXPECT_FALSE(station_->kiosk().wait_for("picture ").empty()) << width << "x" << height;
  }
  station_->resize_window(1000, 640);
  EXPECT_FALSE(station_->kiosk()
                   .wait_until([&](const std::string& line) {
                     return line ==
                            fmt::format("item \"view\" {:.0f} {:.0f} {:.0f} {:.0f} ", before->x, before->y, before->width, before->height);
                   })
                   .empty());
  EXPECT_TRUE(station_->kiosk().running());
}

TEST_F(OddDecksTest, a_monitor_that_is_unplugged_costs_no_edit) {
  station_->start_kiosk({"--profile", "prism-mask"});
  ASSERT_TRUE(switch_outputs_off(station_->display().name())) << "the X server has no output";
  deck_ = nodes_;
  click_on(kFirstNode + 312);
  station_->kiosk().skip_lines();
  station_->pull_arrow(40);
  station_->release();
  EXPECT_FALSE(station_->kiosk().wait_for("drag committed").empty());
  EXPECT_TRUE(station_->kiosk().running());
}

TEST_F(OddDecksTest, a_graphics_card_that_was_reset_is_said_and_the_next_kiosk_has_every_edit) {
  const std::filesystem::path reset = station_->folder() / "reset";
  const std::string kiosk = (test::programs_folder() / "prismesh-kiosk").string();
  const std::string run = (station_->folder() / "run").string();
  station_->start_kiosk();
  station_->select_middle();
  station_->pull_arrow(40);
  station_->release();
  ASSERT_FALSE(station_->kiosk().wait_for("drag committed").empty());
  Process lost({kiosk, "--trace", "--runtime-dir", run}, {{"DISPLAY", station_->display().name()},
                                                          {"LD_PRELOAD", (test::programs_folder() / "libreset_card_preload.so").string()},
                                                          {"PRISMESH_TEST_RESET_CARD", reset.string()}});
  ASSERT_FALSE(lost.wait_for("generation 2 ").empty()) << lost.all_output();
  std::ofstream(reset) << "now";
  station_->key("ctrl+z");  // whichever of the two has the keyboard, the other draws then
  EXPECT_EQ(lost.wait_for_exit(), 1);
  EXPECT_THAT(lost.standard_error(), HasSubstr("the graphics card was reset, and the picture is lost. Nothing of the model is"));
  EXPECT_TRUE(station_->kiosk().running());
  station_->open_in_another_kiosk(station_->deck());
  const std::string shown = station_->kiosk().wait_for("generation ");
  // It may have ended before it sent the undo.
  EXPECT_TRUE(shown.ends_with("changed 1") || says("redo", "can")) << shown;
}

}  // namespace
}  // namespace prismesh::test
