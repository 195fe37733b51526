#include "kiosk/link/notice_words.h"

#include <gtest/gtest.h>

#include "base/progress.h"

namespace prismesh::kiosk::link {
namespace {

using notices::Notice;

const ipc::Failed kStopped{"", 0, cancelled().message};
const ipc::Failed kRefused{"a.k", 7, "no such node"};

void expect_notice(const std::optional<Notice>& notice, Notice::Kind kind, const std::string& text) {
  ASSERT_TRUE(notice);
  EXPECT_EQ(notice->kind, kind) << text;
  EXPECT_EQ(notice->text, text);
  EXPECT_EQ(notice->document, 0u) << "the link adds it";
}

TEST(NoticeWords, what_was_stopped_is_no_error) {
  EXPECT_TRUE(was_stopped(kStopped));
  EXPECT_FALSE(was_stopped(kRefused));
  expect_notice(notice_of_failure(kStopped, "nothing was saved"), Notice::Kind::information, "Stopped: nothing was saved.");
  expect_notice(notice_of_failure(kRefused, "nothing was saved"), Notice::Kind::error, "a.k:7: no such node");
  expect_notice(notice_of_failed_opening(kStopped, "/decks/b.k"), Notice::Kind::information, "Stopped: b.k was not opened.");
  expect_notice(notice_of_failed_opening(kRefused, "/decks/b.k"), Notice::Kind::error, "b.k was not opened. a.k:7: no such node");
  expect_notice(notice_of_missing_server(), Notice::Kind::error,
                "The model server is not running: nothing was done. It will be tried again.");
}

TEST(NoticeWords, saving_tells_the_lines_a_remark_and_notes_which_make_it_a_warning) {
  ipc::Saved saved;
  saved.path = "/decks/a.k";
  saved.lines_changed = 3;
  expect_notice(notice_of_saving(saved, {}), Notice::Kind::information, "Saved /decks/a.k: 3 lines changed.");
  expect_notice(notice_of_saving(saved, "It goes on."), Notice::Kind::information, "Saved /decks/a.k: 3 lines changed. It goes on.");
  saved.notes = {"one", "two"};
  expect_notice(notice_of_saving(saved, {}), Notice::Kind::warning, "Saved /decks/a.k: 3 lines changed.\none\ntwo");
  expect_notice(notice_of_kept_edits("a.k"), Notice::Kind::information,
                "The unsaved edits of a.k are kept: they come back when it is opened again.");
}

TEST(NoticeWords, recovered_edits_are_told_where_they_change_the_deck) {
  ipc::DocumentState state;
  state.path = "/decks/a.k";
  state.changed = true;
  EXPECT_FALSE(notice_of_recovery(state));
  state.recovered_edits = 1;
  expect_notice(notice_of_recovery(state), Notice::Kind::warning, "1 edit of a.k that had not been saved was recovered.");
  state.recovered_edits = 2;
  expect_notice(notice_of_recovery(state), Notice::Kind::warning, "2 edits of a.k that had not been saved were recovered.");
  state.changed = false;
  EXPECT_FALSE(notice_of_recovery(state)) << "a selection that a save has carried over";
}

TEST(NoticeWords, of_the_deck_s_warnings_the_worst_is_told_and_the_list_has_all) {
  EXPECT_FALSE(notice_of_warnings({}));
  const notices::ToldWarning error{true, "a.k:3", "node 7 is missing"}, warning{false, "b.k", "odd"};
  expect_notice(notice_of_warnings(std::vector{warning}), Notice::Kind::warning, "b.k: odd");
  EXPECT_FALSE(notice_of_warnings(std::vector{warning})->lists_warnings);
  const std::vector both{error, warning};
  expect_notice(notice_of_warnings(both), Notice::Kind::error,
                "a.k:3: node 7 is missing\n1 error and 1 warning about this deck: Ctrl+I lists them.");
  EXPECT_TRUE(notice_of_warnings(both)->lists_warnings);
}

TEST(NoticeWords, a_report_is_told_if_it_mends_or_has_something_to_tell) {
  mesh::document::EditReport report;
  report.edit = "translate";
  EXPECT_FALSE(notice_of_report(report));
  report.mass_before = 2;
  report.mass_after = 2.5;
  expect_notice(notice_of_report(report), Notice::Kind::information, "mass 2 \u2192 2.5");
  report.centre_before = {0, 0, 0};
  report.centre_after = {1, 0, 0};
  expect_notice(notice_of_report(report), Notice::Kind::information, "mass 2 \u2192 2.5, centre of gravity (0 0 0) \u2192 (1 0 0)");

  mesh::document::EditReport repair;
  repair.edit = "repair";
  expect_notice(notice_of_report(repair), Notice::Kind::information, "repair: warn 0 \u2192 0, fail 0 \u2192 0");
  repair.before.fail = 4;
  repair.clusters_before = 2;
  repair.notes = {"stopped in round 3"};
  expect_notice(notice_of_report(repair), Notice::Kind::information,
                "repair: warn 0 \u2192 0, fail 4 \u2192 0, clusters of triangles 2 \u2192 0\nstopped in round 3");
}

TEST(NoticeWords, progress_says_what_is_done_and_how_to_stop_it) {
  EXPECT_EQ(words_of_opening("a.k"), "Opening a.k ..   Esc stops it");
  EXPECT_EQ(words_of_progress({"open", 0.5}, true), "Opening ..   Esc stops it");
  EXPECT_EQ(words_of_progress({"relax", 0.5}, false), "Relaxing ..");
  EXPECT_EQ(words_of_progress({"save", 0.5}, true), "Save ..   Esc stops it");
  const ipc::ProgressMade repair{"repair", 0.5, "round 3", 25};
  EXPECT_EQ(words_of_progress(repair, false), "Repairing: round 3, 25 s ..");
  EXPECT_EQ(words_of_progress(repair, true), "Repairing: round 3, 25 s\nEsc stops and discards it, Shift+Esc stops and keeps it");
}

}  // namespace
}  // namespace prismesh::kiosk::link
