// How the kiosk starts and ends: without a display, with its window closed, with its display gone, before its model server.
#include <csignal>
#include <fstream>

#include <unistd.h>

#include <gtest/gtest.h>

#include "tests/station/station.h"
#include "tests/support/places.h"

namespace prismesh::test {
namespace {

const std::string kKiosk = (test::programs_folder() / "prismesh-kiosk").string();

TEST(KioskLifeTest, without_a_display_it_says_so_and_ends_with_1) {
  Process kiosk({kKiosk, "--screen", "x11"}, {{"DISPLAY", ""}});
  EXPECT_EQ(kiosk.wait_for_exit(), 1);
  EXPECT_EQ(kiosk.standard_error().rfind("no display: set DISPLAY", 0), 0u) << kiosk.standard_error();
}

TEST(KioskLifeTest, without_a_right_to_the_screen_it_says_so_and_ends_with_1) {
  Process bare({kKiosk, "--screen", "bare"}, {{"DISPLAY", ""}, {"LIBSEAT_BACKEND", "none"}});
  EXPECT_EQ(bare.wait_for_exit(), 1);
  EXPECT_EQ(bare.standard_error().rfind("the screen: no seat manager gives it to this program", 0), 0u) << bare.standard_error();
  Process usual({kKiosk}, {{"DISPLAY", ""}, {"LIBSEAT_BACKEND", "none"}});
  EXPECT_EQ(usual.wait_for_exit(), 1);
  EXPECT_EQ(
      usual.standard_error().rfind("no display: DISPLAY names no X server, and the bare screen can't be used (the screen: no seat", 0), 0u)
      << usual.standard_error();
}

TEST(KioskLifeTest, a_display_that_does_not_answer_is_named) {
  Process kiosk({kKiosk}, {{"DISPLAY", ":64999"}});
  EXPECT_EQ(kiosk.wait_for_exit(), 1);
  EXPECT_EQ(kiosk.standard_error().rfind(":64999: no X server answers", 0), 0u) << kiosk.standard_error();
}

TEST(KioskLifeTest, wrong_usage_ends_with_2) {
  for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--size", "1600"},
                                                {"--size", "10x10"},
                                                {"--eye", "0,0"},
                                                {"--eye", "0,0,-5"},
                                                {"--headless-frames", "1"},
                                                {"--nonsense"}}) {
    std::vector<std::string> command{kKiosk};
    command.insert(command.end(), wrong.begin(), wrong.end());
    Process kiosk(command, {{"DISPLAY", ""}});
    EXPECT_EQ(kiosk.wait_for_exit(), 2) << wrong.front();
    EXPECT_FALSE(kiosk.standard_error().empty()) << wrong.front();
  }
}

TEST(KioskLifeTest, an_unknown_profile_is_refused_by_name) {
  Process kiosk({kKiosk, "--profile", "no-such-display"}, {{"DISPLAY", ""}});
  EXPECT_EQ(kiosk.wait_for_exit(), 1);
  EXPECT_NE(kiosk.standard_error().find("no-such-display"), std::string::npos) << kiosk.standard_error();
}

class WindowTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_programs(); !missing.empty())
      GTEST_SKIP() << "SKIPPED: the station can't be tested here, install " << missing;
    station_ = std::make_unique<Station>();
  }
  std::unique_ptr<Station> station_;
};

TEST_F(WindowTest, closing_the_window_ends_with_0) {
  station_->start_kiosk();
  station_->key("alt+F4");
  EXPECT_EQ(station_->kiosk().wait_for_exit(), 0) << station_->kiosk().standard_error();
}

TEST_F(WindowTest, a_window_that_another_client_destroys_ends_with_0) {
  station_->start_kiosk();
  station_->destroy_window();
  EXPECT_EQ(station_->kiosk().wait_for_exit(), 0) << station_->kiosk().standard_error();
}

TEST_F(WindowTest, a_display_that_goes_away_is_said_and_ends_with_1) {
  station_->start_kiosk();
  station_->display().server().kill(SIGKILL);
  EXPECT_EQ(station_->kiosk().wait_for_exit(), 1);
  EXPECT_NE(station_->kiosk().standard_error().find("the X server has gone away"), std::string::npos) << station_->kiosk().standard_error();
}

TEST_F(WindowTest, the_kiosk_waits_for_its_model_server) {
  station_->kill_model_server();
  Process kiosk({kKiosk, "--trace", "--runtime-dir", (station_->folder() / "run").string(), "--open", station_->deck().string()},
                {{"DISPLAY", station_->display().name()}});
  ASSERT_FALSE(kiosk.wait_for("ready ").empty()) << kiosk.all_output();
  station_->start_model_server();
  EXPECT_FALSE(kiosk.wait_for("connected").empty());
  EXPECT_FALSE(kiosk.wait_for("generation ").empty()) << kiosk.all_output();
}

TEST_F(WindowTest, a_deck_that_is_none_is_refused_in_a_sentence_and_the_kiosk_stays) {
  const std::filesystem::path no_deck = station_->folder() / "letter.k";
  std::ofstream(no_deck) << "Dear reader,\nthis is no deck.\n";
  Process kiosk({kKiosk, "--trace", "--runtime-dir", (station_->folder() / "run").string(), "--open", no_deck.string()},
                {{"DISPLAY", station_->display().name()}});
  const std::string notice = kiosk.wait_for("notice error");
  EXPECT_NE(notice.find("letter.k"), std::string::npos) << notice;
  EXPECT_FALSE(kiosk.wait_for("picture ").empty());
  EXPECT_TRUE(kiosk.running());
}

TEST_F(WindowTest, an_idle_picture_costs_no_processor_time) {
  station_->start_kiosk();
  const auto ticks = [&] {
    std::ifstream stat("/proc/" + std::to_string(station_->kiosk().pid()) + "/stat");
    std::string word;
    long user = 0, system = 0;
    for (int i = 0; i < 13; ++i) stat >> word;
    stat >> user >> system;
    return user + system;
  };
  // Anything still to be drawn is drawn by the time the kiosk has been silent for a while.
  std::string before;
  do {
    before = station_->kiosk().last("picture ");
    ::usleep(500'000);
  } while (station_->kiosk().last("picture ") != before);
  const long start = ticks();
  ::usleep(2'000'000);
  EXPECT_LE(ticks() - start, 4) << "hundredths of a second in two seconds of standing still";
  EXPECT_EQ(station_->kiosk().last("picture "), before);
}

}  // namespace
}  // namespace prismesh::test
