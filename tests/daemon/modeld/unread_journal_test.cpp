// What can't be read is never thrown away: journals and records that are damaged, empty or not readable stay in the state folder, whatever
// is done with the document.
#include <algorithm>
#include <array>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/modeld/document_keeper.h"
#include "daemon/modeld/save_intent.h"
#include "mesh/document/edit_json.h"
#include "tests/daemon/modeld/folder.h"

namespace prismesh::modeld {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr int kEdits = 20;

class UnreadJournal : public ::testing::Test {
 protected:
  static ipc::Open to_open(const fs::path& deck) {
    ipc::Open open;
    open.path = deck.string();
    return open;
  }
  static void raise(DocumentKeeper& keeper) {
    const auto done = keeper.edit(mesh::document::parse_edit(R"({"edit":"translate","by":[0,0,0.25],"on":"1313"})").value());
    ASSERT_TRUE(done) << done.error().text();
  }
  /// The journal of edits on a deck, as a killed daemon leaves it.
  fs::path journal_of_edits(const fs::path& deck, int edits = kEdits) const {
    DocumentKeeper keeper(state_);
    EXPECT_TRUE(keeper.open(to_open(deck), {}));
    for (int i = 0; i < edits; ++i) raise(keeper);
    return state_.journal(deck, keeper.document().deck->content);
  }
  /// Changes a byte of the first record.
  static std::string with_damage(std::string text) {
    text[text.find("translate")] = 'T';
    return text;
  }
  static void put(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary | std::ios::trunc) << text; }
  /// Whether a file in the state folder has this content.
  bool is_kept(const std::string& content) const {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_.state()))
      if (entry.is_regular_file() && test::whole_file(entry.path()) == content) return true;
    return false;
  }
  /// More retired journals than are kept.
  void retire_many() const {
    for (int i = 0; i < 51; ++i) {
      put(folder_.state() / "other.journal", "edits " + std::to_string(i));
      ASSERT_TRUE(state_.retire(folder_.state() / "other.journal", ".closed"));
    }
  }

  test::Folder folder_;
  StateFolder state_{folder_.state()};
  fs::path deck_ = folder_.sheet();
};

TEST_F(UnreadJournal, outlives_whatever_is_done_with_the_document) {
  const std::string deck_text = test::whole_file(deck_);
  const std::string damaged = with_damage(test::whole_file(journal_of_edits(deck_)));
  const fs::path journal = journal_of_edits(deck_, 0), other = folder_.two_files();
  const std::pair<const char*, std::function<void(DocumentKeeper&)>> ways[] = {
      {"close", [](DocumentKeeper& keeper) { ASSERT_TRUE(keeper.close(false)); }},
      {"discard", [](DocumentKeeper& keeper) { ASSERT_TRUE(keeper.close(true)); }},
      {"another deck", [&](DocumentKeeper& keeper) { ASSERT_TRUE(keeper.open(to_open(other), {})); }},
      {"save", [](DocumentKeeper& keeper) { ASSERT_TRUE(keeper.save(std::nullopt)); }},
      {"save as", [&](DocumentKeeper& keeper) { ASSERT_TRUE(keeper.save_as((folder_.path() / "as/sheet.k").string())); }},
      {"copy", [&](DocumentKeeper& keeper) { ASSERT_TRUE(keeper.save_copy((folder_.path() / "copy/sheet.k").string())); }},
      {"ends", [](DocumentKeeper&) {}},
  };
  for (const auto& [name, way] : ways) {
    SCOPED_TRACE(name);
    fs::remove_all(folder_.state());
    fs::create_directory(folder_.state());
    put(deck_, deck_text);
    put(journal, damaged);
    {
      DocumentKeeper keeper(state_);
      const Result<bool> opened = keeper.open(to_open(deck_), {});
      ASSERT_TRUE(opened) << opened.error().text();
      EXPECT_EQ(keeper.state().recovered_edits, 0u);
      way(keeper);
    }
    EXPECT_TRUE(is_kept(damaged));
    retire_many();
    EXPECT_TRUE(is_kept(damaged)) << "it isn't among the newest any more";
  }
}

TEST_F(UnreadJournal, with_a_few_edits_before_the_damage_is_kept_as_damaged) {
  const fs::path journal = journal_of_edits(deck_);
  std::string text = test::whole_file(journal);
  text[text.find("translate", text.find("\"n\":7"))] = 'T';
  put(journal, text);
  DocumentKeeper keeper(state_);
  ASSERT_TRUE(keeper.open(to_open(deck_), {}));
  EXPECT_EQ(keeper.state().recovered_edits, 6u);
  ASSERT_TRUE(keeper.close(true));
  EXPECT_EQ(test::whole_file(journal.string() + ".damaged.1"), text);
}

/// What a journal's file may hold that can't be read.
std::array<std::pair<const char*, std::function<std::string(const std::string&)>>, 5> unreadable_contents() {
  return {{
      {"header", [](std::string text) { return text[3] ^= 1, text; }},
      {"nothing", [](const std::string&) { return std::string(); }},
      {"half a header", [](const std::string& text) { return text.substr(0, text.find('\n') / 2); }},
      {"zeros after the header",
       [](const std::string& text) {
         const std::size_t header = text.find('\n') + 1;
         return text.substr(0, header) + std::string(text.size() - header, '\0');
       }},
      {"first record torn by zeros",
       [](const std::string& text) {
         const std::size_t from = text.find('\n') + 40;
         return text.substr(0, from) + std::string(text.size() - from, '\0');
       }},
  }};
}

TEST_F(UnreadJournal, is_kept_when_its_deck_is_opened) {
  const fs::path journal = journal_of_edits(deck_);
  const std::string whole = test::whole_file(journal);
  for (const auto& [name, content] : unreadable_contents()) {
    SCOPED_TRACE(name);
    const std::string unread = content(whole);
    put(journal, unread);
    DocumentKeeper keeper(state_);
    const Result<bool> opened = keeper.open(to_open(deck_), {});
    if (!opened) {
      EXPECT_THAT(opened.error().text(), HasSubstr(journal.string()));
      EXPECT_THAT(opened.error().text(), HasSubstr("move that file away"));
      EXPECT_EQ(test::whole_file(journal), unread);
      continue;
    }
    EXPECT_FALSE(keeper.state().warnings.empty());
    ASSERT_TRUE(keeper.close(false));
    EXPECT_TRUE(is_kept(unread));
  }
}

TEST_F(UnreadJournal, in_the_way_of_a_save_as_is_kept) {
  const fs::path other = folder_.path() / "other.k";
  const auto save_as_other = [&] {
    put(deck_, test::whole_file(folder_.sheet()));
    DocumentKeeper keeper(state_);
    ASSERT_TRUE(keeper.open(to_open(deck_), {}));
    raise(keeper);
    const Result<ipc::Saved> saved = keeper.save_as(other.string());
    ASSERT_TRUE(saved) << saved.error().text();
    for (int i = 0; i < 3; ++i) raise(keeper);
  };
  save_as_other();
  DocumentKeeper of_other(state_);
  ASSERT_TRUE(of_other.reopen({}));
  const fs::path journal = state_.journal(other, of_other.document().deck->content);
  of_other = DocumentKeeper(state_);
  const std::string whole = test::whole_file(journal);
  auto contents = unreadable_contents();
  for (const auto& [name, content] : contents) {
    SCOPED_TRACE(name);
    const std::string unread = content(whole);
    put(journal, unread);
    save_as_other();
    EXPECT_TRUE(is_kept(unread));
    retire_many();
    EXPECT_TRUE(is_kept(unread)) << "it isn't among the newest any more";
  }
  put(journal, with_damage(whole));
  save_as_other();
  retire_many();
  EXPECT_TRUE(is_kept(with_damage(whole)));
}

TEST_F(UnreadJournal, of_a_deck_that_a_cut_off_save_has_replaced_is_kept_and_named) {
  const std::string before = test::whole_file(deck_);
  const fs::path journal = journal_of_edits(deck_);
  const std::string damaged = with_damage(test::whole_file(journal));
  SaveIntent intent;
  {
    DocumentKeeper keeper(state_);
    ASSERT_TRUE(keeper.open(to_open(deck_), {}));
    intent.deck_before = keeper.document().deck->content;
    ASSERT_TRUE(keeper.save(std::nullopt));
    intent.deck_after = keeper.document().deck->content;
  }
  const auto hash_of = [](const std::string& text) { return hash128(std::as_bytes(std::span(text.data(), text.size()))); };
  intent.records = kEdits;
  intent.files.push_back({deck_, folder_.path() / "staged", hash_of(before), hash_of(test::whole_file(deck_))});
  put(journal, damaged);
  ASSERT_TRUE(write_save_intent(StateFolder::save_intent(journal), intent));
  DocumentKeeper keeper(state_);
  ASSERT_TRUE(keeper.open(to_open(deck_), {}));
  const auto warnings = keeper.state().warnings;
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(),
                          [](const auto& w) { return w.kind == "damaged-journal" && w.message.find(".damaged.") != std::string::npos; }));
  retire_many();
  EXPECT_TRUE(is_kept(damaged));
}

TEST_F(UnreadJournal, that_something_else_put_in_its_place_is_kept) {
  for (const bool edited : {false, true}) {
    DocumentKeeper keeper(state_);
    ASSERT_TRUE(keeper.open(to_open(deck_), {}));
    if (edited) raise(keeper);
    const fs::path journal = state_.journal(deck_, keeper.document().deck->content);
    const std::string restored = "restored from a backup " + std::to_string(edited);
    fs::remove(journal);
    put(journal, restored);
    ASSERT_TRUE(keeper.close(true));
    retire_many();
    EXPECT_TRUE(is_kept(restored));
  }
}

TEST_F(UnreadJournal, a_record_of_a_save_that_cannot_be_read_is_kept_by_the_next_save) {
  const std::string record = "no record of a save";
  DocumentKeeper keeper(state_);
  ASSERT_TRUE(keeper.open(to_open(deck_), {}));
  raise(keeper);
  put(StateFolder::save_intent(state_.journal(deck_, Hash128{})), record);
  ASSERT_TRUE(keeper.save(std::nullopt));
  EXPECT_TRUE(is_kept(record));
}

TEST_F(UnreadJournal, nor_is_a_session_that_cannot_be_read_overwritten) {
  const fs::path session = folder_.state() / "session.json";
  for (const bool closed : {false, true}) {
    const std::string unread = "what was open " + std::to_string(closed);
    DocumentKeeper keeper(state_);
    if (closed) {
      ASSERT_TRUE(keeper.open(to_open(deck_), {}));
      put(session, unread);
      ASSERT_TRUE(keeper.close(false));
      EXPECT_FALSE(fs::exists(session)) << "nothing is open";
    } else {
      put(session, unread);
      ASSERT_FALSE(keeper.reopen({}));
      ASSERT_TRUE(keeper.open(to_open(deck_), {}));
    }
    EXPECT_TRUE(is_kept(unread));
  }
}

}  // namespace
}  // namespace prismesh::modeld
