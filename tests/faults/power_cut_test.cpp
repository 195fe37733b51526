// The power is cut at every moment of whole sessions: whatever the disk holds then, every acknowledged edit comes back, the deck is of one
// state, and what comes back can be edited.
#include "tests/faults/power_cut.h"

#include <csignal>
#include <set>

#include <gtest/gtest.h>

#include "ipc/model/client.h"
#include "mesh/document/edit_json.h"
#include "tests/faults/session.h"
#include "tests/station/process.h"
#include "tests/support/places.h"
#include "tests/support/seed.h"

namespace prismesh::modeld::faults {
namespace {

namespace fs = std::filesystem;
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
      if (!done && session.by_chance) continue;
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

constexpr std::size_t kStatesOfASession = 1200;

/// For all random sessions together.
std::size_t states_by_chance() {
  const char* more = std::getenv("PRISMESH_POWER_CUTS");
  return more == nullptr ? 500 : std::strtoul(more, nullptr, 10);
}

class PowerCut : public ::testing::TestWithParam<Session> {};

/// For the failure message: the calls that led to a wrong state, and the files there.
void print_end(const Recorded& recorded, std::size_t count, const Place& place) {
  for (std::size_t i = count < 12 ? 0 : count - 12; i < count; ++i) {
    const FileCall& call = recorded.calls[i];
    std::fprintf(stderr, "%zu: %d %s %s %zu+%zu\n", i, static_cast<int>(call.kind), call.path.c_str(), call.other.c_str(),
                 static_cast<std::size_t>(call.offset), call.data.size());
  }
  for (const auto& [path, content] : test::disk_state_of(place.root).files) std::fprintf(stderr, "%s: %zu\n", path.c_str(), content.size());
}

/// Whatever the disk holds after a cut anywhere in the calls, the deck opens, and the document is as it was acknowledged. Goes through the
/// calls until there were `wanted` different states, at most `rounds` times; returns how many there were.
std::size_t expect_recovery(const Recorded& recorded, const Place& place, std::mt19937_64& random, std::size_t wanted, int rounds) {
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
    const Result<void> opened = reopen_deck(keeper, place);
    ASSERT_TRUE(opened) << opened.error().text();
    const std::string found = fingerprint(keeper);
    ASSERT_TRUE(found == recorded.documents[before] || found == recorded.documents[after])
        << "the document is neither as it was after step " << before << " nor as after the next";
    const Result<void> other = read_other_deck(place);
    ASSERT_TRUE(other) << other.error().text();
    const auto deck = deck_files(place);
    ASSERT_TRUE(holds(deck, recorded.decks[before], place) || holds(deck, recorded.decks[after], place)) << "the deck is a mixture";
    for (const auto& warning : keeper.state().warnings)
      ASSERT_TRUE(warning.kind == "save-finished" || warning.kind == "torn-journal" || warning.kind == "damaged-journal")
          << warning.kind << ": " << warning.message;
    const Result<void> edited = run_step(keeper, R"({"edit":"select","expr":"5"})");
    ASSERT_TRUE(edited) << edited.error().text();
  };
  for (int round = 0; states < wanted && round < rounds; ++round)
    for (std::size_t count = 0; count <= recorded.calls.size(); ++count)
      for (const Survives survives : {Survives::all, Survives::flushed, Survives::in_order, Survives::any}) {
        if (round > 0 && (survives == Survives::all || survives == Survives::flushed)) continue;
        SCOPED_TRACE("after " + std::to_string(count) + " calls, " + std::to_string(static_cast<int>(survives)));
        recovers(count, survives);
        if (::testing::Test::HasFailure()) {
          print_end(recorded, count, place);
          return states;
        }
      }
  return states;
}

void expect_recovery(const Recorded& recorded, const Place& place) {
  std::mt19937_64 random(test::seed(1));
  const std::size_t states = expect_recovery(recorded, place, random, kStatesOfASession, 300);
  EXPECT_GE(states, 400u);
  std::printf("%zu states of the disk, %zu calls\n", states, recorded.calls.size());
}

TEST_P(PowerCut, leaves_every_acknowledged_edit) {
  const Root root;
  const Place place{root.disk(), GetParam().write_deck(root.disk())};
  const Recorded recorded = record(GetParam(), root, place);
  ASSERT_FALSE(HasFailure());
  ASSERT_GT(recorded.calls.size(), 50u);
  expect_recovery(recorded, place);
}

TEST(PowerCutByChance, leaves_every_acknowledged_edit) {
  std::mt19937_64 random(test::seed(2));
  std::size_t states = 0, sessions = 0;
  for (; states < states_by_chance(); ++sessions) {
    SCOPED_TRACE("session " + std::to_string(sessions));
    const Root root;
    const Session session = session_by_chance(random);
    const Place place{root.disk(), session.write_deck(root.disk())};
    const Recorded recorded = record(session, root, place);
    ASSERT_FALSE(HasFailure());
    states += expect_recovery(recorded, place, random, kStatesOfASession, 4);
    if (HasFailure())
      for (const std::string& step : session.steps) std::fprintf(stderr, "%s\n", step.c_str());
    ASSERT_FALSE(HasFailure());
  }
  std::printf("%zu states of the disk in %zu sessions\n", states, sessions);
}

/// The same of a daemon that is a program of its own, with a client that notes when it was answered.
TEST(PowerCutOfADaemon, leaves_every_acknowledged_edit) {
  const fs::path preload = test::programs_folder() / "libfile_calls_preload.so";
  ASSERT_TRUE(fs::exists(preload));
  const Session& session = sessions()[1];
  const Root root;
  const Place place{root.disk(), session.write_deck(root.disk())};
  Recorded recorded;
  recorded.before = test::disk_state_of(root.disk());
  std::vector<std::size_t> answered;  // how many calls there were then
  {
    const fs::path run = root.log().parent_path() / "run";
    test::Process daemon(
        {(test::programs_folder() / "prismesh-modeld").string(), "--runtime-dir", run.string(), "--state-dir", place.state().string()},
        {{"LD_PRELOAD", preload.string()},
         {"PRISMESH_FILE_CALLS_BELOW", root.disk().string()},
         {"PRISMESH_FILE_CALLS_LOG", root.log().string()}});
    ipc::ReconnectingClient connection(ipc::model_socket_path(run), "test");
    const Result<ipc::Client*> client = connection.wait(test::kPatience);
    ASSERT_TRUE(client) << client.error().text() << daemon.standard_error();
    const auto ask = [&](const ipc::Request& request) {
      const auto answer = (*client)->call(request, test::kPatience);
      ASSERT_TRUE(answer) << answer.error().text();
      answered.push_back(test::read_file_calls(root.log()).size());
      recorded.decks.push_back(deck_files(place));
    };
    ipc::Open open;
    open.path = place.deck.string();
    ask(open);
    for (const std::string& step : session.steps)
      step == "save" ? ask(ipc::Save{}) : ask(ipc::ApplyEdit{mesh::document::parse_edit(step).value()});
    daemon.kill(SIGKILL);
    EXPECT_EQ(daemon.wait_for_exit(), 128 + SIGKILL);
  }
  const std::vector<FileCall> calls = test::read_file_calls(root.log());
  std::size_t next = 0;
  for (std::size_t i = 0; i <= calls.size(); ++i) {
    for (; next < answered.size() && answered[next] == i; ++next) recorded.calls.push_back({FileCall::Kind::mark, 0, next, "", "", ""});
    if (i < calls.size()) recorded.calls.push_back(calls[i]);
  }
  ASSERT_EQ(next, session.steps.size() + 1);
  // What the document was after each step: the same edits are the same document, whoever makes them.
  test::restore(recorded.before);
  DocumentKeeper keeper = place.keeper();
  ASSERT_TRUE(open_deck(keeper, place));
  recorded.documents.push_back(fingerprint(keeper));
  for (const std::string& step : session.steps) {
    ASSERT_TRUE(run_step(keeper, step));
    recorded.documents.push_back(fingerprint(keeper));
  }
  expect_recovery(recorded, place);
}

INSTANTIATE_TEST_SUITE_P(Sessions, PowerCut, ::testing::ValuesIn(sessions()), [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace prismesh::modeld::faults
