// The small files that control recovery: whatever byte of them changes, nothing wrong is written or opened; and new folders outlive a power
// cut.
#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>

#include "base/file.h"
#include "ipc/wire/server.h"
#include "mesh/deck/open.h"
#include "mesh/deck/save_record.h"
#include "tests/faults/power_cut.h"
#include "tests/faults/session.h"

namespace prismesh::modeld::faults {
namespace {

namespace fs = std::filesystem;
using test::DiskState;
using test::FileCall;
using test::Survives;

const Session& session_of(const std::string& name) {
  return *std::find_if(sessions().begin(), sessions().end(), [&](const Session& session) { return session.name == name; });
}

/// The file calls of opening the deck, moving all of it and saving it in place.
std::vector<FileCall> calls_of_a_save(const Root& root, const Place& place) {
  test::record_file_calls(root.disk(), root.log());
  {
    DocumentKeeper keeper = place.keeper();
    EXPECT_TRUE(open_deck(keeper, place));
    EXPECT_TRUE(run_step(keeper, R"({"edit":"translate","by":[0,0,0.5],"on":"all"})"));
    EXPECT_TRUE(run_step(keeper, "save"));
  }
  test::stop_recording_file_calls();
  return test::read_file_calls(root.log());
}

bool puts_a_deck_file_in_place(const FileCall& call) {
  return call.kind == FileCall::Kind::rename && call.other.find("/state/") == std::string::npos;
}

/// A save in place of three files, cut off after the first of them. It has a record in the state folder and one beside the deck.
class CutOffSave : public ::testing::Test {
 protected:
  void SetUp() override {
    const DiskState before = test::disk_state_of(root_.disk());
    const std::vector<FileCall> calls = calls_of_a_save(root_, place_);
    ASSERT_FALSE(HasFailure());
    saved_ = deck_files(place_);
    const auto first = std::find_if(calls.begin(), calls.end(), puts_a_deck_file_in_place);
    ASSERT_NE(first, calls.end());
    std::mt19937_64 random(1);
    cut_ = test::after_power_cut(before, calls, static_cast<std::size_t>(first - calls.begin()) + 1, Survives::all, random);
    for (const auto& [path, content] : cut_.files)
      if (path.ends_with(".saving")) (path.starts_with(place_.state().string()) ? in_state_ : beside_) = path;
    ASSERT_FALSE(in_state_.empty() || beside_.empty());
    test::restore(cut_);
    begun_ = deck_files(place_);
  }

  Root root_;
  Place place_{root_.disk(), session_of("three_files").write_deck(root_.disk())};
  DiskState cut_;
  std::string in_state_, beside_;  ///< the two records
  Files begun_, saved_;            ///< the deck's files as the cut has left them, and as they are to be
};

bool has_warning(const std::vector<mesh::deck::Warning>& warnings, const std::string& kind) {
  return std::any_of(warnings.begin(), warnings.end(), [&](const auto& warning) { return warning.kind == kind; });
}

TEST_F(CutOffSave, a_changed_byte_of_its_record_writes_nothing_wrong) {
  for (const auto& [record, other] : {std::pair(in_state_, beside_), std::pair(beside_, in_state_)})
    for (const bool alone : {true, false})
      for (std::size_t at = 0; at < cut_.files.at(record).size(); ++at) {
        SCOPED_TRACE(record + (alone ? " alone, byte " : ", byte ") + std::to_string(at));
        DiskState damaged = cut_;
        damaged.files[record][at] = static_cast<char>(damaged.files[record][at] ^ (1 << (at % 8)));
        const std::string content = damaged.files[record];
        if (alone) damaged.files.erase(other);
        test::restore(damaged);
        DocumentKeeper keeper = place_.keeper();
        const Result<void> opened = open_deck(keeper, place_);
        ASSERT_TRUE(opened) << opened.error().text();
        ASSERT_TRUE(deck_files(place_) == (alone ? begun_ : saved_)) << "what is written is what the other record says";
        EXPECT_TRUE(has_warning(keeper.state().warnings, "save-unknown"));
        const DiskState left = test::disk_state_of(root_.disk());
        EXPECT_TRUE(std::any_of(left.files.begin(), left.files.end(), [&](const auto& file) { return file.second == content; }))
            << "the damaged record is kept";
        if (HasFailure()) return;
      }
  // As they were written, they finish the save.
  test::restore(cut_);
  DocumentKeeper keeper = place_.keeper();
  ASSERT_TRUE(open_deck(keeper, place_));
  EXPECT_TRUE(has_warning(keeper.state().warnings, "save-finished"));
}

TEST_F(CutOffSave, is_said_by_every_opening_until_the_deck_is_saved_where_it_cannot_be_finished) {
  cut_.files.erase(in_state_);
  cut_.files[place_.deck.string()] += "$ by hand\n";
  test::restore(cut_);
  const Files mixed = deck_files(place_);
  for (int i = 0; i < 2; ++i) {
    const Result<mesh::deck::OpenedDeck> opened = mesh::deck::open(place_.deck);
    ASSERT_TRUE(opened) << opened.error().text();
    EXPECT_TRUE(has_warning(opened->deck->warnings, "save-mixed"));
    EXPECT_EQ(deck_files(place_), mixed);
  }
  DocumentKeeper keeper = place_.keeper();
  ASSERT_TRUE(open_deck(keeper, place_));
  EXPECT_TRUE(has_warning(keeper.state().warnings, "save-mixed"));
  ASSERT_TRUE(run_step(keeper, R"({"edit":"translate","by":[0,0,0.5],"on":"1"})"));
  ASSERT_TRUE(run_step(keeper, "save"));
  const Result<mesh::deck::OpenedDeck> opened = mesh::deck::open(place_.deck);
  ASSERT_TRUE(opened);
  EXPECT_FALSE(has_warning(opened->deck->warnings, "save-mixed"));
  for (const auto& [path, content] : test::disk_state_of(root_.disk()).files)
    EXPECT_FALSE(fs::path(path).filename().string().starts_with(".")) << path << " is left";
}

TEST_F(CutOffSave, is_read_as_it_was_saved_where_the_deck_may_not_be_written) {
  cut_.files.erase(in_state_);
  test::restore(cut_);
  test::record_file_calls(root_.disk(), root_.log(), {1, EROFS, true, false});
  const Result<mesh::deck::OpenedDeck> opened = mesh::deck::open(place_.deck);
  test::stop_recording_file_calls();
  ASSERT_TRUE(opened) << opened.error().text();
  EXPECT_TRUE(has_warning(opened->deck->warnings, "save-unfinished"));
  EXPECT_EQ(deck_files(place_), begun_);
  for (const mesh::deck::SourceFile& file : opened->deck->files) EXPECT_EQ(file.bytes.text(), saved_.at(file.path.string()));
}

TEST_F(CutOffSave, a_record_reaches_no_file_outside_the_decks_folder) {
  // Such a record may come with a deck from anywhere.
  const fs::path inside = root_.disk() / "deck", outside = root_.disk() / "outside.k";
  fs::create_directory(inside);
  const fs::path deck = session_of("one_file").write_deck(inside);
  fs::create_directory_symlink(root_.disk(), inside / "link");
  const auto hash_of = [](std::string_view text) { return hash128(std::as_bytes(std::span(text.data(), text.size()))); };
  const auto put = [](const fs::path& file, const std::string& text) { std::ofstream(file) << text; };
  const auto in_between = [&](const fs::path& target, const fs::path& temporary) {
    put(inside / "done.k", "new");
    put(target, "old");
    put(temporary, "new");
    const mesh::deck::ReplacedFile files[] = {{inside / "done.k", inside / ".done.k.1", hash_of("old"), hash_of("new")},
                                              {target, temporary, hash_of("old"), hash_of("new")}};
    ASSERT_TRUE(mesh::deck::SaveRecord::begin(deck, files));
    const Result<mesh::deck::OpenedDeck> opened = mesh::deck::open(deck);
    ASSERT_TRUE(opened) << opened.error().text();
  };
  const auto content = [](const fs::path& file) { return test::disk_state_of(file.parent_path()).files.at(file.string()); };
  in_between(outside, root_.disk() / ".outside.k.1");
  EXPECT_EQ(content(outside), "old");
  in_between(inside / "link/outside.k", inside / "link/.outside.k.1");
  EXPECT_EQ(content(outside), "old");
  in_between(inside / "in.k", inside / "other");
  EXPECT_EQ(content(inside / "in.k"), "old") << "no save writes into a file of such a name";
  in_between(inside / "in.k", inside / ".in.k.1");
  EXPECT_EQ(content(inside / "in.k"), "new");
}

TEST_F(CutOffSave, a_deck_that_is_being_saved_is_neither_read_nor_saved) {
  test::restore(cut_);
  const Result<mesh::deck::SaveRecord> under_way = mesh::deck::SaveRecord::of_cut_off_save(place_.deck);
  ASSERT_TRUE(under_way && under_way->is_there());
  const Result<mesh::deck::OpenedDeck> opened = mesh::deck::open(place_.deck);
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("another program is saving this deck just now"), std::string::npos) << opened.error().text();
  EXPECT_FALSE(mesh::deck::SaveRecord::begin(place_.deck, {}));
  EXPECT_EQ(deck_files(place_), begun_);
}

TEST(SmallFiles, an_include_that_was_restored_by_hand_is_not_overwritten) {
  const Root root;
  const Place place{root.disk(), session_of("three_files").write_deck(root.disk())};
  const DiskState before = test::disk_state_of(root.disk());
  const std::vector<FileCall> calls = calls_of_a_save(root, place);
  ASSERT_FALSE(HasFailure());
  const auto last = std::find_if(calls.rbegin(), calls.rend(), puts_a_deck_file_in_place);
  std::mt19937_64 random(1);
  DiskState cut = test::after_power_cut(before, calls, static_cast<std::size_t>(calls.rend() - last), Survives::all, random);
  const std::string include = (root.disk() / "parts/above.k").string();
  ASSERT_NE(cut.files.at(include), before.files.at(include));
  for (const std::string& by_hand : {before.files.at(include), before.files.at(include) + "$ by hand\n"}) {
    cut.files[include] = by_hand;
    test::restore(cut);
    DocumentKeeper keeper = place.keeper();
    ASSERT_TRUE(open_deck(keeper, place));
    EXPECT_EQ(deck_files(place).at(include), by_hand);
    const auto warnings = keeper.state().warnings;
    EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const auto& w) { return w.kind == "save-mixed"; }));
  }
}

TEST_F(CutOffSave, is_finished_by_the_next_opening_that_can) {
  struct Left {
    const char* what;
    bool state, beside, damaged;
    std::uint64_t refused;  ///< at least so many openings
  };
  for (const Left& left : {Left{"both records", true, true, false, 1}, Left{"that in the state folder", true, false, false, 3},
                           Left{"that beside the deck", false, true, false, 0}, Left{"a damaged one", true, false, true, 1}}) {
    DiskState cut = cut_;
    if (!left.state) cut.files.erase(in_state_);
    if (!left.beside) cut.files.erase(beside_);
    if (left.damaged) cut.files[in_state_][cut.files[in_state_].size() / 2] ^= 1;
    std::uint64_t opening = 1, refused = 0;
    for (std::uint64_t at = 0; at <= opening; ++at) {  // 0: none fails
      SCOPED_TRACE(std::string(left.what) + ", call " + std::to_string(at));
      test::restore(cut);
      test::record_file_calls(root_.disk(), root_.log(), {at, EIO, false, false});
      {
        DocumentKeeper keeper = place_.keeper();
        const Result<void> opened = open_deck(keeper, place_);
        if (at == 0) opening = test::counted_file_calls();
        if (!opened) {
          ++refused;
          EXPECT_FALSE(keeper.is_open());
          EXPECT_FALSE(opened.error().message.empty());
        }
      }
      test::stop_recording_file_calls();
      DocumentKeeper keeper = place_.keeper();
      const Result<void> opened = open_deck(keeper, place_);
      ASSERT_TRUE(opened) << opened.error().text();
      EXPECT_EQ(deck_files(place_) == saved_, !left.damaged);
      EXPECT_EQ(keeper.state().path, place_.deck.string());
      if (!left.damaged) {
        EXPECT_FALSE(keeper.changed()) << "the document must count as saved";
      }
      if (HasFailure()) return;
    }
    EXPECT_GT(opening, 4u);
    EXPECT_GE(refused, left.refused);
  }
}

TEST(SmallFiles, edits_that_are_given_up_are_kept_whatever_fails_meanwhile) {
  const Root root;
  const Place place{root.disk(), session_of("one_file").write_deck(root.disk())};
  {
    DocumentKeeper keeper = place.keeper();
    ASSERT_TRUE(open_deck(keeper, place));
    ASSERT_TRUE(run_step(keeper, R"({"edit":"translate","by":[0,0,0.5],"on":"all"})"));
  }
  const DiskState before = test::disk_state_of(root.disk());
  const auto journal =
      std::find_if(before.files.begin(), before.files.end(), [](const auto& file) { return file.first.ends_with(".journal"); });
  ASSERT_NE(journal, before.files.end());
  std::uint64_t closing = 1, refused = 0;
  for (std::uint64_t at = 0; at <= closing; ++at) {
    SCOPED_TRACE("call " + std::to_string(at));
    test::restore(before);
    DocumentKeeper keeper = place.keeper();
    ASSERT_TRUE(reopen_deck(keeper, place));
    const std::string shown = fingerprint(keeper);
    test::record_file_calls(root.disk(), root.log(), {at, EIO, false, false});
    const Result<void> closed = keeper.close(true);
    if (at == 0) closing = test::counted_file_calls();
    test::stop_recording_file_calls();
    if (!closed) {
      ++refused;
      ASSERT_TRUE(keeper.is_open());
      EXPECT_EQ(fingerprint(keeper), shown);
      const Result<void> again = keeper.close(true);
      EXPECT_TRUE(again) << again.error().text();
    }
    EXPECT_FALSE(keeper.is_open());
    const DiskState after = test::disk_state_of(root.disk());
    EXPECT_TRUE(std::any_of(after.files.begin(), after.files.end(), [&](const auto& file) {
      return file.first.find(".journal.discarded.") != std::string::npos && file.second == journal->second;
    }));
    if (HasFailure()) return;
  }
  EXPECT_GT(refused, 0u);
}

TEST(SmallFiles, a_journal_in_the_way_of_a_save_is_kept_whatever_fails_meanwhile) {
  const Root root;
  const Place place{root.disk(), session_of("one_file").write_deck(root.disk())};
  const std::string raise = R"({"edit":"translate","by":[0,0,0.5],"on":"all"})";
  const DiskState unsaved = test::disk_state_of(root.disk());
  fs::path in_the_way;
  {
    DocumentKeeper keeper = place.keeper();
    ASSERT_TRUE(open_deck(keeper, place));
    ASSERT_TRUE(run_step(keeper, raise));
    ASSERT_TRUE(run_step(keeper, "save"));
    ASSERT_TRUE(run_step(keeper, raise));
    in_the_way = StateFolder(place.state()).journal(place.deck, keeper.document().deck->content);
  }
  DiskState before = test::disk_state_of(root.disk());
  const std::string edits = before.files.at(in_the_way.string());
  before.files[place.deck.string()] = unsaved.files.at(place.deck.string());  // given back by hand
  std::uint64_t calls = 1, refused = 0;
  for (std::uint64_t at = 0; at <= calls; ++at) {
    SCOPED_TRACE("call " + std::to_string(at));
    test::restore(before);
    {
      DocumentKeeper keeper = place.keeper();
      ASSERT_TRUE(open_deck(keeper, place));
      ASSERT_TRUE(run_step(keeper, raise));
      test::record_file_calls(root.disk(), root.log(), {at, EIO, false, false});
      refused += run_step(keeper, "save") ? 0 : 1;
      if (at == 0) calls = test::counted_file_calls();
      test::stop_recording_file_calls();
    }
    const DiskState after = test::disk_state_of(root.disk());
    EXPECT_TRUE(std::any_of(after.files.begin(), after.files.end(), [&](const auto& file) { return file.second == edits; }));
    if (HasFailure()) return;
  }
  EXPECT_GT(refused, 5u);
}

TEST(SmallFiles, a_changed_byte_of_the_session_opens_nothing_wrong) {
  const Root root;
  const Place place{root.disk(), session_of("one_file").write_deck(root.disk())};
  {
    DocumentKeeper keeper = place.keeper();
    ipc::Open request;
    request.path = place.deck.string();
    request.target_size = 12.5;
    request.length_unit = "mm";
    ASSERT_TRUE(keeper.open(request, {}));
  }
  const DiskState before = test::disk_state_of(root.disk());
  const std::string file = (place.state() / "session.json").string();
  for (std::size_t at = 0; at < before.files.at(file).size(); ++at) {
    SCOPED_TRACE(at);
    DiskState damaged = before;
    damaged.files[file][at] = static_cast<char>(damaged.files[file][at] ^ (1 << (at % 8)));
    test::restore(damaged);
    DocumentKeeper keeper = place.keeper();
    const Result<bool> opened = keeper.reopen({});
    ASSERT_FALSE(opened);
    EXPECT_FALSE(keeper.is_open());
  }
  test::restore(before);
  DocumentKeeper keeper = place.keeper();
  ASSERT_TRUE(keeper.reopen({}));
  EXPECT_EQ(keeper.state().target_size, 12.5);
}

TEST(SmallFiles, new_folders_outlive_a_power_cut) {
  const Root root;
  const DiskState before = test::disk_state_of(root.disk());
  test::record_file_calls(root.disk(), root.log());
  const fs::path deck = root.disk() / "new/folders/deck.k";
  const PendingFile file{deck, {"*KEYWORD\n*END\n"}};
  ASSERT_TRUE(replace_files(std::span(&file, 1)));
  const fs::path state = root.disk() / "var/lib/prismesh";
  ASSERT_TRUE(ipc::make_private_folder(state));
  test::stop_recording_file_calls();
  const std::vector<FileCall> calls = test::read_file_calls(root.log());
  std::mt19937_64 random(1);
  const DiskState left = test::after_power_cut(before, calls, calls.size(), Survives::flushed, random);
  ASSERT_TRUE(left.files.contains(deck.string()));
  EXPECT_EQ(left.files.at(deck.string()), "*KEYWORD\n*END\n");
  EXPECT_TRUE(std::binary_search(left.folders.begin(), left.folders.end(), state.string()));
}

}  // namespace
}  // namespace prismesh::modeld::faults
