// Unsaved edits at the door: quitting asks, starting with another deck asks in a window, and what is kept comes back and is announced.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/station/station_test_case.h"
#include "tests/support/places.h"

namespace prismesh::test {
namespace {

class UnsavedEditsTest : public StationTestCase {
 protected:
  void start_and_edit() {
    station_->start_kiosk();
    station_->key("e");
    station_->type("1200-1260");
    ASSERT_FALSE(station_->kiosk().wait_for("counted 61").empty());
    station_->key("Return");
    ASSERT_TRUE(station_->wait_for_selection(61));
    station_->key("n");
    station_->type("6");
    station_->key("Return");
    ASSERT_FALSE(station_->kiosk().wait_for("drag committed").empty());
    ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
    ASSERT_TRUE(station_->kiosk().last("generation ").ends_with("changed 1"));
  }
  void ask_to_quit(const char* keys) {
    station_->kiosk().skip_lines();
    station_->key(keys);
    EXPECT_EQ(station_->kiosk().wait_for("asks "), "asks quit " + station_->deck().string());
    ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
  }
  void expect_recovered(const std::string& name) {
    EXPECT_NE(station_->kiosk().wait_for("notice warning").find("edits of " + name + " that had not been saved were recovered"),
              std::string::npos);
  }
  std::filesystem::path other() const {
    write_sheet(station_->folder() / "other.k");
    return station_->folder() / "other.k";
  }
};

TEST_F(UnsavedEditsTest, quitting_asks_and_can_be_given_up) {
  start_and_edit();
  for (const char* keys : {"alt+F4", "ctrl+q"}) {
    ask_to_quit(keys);
    station_->show_people(std::string("quit_") + keys);
    station_->key("Escape");
    EXPECT_EQ(station_->kiosk().wait_for("asks "), "asks nothing");
    ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
    EXPECT_TRUE(station_->kiosk().running());
  }
  EXPECT_EQ(whole_file(station_->deck()), original_);
}

TEST_F(UnsavedEditsTest, quitting_can_save) {
  start_and_edit();
  ask_to_quit("alt+F4");
  station_->key("s");
  EXPECT_EQ(station_->kiosk().wait_for_exit(), 0);
  EXPECT_NE(whole_file(station_->deck()), original_);
}

TEST_F(UnsavedEditsTest, what_cannot_be_saved_keeps_the_window_open) {
  start_and_edit();
  std::ofstream(station_->deck(), std::ios::app) << "$ by somebody else\n";
  ask_to_quit("alt+F4");
  station_->key("s");
  EXPECT_FALSE(station_->kiosk().wait_for("notice error").empty());
  ask_to_quit("alt+F4");
}

TEST_F(UnsavedEditsTest, quitting_can_discard) {
  start_and_edit();
  ask_to_quit("ctrl+q");
  station_->key("d");
  EXPECT_EQ(station_->kiosk().wait_for_exit(), 0);
  station_->start_kiosk();
  EXPECT_TRUE(station_->kiosk().last("generation ").ends_with("changed 0"));
  EXPECT_EQ(whole_file(station_->deck()), original_);
}

TEST_F(UnsavedEditsTest, kept_at_quitting_they_are_there_and_announced_at_the_next_start) {
  start_and_edit();
  ask_to_quit("alt+F4");
  station_->key("k");
  EXPECT_EQ(station_->kiosk().wait_for_exit(), 0);
  station_->kill_model_server();
  station_->start_model_server();
  station_->start_kiosk();
  EXPECT_TRUE(station_->kiosk().last("generation ").ends_with("changed 1"));
  EXPECT_NE(station_->kiosk().last("reads ").find("edits of sheet.k that had not been saved were recovered"), std::string::npos)
      << "what is on the screen";
  station_->show_people("recovered");
}

TEST_F(UnsavedEditsTest, without_any_quitting_asks_nothing) {
  station_->start_kiosk();
  station_->key("ctrl+q");
  EXPECT_EQ(station_->kiosk().wait_for_exit(), 0);
}

TEST_F(UnsavedEditsTest, kept_while_another_deck_is_opened_they_come_back_with_their_deck) {
  start_and_edit();
  const std::filesystem::path next = other();
  station_->open_in_another_kiosk(next);
  EXPECT_EQ(station_->kiosk().wait_for("asks "), "asks unsaved " + next.string());
  ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
  station_->show_people("another_deck_at_start");
  station_->key("k");
  EXPECT_FALSE(station_->kiosk().wait_for("document " + next.string()).empty());
  EXPECT_EQ(whole_file(station_->deck()), original_);
  station_->open_in_another_kiosk(station_->deck());
  EXPECT_FALSE(station_->kiosk().wait_for("document " + station_->deck().string()).empty());
  expect_recovered("sheet.k");
  EXPECT_FALSE(station_->kiosk()
                   .wait_until([](const std::string& line) { return line.starts_with("generation ") && line.ends_with("changed 1"); })
                   .empty());
}

TEST_F(UnsavedEditsTest, a_station_started_with_another_deck_opens_its_window_and_asks) {
  start_and_edit();
  station_->kill_model_server();
  const std::filesystem::path next = other();
  // The station's own programs, with a kiosk that says what it does.
  const std::filesystem::path programs = station_->folder() / "programs";
  std::filesystem::create_directory(programs);
  for (const char* program : {"prismesh", "prismesh-modeld", "prismesh-deviced"})
    std::filesystem::create_symlink(programs_folder() / program, programs / program);
  std::ofstream(programs / "prismesh-kiosk") << "#!/bin/sh\nexec '" << (programs_folder() / "prismesh-kiosk").string()
                                             << "' --trace --size 1000x640 \"$@\"\n";
  std::filesystem::permissions(programs / "prismesh-kiosk", std::filesystem::perms::owner_all);
  Process whole({(source_folder() / "demo/station").string(), next.string()},
                {{"DISPLAY", station_->display().name()},
                 {"HOME", (station_->folder() / "home").string()},
                 {"XDG_CONFIG_HOME", (station_->folder() / "config").string()},
                 {"PRISMESH_PROGRAMS", programs.string()},
                 {"RUNTIME_DIRECTORY", (station_->folder() / "run").string()},
                 {"STATE_DIRECTORY", (station_->folder() / "state").string()}});
  EXPECT_EQ(whole.wait_for("asks "), "asks unsaved " + next.string()) << whole.standard_error();
  EXPECT_FALSE(whole.wait_until([](const std::string& line) { return line.starts_with("picture ") && !line.ends_with("none"); }).empty());
  station_->show_people("station_with_another_deck");
  station_->display().server().kill(SIGKILL);  // its daemons end with the window
  EXPECT_NE(whole.wait_for_exit(), -1);
}

}  // namespace
}  // namespace prismesh::test
