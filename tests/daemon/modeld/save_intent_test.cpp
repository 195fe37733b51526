// Recovery from an interrupted save: the deck's files, and the journals of the deck before and after it.
#include "daemon/modeld/save_intent.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/modeld/document_keeper.h"
#include "mesh/document/edit_json.h"
#include "tests/daemon/modeld/folder.h"

namespace prismesh::modeld {
namespace {

namespace fs = std::filesystem;

Hash128 hash_of_text(const std::string& text) { return hash128(std::as_bytes(std::span(text))); }

void leave(const fs::path& file, const std::string& text) {
  fs::remove(file);
  if (!text.empty()) std::ofstream(file, std::ios::binary) << text;
}

/// A file of the deck as the next opening finds it; empty: missing.
struct LeftByACut {
  std::string target, temporary, settled;
};
struct CutOffSaveCase {
  const char* what;
  std::vector<LeftByACut> files;
  SaveOutcome outcome;
};

TEST(SaveIntents, are_settled_without_overwriting_what_others_wrote) {
  const LeftByACut replaced{"new", "", "new"}, waiting{"old", "new", "new"};
  const CutOffSaveCase cases[] = {
      {"before the first", {{"old", "new", "old"}, {"old", "new", "old"}}, SaveOutcome::not_begun},
      {"before the first, and one was changed", {{"old", "new", "old"}, {"other", "new", "other"}}, SaveOutcome::not_begun},
      {"after the last", {replaced, replaced}, SaveOutcome::complete},
      {"in between", {replaced, waiting, waiting}, SaveOutcome::finished},
      {"in between, the first waits", {waiting, replaced}, SaveOutcome::finished},
      {"a file that waits was changed", {replaced, {"other", "new", "other"}}, SaveOutcome::mixed},
      {"a file that waits was changed, others wait", {replaced, {"other", "new", "other"}, {"old", "new", "old"}}, SaveOutcome::mixed},
      {"a file that waits was removed", {replaced, {"", "new", ""}}, SaveOutcome::mixed},
      {"what was written for it was changed", {replaced, {"old", "other", "old"}}, SaveOutcome::mixed},
      {"what was written for it was removed", {replaced, {"old", "", "old"}}, SaveOutcome::mixed},
      {"a file that was replaced was changed", {replaced, {"other", "", "other"}}, SaveOutcome::mixed},
  };
  const test::Folder folder;
  for (const CutOffSaveCase& cut : cases) {
    SCOPED_TRACE(cut.what);
    SaveIntent intent;
    for (const LeftByACut& left : cut.files) {
      const std::string number = std::to_string(intent.files.size());
      intent.files.push_back(
          {folder.path() / ("deck" + number), folder.path() / ("staged" + number), hash_of_text("old"), hash_of_text("new")});
      leave(intent.files.back().target, left.target);
      leave(intent.files.back().temporary, left.temporary);
    }
    const Result<SaveOutcome> outcome = settle_save(intent);
    ASSERT_TRUE(outcome) << outcome.error().text();
    EXPECT_EQ(*outcome, cut.outcome);
    for (std::size_t i = 0; i < cut.files.size(); ++i) {
      const fs::path& target = intent.files[i].target;
      EXPECT_EQ(fs::exists(target), !cut.files[i].settled.empty()) << i;
      EXPECT_EQ(test::whole_file(target), cut.files[i].settled) << i;
      EXPECT_FALSE(fs::exists(intent.files[i].temporary)) << i << ": nothing needs it any more";
    }
  }
}

/// A sheet that was saved after two edits and then edited once more; the record of that save still exists.
class RecordOfASave : public ::testing::Test {
 protected:
  void SetUp() override {
    unsaved_ = test::whole_file(deck_);
    DocumentKeeper keeper = open();
    edit(keeper);
    edit(keeper);
    intent_.deck_before = keeper.document().deck->content;
    first_journal_ = state_.journal(deck_, intent_.deck_before);
    first_edits_ = test::whole_file(first_journal_);
    const Result<ipc::Saved> saved = keeper.save(std::nullopt);
    ASSERT_TRUE(saved) << saved.error().text();
    saved_ = test::whole_file(deck_);
    intent_.deck_after = keeper.document().deck->content;
    next_journal_ = state_.journal(deck_, intent_.deck_after);
    edit(keeper);
    intent_.files.push_back({deck_, folder_.path() / "staged", hash_of_text(unsaved_), hash_of_text(saved_)});
  }

  DocumentKeeper open() const {
    DocumentKeeper keeper(state_);
    ipc::Open request;
    request.path = deck_.string();
    const Result<bool> opened = keeper.open(request, {});
    EXPECT_TRUE(opened) << opened.error().text();
    return keeper;
  }
  /// Number of edits that are restored with the deck as it is now.
  std::uint64_t edits_brought_back() const { return open().state().recovered_edits; }
  static void edit(DocumentKeeper& keeper) {
    EXPECT_TRUE(keeper.edit(mesh::document::parse_edit(R"({"edit":"translate","by":[0,0,0.25],"on":"1313"})").value()));
  }
  void find_at_the_next_opening(const std::string& deck, std::uint64_t records, std::uint64_t records_of_next) {
    leave(deck_, deck);
    intent_.records = records;
    intent_.records_of_next = records_of_next;
    ASSERT_TRUE(write_save_intent(StateFolder::save_intent(first_journal_), intent_));
  }

  test::Folder folder_;
  StateFolder state_{folder_.state()};
  fs::path deck_ = folder_.sheet();
  std::string unsaved_, saved_;  ///< the deck before and after the save
  fs::path first_journal_, next_journal_;
  std::string first_edits_;
  SaveIntent intent_;
};

TEST_F(RecordOfASave, leaves_the_journal_of_the_saved_deck_where_it_got_edits_afterwards) {
  find_at_the_next_opening(unsaved_, 2, 0);  // restored by hand: the save counts as not begun
  EXPECT_EQ(edits_brought_back(), 0u);
  EXPECT_TRUE(fs::exists(next_journal_)) << "it holds an edit that was made after the save";
  EXPECT_FALSE(fs::exists(StateFolder::save_intent(first_journal_)));
  leave(deck_, saved_);
  EXPECT_EQ(edits_brought_back(), 1u);
}

TEST_F(RecordOfASave, retires_the_journal_of_a_saved_deck_that_holds_nothing_else) {
  find_at_the_next_opening(unsaved_, 2, 1);
  EXPECT_EQ(edits_brought_back(), 0u);
  EXPECT_FALSE(fs::exists(next_journal_));
}

TEST_F(RecordOfASave, leaves_the_journal_of_before_where_it_got_edits_afterwards) {
  leave(first_journal_, first_edits_);
  find_at_the_next_opening(saved_, 1, 0);  // the save contained one of its two edits
  EXPECT_EQ(edits_brought_back(), 1u);
  EXPECT_EQ(test::whole_file(first_journal_), first_edits_);
  leave(deck_, unsaved_);
  EXPECT_EQ(edits_brought_back(), 2u);
}

TEST_F(RecordOfASave, retires_the_journal_whose_edits_are_all_in_the_deck) {
  leave(first_journal_, first_edits_);
  find_at_the_next_opening(saved_, 2, 0);
  EXPECT_EQ(edits_brought_back(), 1u);
  EXPECT_FALSE(fs::exists(first_journal_));
}

}  // namespace
}  // namespace prismesh::modeld
