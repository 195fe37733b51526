// Saving elsewhere and opening another deck: nothing of the user's is replaced or given up unasked.
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/station/station_test_case.h"

namespace prismesh::test {
namespace {

class DeckFilesTest : public StationTestCase {
 protected:
  void start() {
    station_->start_kiosk();
    station_->key("e");
    station_->type("1200-1260");
    ASSERT_FALSE(station_->kiosk().wait_for("counted 61").empty());
    station_->key("Return");
    ASSERT_TRUE(station_->wait_for_selection(61));
    lift();
  }
  void lift() {
    station_->kiosk().skip_lines();
    station_->key("n");
    station_->type("6");
    station_->key("Return");
    ASSERT_FALSE(station_->kiosk().wait_for("drag committed").empty());
  }
  void enter_path(const char* command, const std::filesystem::path& path) {
    station_->kiosk().skip_lines();
    station_->key(command);
    station_->key("ctrl+a");
    station_->type(path.string());
    station_->key("Return");
  }
  std::string generation_after_saving() {
    return station_->kiosk().wait_until(
        [](const std::string& line) { return line.starts_with("generation ") && line.ends_with("changed 0"); });
  }
  std::filesystem::path in_folder(const char* name) const { return station_->folder() / name; }
};

TEST_F(DeckFilesTest, save_as_becomes_the_document_and_later_saves_go_there) {
  start();
  const std::filesystem::path other = in_folder("variant.k");
  enter_path("ctrl+shift+s", other);
  EXPECT_TRUE(station_->kiosk().wait_for("saved ").ends_with(other.string())) << "nothing is in the way: nothing is asked";
  const std::string aim = station_->kiosk().last("aim ");
  const std::string after = generation_after_saving();
  EXPECT_NE(after.find("selected 61"), std::string::npos) << after;
  ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
  EXPECT_EQ(station_->kiosk().last("aim "), aim) << "the view stays where it was";
  const std::string first = whole_file(other);
  EXPECT_FALSE(compare_decks(original_, first).nodes.empty());
  lift();
  station_->key("ctrl+s");
  EXPECT_TRUE(station_->kiosk().wait_for("saved ").ends_with(other.string()));
  EXPECT_NE(whole_file(other), first);
  EXPECT_EQ(whole_file(station_->deck()), original_) << "the user's deck must not change";
  // The history continues after it: both lifts can be undone.
  for (int step = 0; step < 2; ++step) station_->key("ctrl+z");
  EXPECT_EQ(nodes_of_deck(station_->save_copy("undone.k")), nodes_);
}

TEST_F(DeckFilesTest, a_file_is_replaced_and_a_folder_made_only_when_the_user_says_so) {
  start();
  const std::filesystem::path mine = in_folder("mine.k");
  std::ofstream(mine) << "mine\n";
  for (const char* command : {"ctrl+shift+s", "ctrl+shift+c"}) {
    enter_path(command, mine);
    EXPECT_EQ(station_->kiosk().wait_for("asks "), "asks write replace 1 make 0") << command;
    ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
    station_->show_people(std::string("replace_") + command);
    station_->key("Return");  // a second Return by mistake
    station_->key("Escape");
    EXPECT_EQ(station_->kiosk().wait_for("asks "), "asks nothing") << command;
    EXPECT_EQ(whole_file(mine), "mine\n") << command;
  }
  const std::filesystem::path made = in_folder("new/deck.k");
  enter_path("ctrl+shift+c", made);
  EXPECT_EQ(station_->kiosk().wait_for("asks "), "asks write replace 0 make 1");
  EXPECT_FALSE(std::filesystem::exists(made.parent_path()));
  station_->key("m");
  EXPECT_TRUE(station_->kiosk().wait_for("saved ").ends_with(made.string()));
  enter_path("ctrl+shift+s", mine);
  EXPECT_EQ(station_->kiosk().wait_for("asks "), "asks write replace 1 make 0");
  station_->key("r");
  EXPECT_TRUE(station_->kiosk().wait_for("saved ").ends_with(mine.string()));
  EXPECT_EQ(whole_file(mine), whole_file(made));
}

TEST_F(DeckFilesTest, a_copy_leaves_the_document_and_its_unsaved_edits_as_they_are) {
  start();
  EXPECT_NE(station_->save_copy("copy.k"), original_);
  EXPECT_TRUE(station_->kiosk().last("generation ").ends_with("changed 1"));
  station_->kiosk().skip_lines();
  station_->key("ctrl+s");
  EXPECT_TRUE(station_->kiosk().wait_for("saved ").ends_with(station_->deck().string()));
}

TEST_F(DeckFilesTest, a_report_of_the_unsaved_edits_is_written_beside_the_deck) {
  start();
  const std::filesystem::path page = in_folder((station_->deck().stem().string() + "-report.html").c_str());
  station_->key("ctrl+shift+w");
  ASSERT_EQ(station_->kiosk().wait_for("report "), "report begun");
  ASSERT_EQ(station_->kiosk().wait_for("report "), "report written");
  const std::string text = whole_file(page);
  EXPECT_NE(text.find("<li><code>lift</code></li>"), std::string::npos) << "it lists the edits";
  EXPECT_NE(text.find("data:image/png;base64,"), std::string::npos) << "it has its pictures";
  EXPECT_EQ(whole_file(station_->deck()), original_);
  EXPECT_TRUE(station_->kiosk().last("generation ").ends_with("changed 1")) << "the edits are still unsaved";
  station_->show_people("report_written");
  station_->kiosk().skip_lines();
  station_->key("ctrl+s");
  ASSERT_TRUE(station_->kiosk().wait_for("saved ").ends_with(station_->deck().string()));
  ASSERT_FALSE(generation_after_saving().empty());
  station_->key("ctrl+shift+w");
  EXPECT_TRUE(station_->kiosk().wait_for("notice ").starts_with("notice information There are no unsaved edits to report"));
  EXPECT_FALSE(std::filesystem::exists(in_folder((station_->deck().stem().string() + "-report-2.html").c_str())));
}

TEST_F(DeckFilesTest, with_unsaved_edits_another_deck_is_opened_after_saving_discarding_or_not_at_all) {
  start();
  const std::filesystem::path other = in_folder("other.k");
  write_sheet(other);
  enter_path("ctrl+o", other);
  EXPECT_EQ(station_->kiosk().wait_for("asks "), "asks unsaved " + other.string());
  ASSERT_FALSE(station_->kiosk().wait_for("picture ").empty());
  station_->show_people("unsaved");
  station_->key("Escape");
  EXPECT_EQ(station_->kiosk().wait_for("asks "), "asks nothing");
  EXPECT_EQ(whole_file(station_->deck()), original_);

  enter_path("ctrl+o", other);
  ASSERT_FALSE(station_->kiosk().wait_for("asks unsaved").empty());
  station_->key("s");
  EXPECT_TRUE(station_->kiosk().wait_for("saved ").ends_with(station_->deck().string()));
  EXPECT_FALSE(station_->kiosk().wait_for("document " + other.string()).empty());
  const std::string edited = whole_file(station_->deck());
  EXPECT_NE(edited, original_);

  station_->key("e");
  station_->type("1200-1260");
  station_->key("Return");
  ASSERT_TRUE(station_->wait_for_selection(61));
  lift();
  enter_path("ctrl+o", station_->deck());
  ASSERT_FALSE(station_->kiosk().wait_for("asks unsaved").empty());
  station_->key("d");
  EXPECT_FALSE(station_->kiosk().wait_for("document " + station_->deck().string()).empty());
  EXPECT_EQ(whole_file(other), original_) << "discarded";
  EXPECT_EQ(whole_file(station_->deck()), edited);
}

TEST_F(DeckFilesTest, what_cannot_be_saved_or_opened_keeps_the_edits) {
  start();
  const std::filesystem::path missing = in_folder("missing.k");
  enter_path("ctrl+o", missing);
  ASSERT_FALSE(station_->kiosk().wait_for("asks unsaved").empty());
  station_->key("d");
  EXPECT_NE(station_->kiosk().wait_for("notice error").find("missing.k was not opened"), std::string::npos);
  EXPECT_TRUE(station_->kiosk().last("generation ").ends_with("changed 1"));
  // A deck that something else has changed isn't saved over, and so the other one isn't opened.
  const std::filesystem::path other = in_folder("other.k");
  write_sheet(other);
  std::ofstream(station_->deck(), std::ios::app) << "$ by somebody else\n";
  enter_path("ctrl+o", other);
  ASSERT_FALSE(station_->kiosk().wait_for("asks unsaved").empty());
  station_->key("s");
  EXPECT_FALSE(station_->kiosk().wait_for("notice error").empty());
  EXPECT_TRUE(station_->kiosk().last("generation ").ends_with("changed 1"));
}

TEST_F(DeckFilesTest, a_deck_that_cannot_be_opened_is_told_in_the_box) {
  start();
  station_->key("ctrl+s");
  ASSERT_FALSE(generation_after_saving().empty());
  const std::filesystem::path missing = in_folder("missing.k");
  enter_path("ctrl+o", missing);
  ASSERT_FALSE(station_->kiosk().wait_for("item \"open problem\"").empty());
  station_->settled_aim();
  ASSERT_TRUE(station_->item("open problem") && station_->item("path"));
  EXPECT_NE(station_->item("open problem")->state.find("missing.k"), std::string::npos);
  EXPECT_EQ(station_->item("path")->state, missing.string()) << "one goes on with what was typed";
  station_->show_people("open_problem");
  const std::filesystem::path other = in_folder("other.k");
  write_sheet(other);
  station_->key("ctrl+a");
  station_->type(other.string());
  station_->key("Return");
  EXPECT_FALSE(station_->kiosk().wait_for("document " + other.string()).empty());
}

TEST_F(DeckFilesTest, the_empty_screen_opens_a_recent_deck) {
  station_->start_kiosk();
  station_->settled_aim();
  station_->key("ctrl+q");
  EXPECT_EQ(station_->kiosk().wait_for_exit(), 0);
  station_->kill_model_server();
  std::filesystem::remove_all(station_->folder() / "state");
  station_->start_model_server();
  station_->start_empty_kiosk();
  station_->settled_aim();
  station_->show_people("empty");
  station_->click_item("open a deck");
  ASSERT_FALSE(station_->kiosk().wait_for("item \"file " + station_->deck().string()).empty());
  station_->settled_aim();
  station_->show_people("browser");
  station_->key("Down");
  station_->key("Return");
  EXPECT_FALSE(station_->kiosk().wait_for("document " + station_->deck().string()).empty());
}

TEST_F(DeckFilesTest, a_copy_over_the_open_deck_is_asked_about) {
  start();
  enter_path("ctrl+shift+c", station_->deck());
  ASSERT_EQ(station_->kiosk().wait_for("asks "), "asks write replace 1 make 0");
  station_->key("Escape");
  EXPECT_FALSE(station_->kiosk().wait_for("asks nothing").empty());
  EXPECT_EQ(whole_file(station_->deck()), original_);
  station_->kiosk().skip_lines();
  station_->key("ctrl+shift+c");
  station_->key("Return");  // the name that is offered is another one
  EXPECT_TRUE(station_->kiosk().wait_for("saved ").ends_with("sheet_copy.k"));
  EXPECT_EQ(whole_file(station_->deck()), original_);
}

TEST_F(DeckFilesTest, a_kiosk_started_with_another_deck_asks_too) {
  start();
  const std::filesystem::path other = in_folder("other.k");
  write_sheet(other);
  station_->open_in_another_kiosk(other);
  EXPECT_EQ(station_->kiosk().wait_for("asks "), "asks unsaved " + other.string());
  const std::string shown = station_->kiosk().wait_for("generation ");
  EXPECT_TRUE(shown.ends_with("changed 1")) << shown;
  ASSERT_FALSE(station_->kiosk()
                   .wait_until([&](const std::string& line) { return line.starts_with("picture ") && !line.ends_with("none"); })
                   .empty());
  station_->show_people("unsaved_at_start");
  station_->key("s");
  EXPECT_TRUE(station_->kiosk().wait_for("saved ").ends_with(station_->deck().string()));
  EXPECT_FALSE(station_->kiosk().wait_for("document " + other.string()).empty());
}

}  // namespace
}  // namespace prismesh::test
