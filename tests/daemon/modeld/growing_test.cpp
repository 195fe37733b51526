// The document keeper with edits that add and remove shells: restarts, saves in place, interrupted saves, undo beyond a save.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>

#include <gtest/gtest.h>

#include "daemon/modeld/document_keeper.h"
#include "mesh/document/edit_json.h"
#include "mesh/model/topology_change.h"
#include "tests/daemon/modeld/folder.h"

namespace prismesh::modeld {
namespace {

namespace fs = std::filesystem;
using namespace mesh::document;
using test::Folder;

std::string content_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Growing : public ::testing::Test {
 protected:
  DocumentKeeper keeper() const { return DocumentKeeper(StateFolder(folder_.state())); }
  static void open(DocumentKeeper& keeper, const fs::path& deck) {
    ipc::Open request;
    request.path = deck.string();
    const Result<bool> opened = keeper.open(request, {});
    ASSERT_TRUE(opened) << opened.error().text();
  }
  static EditReport edit(DocumentKeeper& keeper, const std::string& json) {
    const Result<EditReport> report = keeper.edit(parse_edit(json).value());
    EXPECT_TRUE(report) << json << ": " << report.error().text();
    return report.value_or(EditReport{});
  }
  static void expect_same(const Generation& a, const Generation& b) {
    ASSERT_EQ(a.model.node_count(), b.model.node_count());
    ASSERT_EQ(a.model.shell_count(), b.model.shell_count());
    for (std::size_t n = 0; n < a.model.node_count(); ++n) {
      EXPECT_EQ(a.model.positions[n], b.model.positions[n]);
      EXPECT_EQ(a.model.node_ids[n], b.model.node_ids[n]);
      EXPECT_EQ(a.node_marks[n], b.node_marks[n]);
    }
    for (std::size_t s = 0; s < a.model.shell_count(); ++s) EXPECT_EQ(a.model.shell_nodes[s], b.model.shell_nodes[s]);
    EXPECT_EQ(a.counts, b.counts);
  }
  Folder folder_;
};

constexpr auto kSplit = R"({"edit":"split","at":["shell:1"]})";
constexpr auto kMove = R"({"edit":"translate","by":[0,0,0.05],"on":"1"})";

TEST_F(Growing, comes_back_after_a_restart_and_can_be_undone) {
  const fs::path deck = folder_.two_files();
  DocumentKeeper first = keeper();
  open(first, deck);
  EXPECT_EQ(edit(first, kSplit).elements_added, 1u);
  EXPECT_EQ(first.state().shells, 3u);
  EXPECT_TRUE(first.changed());
  edit(first, kMove);
  {
    const Generation before = first.document().current();
    first = keeper();  // ends without closing, as if killed
    DocumentKeeper second = keeper();
    open(second, deck);
    expect_same(before, second.document().current());
    edit(second, R"({"edit":"undo"})");
    EXPECT_EQ(edit(second, R"({"edit":"undo"})").elements_removed, 1u);
    EXPECT_EQ(second.state().shells, 2u);
    EXPECT_FALSE(second.changed());
  }
}

TEST_F(Growing, a_save_in_place_keeps_the_selection) {
  const fs::path deck = folder_.two_files();
  DocumentKeeper first = keeper();
  open(first, deck);
  edit(first, kSplit);
  edit(first, R"({"edit":"select","expr":"4,5,6"})");
  const std::uint64_t number = first.document().current().number;
  const Result<ipc::Saved> saved = first.save(std::nullopt);
  ASSERT_TRUE(saved) << saved.error().text();
  ASSERT_FALSE(saved->notes.empty());
  EXPECT_NE(saved->notes.back().find("begins anew"), std::string::npos);
  EXPECT_EQ(first.state().shells, 3u);
  EXPECT_EQ(first.state().selected_nodes, 3u);
  EXPECT_FALSE(first.changed());
  EXPECT_GT(first.document().current().number, number) << "views see another state";
  edit(first, kMove);
  EXPECT_TRUE(first.changed());
  const Generation before = first.document().current();
  first = keeper();
  DocumentKeeper second = keeper();
  open(second, deck);
  expect_same(before, second.document().current());
  EXPECT_EQ(second.state().shells, 3u);
}

TEST_F(Growing, undo_and_redo_beyond_a_save_are_restored) {
  const fs::path deck = folder_.two_files();
  DocumentKeeper first = keeper();
  open(first, deck);
  edit(first, kMove);
  ASSERT_TRUE(first.save(std::nullopt));
  edit(first, kSplit);
  const std::vector<std::string> steps{"undo", "undo", "redo", "redo", "undo", "redo", "undo", "undo", "redo", "redo"};
  for (const std::string& step : steps) {
    edit(first, R"({"edit":")" + step + "\"}");
    const Generation before = first.document().current();
    const bool can_undo = first.state().can_undo;
    first = keeper();
    open(first, deck);
    expect_same(before, first.document().current());
    if (HasFailure()) return;
    if (!first.state().can_undo && can_undo) break;  // the history before the save isn't kept over a restart
  }
}

TEST_F(Growing, undo_beyond_a_save_without_a_restart) {
  const fs::path deck = folder_.two_files();
  DocumentKeeper first = keeper();
  open(first, deck);
  edit(first, kMove);
  ASSERT_TRUE(first.save(std::nullopt));
  edit(first, kSplit);
  for (const std::string step : {"undo", "undo", "redo", "redo", "undo", "redo"}) edit(first, R"({"edit":")" + step + "\"}");
  const Generation before = first.document().current();
  EXPECT_EQ(mesh::live_shells(before.model), 3u);
  first = keeper();
  open(first, deck);
  expect_same(before, first.document().current());
}

TEST_F(Growing, what_is_carried_over_a_save_removes_no_undo_step) {
  const fs::path deck = folder_.two_files();
  DocumentKeeper first = keeper();
  open(first, deck);
  edit(first, kSplit);
  const std::size_t for_the_split_alone = first.document().current().own_bytes;
  ASSERT_TRUE(first.close(true));
  first = DocumentKeeper(StateFolder(folder_.state()), for_the_split_alone);
  open(first, deck);
  edit(first, kMove);
  edit(first, R"({"edit":"select","expr":"4,5,6"})");
  edit(first, kSplit);
  edit(first, R"({"edit":"undo"})");
  ASSERT_TRUE(first.save(std::nullopt));
  edit(first, R"({"edit":"redo"})");
  EXPECT_EQ(mesh::live_shells(first.document().current().model), 3u);
  ASSERT_TRUE(first.state().can_undo);
  edit(first, R"({"edit":"undo"})");
  const Generation shown = first.document().current();
  EXPECT_EQ(mesh::live_shells(shown.model), 2u);
  first = keeper();
  open(first, deck);
  expect_same(shown, first.document().current());
}

TEST_F(Growing, an_undo_that_the_journal_cant_hold_is_refused_and_the_journal_matches_the_document) {
  const fs::path deck = folder_.two_files();
  DocumentKeeper first = keeper();
  open(first, deck);
  edit(first, kMove);
  edit(first, kSplit);
  edit(first, R"({"edit":"undo"})");
  // Restarted without memory for a history: the document still has its undo steps, the journal that begins with the save keeps none.
  first = DocumentKeeper(StateFolder(folder_.state()), 1);
  open(first, deck);
  ASSERT_TRUE(first.save(std::nullopt));
  edit(first, R"({"edit":"redo"})");
  const Generation shown = first.document().current();
  EXPECT_EQ(mesh::live_shells(shown.model), 3u);
  const Result<EditReport> undone = first.edit(parse_edit(R"({"edit":"undo"})").value());
  ASSERT_FALSE(undone);
  EXPECT_NE(undone.error().message.find("the journal no longer has the state before it"), std::string::npos) << undone.error().message;
  expect_same(shown, first.document().current());
  first = keeper();
  open(first, deck);
  expect_same(shown, first.document().current());
}

TEST_F(Growing, a_cancelled_edit_changes_nothing) {
  const fs::path deck = folder_.sheet();
  DocumentKeeper first = keeper();
  open(first, deck);
  edit(first, R"({"edit":"translate","by":[3,3,9],"on":"1313"})");
  const std::uint64_t number = first.document().current().number;
  const std::uint64_t journalled = first.state().journalled_edits;
  const Result<EditReport> stopped = first.edit(parse_edit(R"({"edit":"repair","scope":"all"})").value(), [](double) { return false; });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().message, "cancelled");
  EXPECT_EQ(first.document().current().number, number);
  EXPECT_EQ(first.state().journalled_edits, journalled);
}

TEST_F(Growing, a_cancelled_repair_that_is_kept_comes_back_after_a_restart) {
  const fs::path deck = folder_.sheet();
  DocumentKeeper first = keeper();
  open(first, deck);
  edit(first, R"({"edit":"translate","by":[3,3,9],"on":"1313"})");
  int calls = 0;
  const Progress keeping{[&](double) { return ++calls < 30; }, [] { return true; }};
  const Result<EditReport> kept = first.edit(parse_edit(R"({"edit":"repair","scope":"all"})").value(), keeping);
  ASSERT_TRUE(kept) << kept.error().text();
  ASSERT_TRUE(kept->stopped);
  const Generation shown = first.document().current();
  first = keeper();
  open(first, deck);
  expect_same(shown, first.document().current());
  edit(first, R"({"edit":"undo"})");
  EXPECT_TRUE(first.state().can_redo);
}

/// All files in a folder and below, with their content.
std::map<std::string, std::string> everything_in(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) all[entry.path().string()] = content_of(entry.path());
  return all;
}

TEST_F(Growing, a_cancelled_save_changes_no_file_before_the_first_is_replaced) {
  const fs::path deck = folder_.two_files();
  DocumentKeeper first = keeper();
  open(first, deck);
  edit(first, kSplit);
  edit(first, kMove);
  const std::map<std::string, std::string> before = everything_in(folder_.path());
  int stops = 0;
  for (bool elsewhere : {true, false}) {
    const auto target = elsewhere ? std::optional((folder_.path() / "other" / "main.k").string()) : std::nullopt;
    for (int wanted = 0;; ++wanted) {
      int calls = 0;
      double reached = 0;
      const Result<ipc::Saved> saved = first.save(target, [&](double fraction) {
        EXPECT_GE(fraction, reached);
        EXPECT_LE(reached = fraction, 1 + 1e-9);
        return calls++ < wanted;
      });
      if (saved) {
        EXPECT_GT(reached, 0.99);
        break;
      }
      ++stops;
      EXPECT_EQ(saved.error().message, "cancelled");
      ASSERT_EQ(everything_in(folder_.path()), before) << "cancelled at call " << wanted;
      EXPECT_EQ(first.changed(), elsewhere) << "what is saved elsewhere counts as saved";
    }
    if (elsewhere) fs::remove_all(folder_.path() / "other");
  }
  EXPECT_GE(stops, 4) << "before and while the cards are made, and before the files are put in place, of both saves";
  EXPECT_NE(content_of(deck), before.at(deck.string()));
  EXPECT_FALSE(first.changed());
  edit(first, kMove);
  EXPECT_TRUE(first.save(std::nullopt));
}

}  // namespace
}  // namespace prismesh::modeld
