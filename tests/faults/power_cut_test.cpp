// The power is cut at every moment of whole sessions: whatever the disk holds then, every acknowledged edit comes back, the deck is of one
// state, and what comes back can be edited.
#include "tests/faults/power_cut.h"

#include <set>

#include <gtest/gtest.h>

#include "tests/faults/session.h"
#include "tests/support/seed.h"

namespace prismesh::modeld::faults {
namespace {

using test::DiskState;
using test::FileCall;
using test::Survives;

/// A session that went well: its calls, and how the document and its deck were after each acknowledged step.
struct Recorded {
  DiskState before;
  std::vector<FileCall> calls;
  std::vector<std::string> documents;  ///< [k]: after k steps
  std::vector<std::map<std::string, std::string>> decks;
};

Recorded record(const Session& session, const Root& root, const Place& place) {
  Recorded recorded;
  recorded.before = test::disk_state_of(root.disk());
  test::record_file_calls(root.disk(), root.log());
  {
    DocumentKeeper keeper = place.keeper();
    const Result<void> opened = open_deck(keeper, place);
    EXPECT_TRUE(opened) << opened.error().text();
    recorded.documents.push_back(fingerprint(keeper));
    recorded.decks.push_back(deck_files(place));
    test::mark_file_calls(0);
    for (const std::string& step : session.steps) {
      const Result<void> done = run_step(keeper, step);
      EXPECT_TRUE(done) << step << ": " << done.error().text();
      test::mark_file_calls(recorded.documents.size());
      recorded.documents.push_back(fingerprint(keeper));
      recorded.decks.push_back(deck_files(place));
    }
  }
  test::stop_recording_file_calls();
  recorded.calls = test::read_file_calls(root.log());
  return recorded;
}

std::size_t states_wanted() {
  const char* more = std::getenv("PRISMESH_POWER_CUTS");
  return more == nullptr ? 1200 : std::strtoul(more, nullptr, 10);
}

class PowerCut : public ::testing::TestWithParam<Session> {};

TEST_P(PowerCut, LeavesEveryAcknowledgedEdit) {
  const Root root;
  const Place place{root.disk(), GetParam().write_deck(root.disk())};
  const Recorded recorded = record(GetParam(), root, place);
  ASSERT_FALSE(HasFailure());
  ASSERT_GT(recorded.calls.size(), 50u);
  std::mt19937_64 random(test::seed(1));
  std::set<std::string> seen;
  std::size_t states = 0;
  const auto recovers = [&](std::size_t count, Survives survives) {
    const DiskState state = test::after_power_cut(recorded.before, recorded.calls, count, survives, random);
    std::size_t acknowledged = 0;  // steps, the opening among them
    for (std::size_t i = 0; i < count; ++i) acknowledged += recorded.calls[i].kind == FileCall::Kind::mark ? 1 : 0;
    std::string key = std::to_string(acknowledged);
    for (const auto& [path, content] : state.files) key += "\n" + path + "\n" + content;
    if (!seen.insert(std::move(key)).second) return;
    ++states;
    test::restore(state);
    const std::size_t before = acknowledged == 0 ? 0 : acknowledged - 1;
    const std::size_t after = std::min(before + (acknowledged == 0 ? 0 : 1), recorded.documents.size() - 1);
    DocumentKeeper keeper = place.keeper();
    const Result<void> opened = open_deck(keeper, place);
    ASSERT_TRUE(opened) << opened.error().text();
    const std::string found = fingerprint(keeper);
    ASSERT_TRUE(found == recorded.documents[before] || found == recorded.documents[after])
        << "the document is neither as it was after step " << before << " nor as after the next";
    const auto deck = deck_files(place);
    ASSERT_TRUE(deck == recorded.decks[before] || deck == recorded.decks[after]) << "the deck is a mixture";
    for (const auto& warning : keeper.state().warnings)
      ASSERT_TRUE(warning.kind == "save-finished" || warning.kind == "torn-journal" || warning.kind == "damaged-journal")
          << warning.kind << ": " << warning.message;
    const Result<void> edited = run_step(keeper, R"({"edit":"select","expr":"5"})");
    ASSERT_TRUE(edited) << edited.error().text();
  };
  for (int round = 0; states < states_wanted() && round < 1000; ++round)
    for (std::size_t count = 0; count <= recorded.calls.size(); ++count)
      for (const Survives survives : {Survives::all, Survives::flushed, Survives::in_order, Survives::any}) {
        if (round > 0 && (survives == Survives::all || survives == Survives::flushed)) continue;
        SCOPED_TRACE("after " + std::to_string(count) + " calls, " + std::to_string(static_cast<int>(survives)));
        recovers(count, survives);
        if (HasFailure()) {
          for (std::size_t i = count < 12 ? 0 : count - 12; i < count; ++i)
            std::fprintf(stderr, "%zu: %d %s %s %zu+%zu\n", i, static_cast<int>(recorded.calls[i].kind), recorded.calls[i].path.c_str(),
                         recorded.calls[i].other.c_str(), static_cast<std::size_t>(recorded.calls[i].offset),
                         recorded.calls[i].data.size());
          for (const auto& [path, content] : test::disk_state_of(root.disk()).files)
            std::fprintf(stderr, "%s: %zu\n", path.c_str(), content.size());
          return;
        }
      }
  RecordProperty("states", std::to_string(states));
  EXPECT_GE(states, 400u);
  std::printf("%zu states of the disk, %zu calls\n", states, recorded.calls.size());
}

INSTANTIATE_TEST_SUITE_P(Sessions, PowerCut, ::testing::ValuesIn(sessions()), [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace prismesh::modeld::faults
