#include "kiosk/link/notice_words.h"

#include <gtest/gtest.h>

#include "base/progress.h"
#include "kiosk/link/result_words.h"
#include "mesh/document/edit_kinds.h"

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

/// The line of an edit as it is sent, with this report.
std::string result_of(const mesh::document::Edit& edit, mesh::document::EditReport report) {
  report.edit = mesh::document::name(edit);
  return result_words(words_of_edit(edit, "mm"), report, "mm");
}

TEST(ResultWords, say_in_a_line_what_an_edit_did) {
  using namespace mesh::document;
  EditReport report;
  report.nodes_moved = 12;
  report.largest_move = 1.2984;
  report.before.fail = report.after.fail = 2;
  report.mass_before = 0.5;
  report.mass_after = 0.504;
  Rotate turn;
  turn.degrees = 10;
  EXPECT_EQ(result_of(turn, report), "Turned 10\u00b0: 12 nodes, at most 1.3 mm; fail 2 \u2192 2; mass +0.8 %");
  report.nodes_moved = 1;
  report.mass_after = 0.49985;
  report.after.fail = 3;
  Lift lift;
  lift.distance = -12.345;
  EXPECT_EQ(result_of(lift, report), "Lifted 12.3 mm: 1 node, at most 1.3 mm; fail 2 \u2192 3; mass -0.03 %");
  report.mass_after = report.mass_before;
  Translate move;
  move.by = {3, 0, 4};
  EXPECT_EQ(result_of(move, report), "Moved 5 mm: 1 node, at most 1.3 mm; fail 2 \u2192 3") << "the mass stays";
  report.mass_before = 0;
  EXPECT_EQ(result_of(move, report), "Moved 5 mm: 1 node, at most 1.3 mm; fail 2 \u2192 3") << "no share of nothing";
  Move by_hand;
  by_hand.by = {0, 0, 2};
  by_hand.degrees = 3.5;
  EXPECT_EQ(result_of(by_hand, report), "Moved 2 mm, turned 3.5\u00b0: 1 node, at most 1.3 mm; fail 2 \u2192 3");
}

TEST(ResultWords, of_what_mends_say_how_the_figures_and_the_structure_change) {
  using namespace mesh::document;
  EditReport report;
  report.before = {10, 124, 4};
  report.after = {134, 20, 0};
  report.clusters_before = 2;
  report.nodes_moved = 40;
  report.largest_move = 0.25;
  report.elements_added = 7;
  report.elements_removed = 5;
  EXPECT_EQ(result_of(Repair{}, report),
            "Repaired: 40 nodes, at most 0.25 mm; 7 elements made, 5 removed; warn 124 \u2192 20; fail 4 \u2192 0; clusters of triangles 2 "
            "\u2192 0");
  EXPECT_EQ(result_of(Relax{}, EditReport()), "Relaxed: nothing was changed") << "that nothing changed is told, too";
}

TEST(ResultWords, of_undo_and_redo_say_what_they_undid) {
  using namespace mesh::document;
  EditReport report;
  report.notes = {"undid lift"};
  EXPECT_EQ(result_of(Undo{}, report), "Undid lift") << "it changed no figures";
  report.nodes_moved = 3;
  report.largest_move = 2;
  report.before.fail = 9;
  EXPECT_EQ(result_of(Undo{}, report), "Undid lift: 3 nodes, at most 2 mm; fail 9 \u2192 0");
  EXPECT_EQ(result_of(Grow{}, report), "") << "what a selection did is in the picture";
  EXPECT_EQ(result_of(SetParts{}, report), "");
}

TEST(NoticeWords, an_edit_is_noticed_only_for_what_its_line_has_no_room_for) {
  mesh::document::EditReport repair;
  repair.edit = "repair";
  repair.mass_before = 2;
  repair.mass_after = 2.5;
  EXPECT_FALSE(notice_of_notes(repair, "Repaired: 3 nodes"));
  repair.notes = {"stopped in round 3", "part 7 is locked"};
  expect_notice(notice_of_notes(repair, "Repaired: 3 nodes"), Notice::Kind::information,
                "Repaired: 3 nodes\nstopped in round 3\npart 7 is locked");
  repair.edit = "hide";
  expect_notice(notice_of_notes(repair, ""), Notice::Kind::information, "stopped in round 3\npart 7 is locked");
  repair.edit = "undo";
  repair.notes = {"undid lift"};
  EXPECT_FALSE(notice_of_notes(repair, "Undid lift")) << "the line says it";
  repair.notes.push_back("stopped after 2 of 3 steps");
  expect_notice(notice_of_notes(repair, "Undid 2 steps"), Notice::Kind::information, "Undid 2 steps\nstopped after 2 of 3 steps");
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
