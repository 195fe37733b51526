// Every file call of whole sessions fails in turn: once, from then on, or half done. Whatever was acknowledged comes back after the end of
// the daemon, nothing that was refused does, and the deck is of one state.
#include <algorithm>

#include <gtest/gtest.h>

#include "base/file.h"
#include "tests/faults/power_cut.h"
#include "tests/faults/session.h"

namespace prismesh::modeld::faults {
namespace {

namespace fs = std::filesystem;
using test::Failure;

class FailingCalls : public ::testing::TestWithParam<Session> {
 protected:
  /// What a save to `path` would make of the deck's files: those of a save elsewhere.
  Files deck_to_be(DocumentKeeper& keeper, const fs::path& path) {
    fs::remove_all(root_.copy());
    const fs::path target = root_.copy() / fs::relative(path, root_.disk());
    const Result<ipc::Saved> saved = keeper.save(target.string());
    EXPECT_TRUE(saved) << saved.error().text();
    Files files = deck_files(place_);
    for (const auto& [file, content] : test::disk_state_of(root_.copy()).files)
      files[(root_.disk() / fs::relative(file, root_.copy())).string()] = content;
    return files;
  }

  /// Runs the session with a failure; the number of calls.
  std::uint64_t run(const Failure& failure) {
    std::vector<std::string> documents;
    test::restore(before_);
    test::record_file_calls(root_.disk(), root_.log(), failure);
    std::string acknowledged, uncertain;
    std::vector<Files> decks{deck_files(place_)};  // what may be on disk in the end
    {
      DocumentKeeper keeper = place_.keeper();
      if (open_deck(keeper, place_)) {
        documents.push_back(acknowledged = fingerprint(keeper));
        for (const std::string& step : GetParam().steps) {
          const std::string before = fingerprint(keeper);
          const fs::path own = keeper.document().path;
          if (step == "save") decks.push_back(deck_to_be(keeper, own));
          if (step == "copy" || step == "save as") decks.push_back(deck_to_be(keeper, own.parent_path() / kSavedAs / kOtherDeck));
          const Result<void> done = run_step(keeper, step);
          const std::string after = fingerprint(keeper);
          EXPECT_TRUE(done || after == before) << step << " was refused, and changed the document all the same";
          documents.push_back(after);
          if (done) acknowledged = after;
          // It said so; all steps before went well, since from here on everything fails.
          if (!done && done.error().message.find("may come back") != std::string::npos && uncertain.empty())
            uncertain = went_well_.at(documents.size() - 1);
          if ((step.starts_with("save") || step == "copy") && done) decks = {deck_files(place_)};
        }
      }
    }
    const std::uint64_t calls = test::counted_file_calls();
    test::stop_recording_file_calls();
    DocumentKeeper again = place_.keeper();
    const Result<void> opened = reopen_deck(again, place_);
    EXPECT_TRUE(opened) << opened.error().text();
    if (!opened) return calls;
    const std::string found = fingerprint(again);
    EXPECT_TRUE(acknowledged.empty() || found == acknowledged || found == uncertain)
        << "the recovered document is not the acknowledged one";
    if (went_well_.empty()) went_well_ = documents;
    const Result<void> other = read_other_deck(place_);
    EXPECT_TRUE(other) << other.error().text();
    const Files deck = deck_files(place_);
    EXPECT_TRUE(std::any_of(decks.begin(), decks.end(), [&](const Files& each) { return holds(deck, each, place_); }))
        << "the deck is of no state that was saved";
    const Result<void> edited = run_step(again, R"({"edit":"select","expr":"5"})");
    EXPECT_TRUE(edited) << edited.error().text();
    return calls;
  }

  std::vector<std::string> went_well_;  ///< the document after each step of the first run, without a failure
  Root root_;
  Place place_{root_.disk(), GetParam().write_deck(root_.disk())};
  test::DiskState before_ = test::disk_state_of(root_.disk());
};

TEST_P(FailingCalls, lose_nothing_acknowledged) {
  const std::uint64_t calls = run({});
  ASSERT_FALSE(HasFailure());
  ASSERT_GT(calls, 50u);
  for (std::uint64_t at = 1; at <= calls; ++at)
    for (const Failure& failure : {Failure{at, EIO, false, false}, Failure{at, ENOSPC, true, false}, Failure{at, ENOSPC, true, true}}) {
      SCOPED_TRACE("call " + std::to_string(at) + (failure.for_ever ? " and all after it" : "") + (failure.cut_short ? ", half done" : ""));
      run(failure);
      if (HasFailure()) return;
    }
  std::printf("%llu sessions with a failing call\n", static_cast<unsigned long long>(3 * calls));
}

INSTANTIATE_TEST_SUITE_P(Sessions, FailingCalls, ::testing::ValuesIn(sessions()), [](const auto& tested) { return tested.param.name; });

TEST(ReplacingAFile, says_why_its_folder_takes_none) {
  const Root root;
  for (const auto& [error, message] :
       {std::pair{EACCES, "is read-only (Permission denied)"}, std::pair{EPERM, "is read-only (Operation not permitted)"},
        std::pair{EROFS, "is read-only (Read-only file system)"}, std::pair{EIO, "Input/output error; nothing was changed"},
        std::pair{EDQUOT, "the disk is full (Disk quota exceeded); nothing was changed"}}) {
    test::record_file_calls(root.disk(), root.log(), Failure{.at = 1, .error = error});
    const PendingFile file{root.disk() / "deck.k", {"new"}};
    const Result<void> replaced = replace_files({&file, 1});
    test::stop_recording_file_calls();
    ASSERT_FALSE(replaced);
    EXPECT_NE(replaced.error().text().find(message), std::string::npos) << replaced.error().text();
    EXPECT_FALSE(fs::exists(file.path));
  }
}

}  // namespace
}  // namespace prismesh::modeld::faults
