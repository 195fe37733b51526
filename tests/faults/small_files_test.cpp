// The small files that control recovery: whatever byte of them changes, nothing wrong is written or opened; and new folders outlive a power
// cut.
#include <algorithm>

#include <gtest/gtest.h>

#include "base/file.h"
#include "ipc/server.h"
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

TEST(SmallFiles, a_changed_byte_of_a_saves_record_writes_nothing_wrong) {
  const Root root;
  const Place place{root.disk(), session_of("three_files").write_deck(root.disk())};
  const DiskState before = test::disk_state_of(root.disk());
  const std::vector<FileCall> calls = calls_of_a_save(root, place);
  ASSERT_FALSE(HasFailure());
  const auto first = std::find_if(calls.begin(), calls.end(), puts_a_deck_file_in_place);
  ASSERT_NE(first, calls.end());
  std::mt19937_64 random(1);
  const DiskState cut = test::after_power_cut(before, calls, static_cast<std::size_t>(first - calls.begin()) + 1, Survives::all, random);
  const auto intent = std::find_if(cut.files.begin(), cut.files.end(), [](const auto& file) { return file.first.ends_with(".saving"); });
  ASSERT_NE(intent, cut.files.end());
  for (std::size_t at = 0; at < intent->second.size(); ++at) {
    SCOPED_TRACE(at);
    DiskState damaged = cut;
    damaged.files[intent->first][at] = static_cast<char>(damaged.files[intent->first][at] ^ (1 << (at % 8)));
    test::restore(damaged);
    const auto deck = deck_files(place);
    DocumentKeeper keeper = place.keeper();
    const Result<void> opened = open_deck(keeper, place);
    ASSERT_TRUE(opened) << opened.error().text();
    EXPECT_EQ(deck_files(place), deck) << "something was written to the deck";
    const auto warnings = keeper.state().warnings;
    EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const auto& w) { return w.kind == "save-unknown"; }));
    if (::testing::Test::HasFailure()) return;
  }
  // As it was written, it finishes the save.
  test::restore(cut);
  DocumentKeeper keeper = place.keeper();
  ASSERT_TRUE(open_deck(keeper, place));
  EXPECT_EQ(keeper.state().warnings.back().kind, "save-finished");
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

TEST(SmallFiles, a_cut_off_save_is_finished_by_the_next_opening_that_can) {
  const Root root;
  const Place place{root.disk(), session_of("three_files").write_deck(root.disk())};
  const DiskState before = test::disk_state_of(root.disk());
  const std::vector<FileCall> calls = calls_of_a_save(root, place);
  ASSERT_FALSE(HasFailure());
  const auto saved = deck_files(place);
  const auto first = std::find_if(calls.begin(), calls.end(), puts_a_deck_file_in_place);
  std::mt19937_64 random(1);
  DiskState cut = test::after_power_cut(before, calls, static_cast<std::size_t>(first - calls.begin()) + 1, Survives::all, random);
  const auto intent = std::find_if(cut.files.begin(), cut.files.end(), [](const auto& file) { return file.first.ends_with(".saving"); });
  ASSERT_NE(intent, cut.files.end());
  const std::string record = intent->second;
  for (const bool damaged : {false, true}) {
    if (damaged) intent->second[record.size() / 2] ^= 1;
    std::uint64_t opening = 1, refused = 0;
    for (std::uint64_t at = 0; at <= opening; ++at) {  // 0: none fails
      SCOPED_TRACE((damaged ? "damaged, call " : "call ") + std::to_string(at));
      test::restore(cut);
      test::record_file_calls(root.disk(), root.log(), {at, EIO, false, false});
      {
        DocumentKeeper keeper = place.keeper();
        const Result<void> opened = open_deck(keeper, place);
        if (at == 0) opening = test::counted_file_calls();
        if (!opened) {
          ++refused;
          EXPECT_FALSE(keeper.is_open());
          EXPECT_FALSE(opened.error().message.empty());
        }
      }
      test::stop_recording_file_calls();
      DocumentKeeper keeper = place.keeper();
      const Result<void> opened = open_deck(keeper, place);
      ASSERT_TRUE(opened) << opened.error().text();
      EXPECT_EQ(deck_files(place) == saved, !damaged);
      EXPECT_EQ(keeper.state().path, place.deck.string());
      if (!damaged) {
        EXPECT_FALSE(keeper.changed()) << "the document must count as saved";
      }
      if (HasFailure()) return;
    }
    EXPECT_GT(opening, 4u);
    EXPECT_GT(refused, damaged ? 0u : 2u);
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
