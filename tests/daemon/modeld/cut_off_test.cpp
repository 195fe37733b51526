// Long edits that are interrupted by a kill of modeld, by a cancel or by their client's death: the document is unchanged, and the same edit
// gives the same result afterwards. The tests detect the middle of an edit by its progress messages, never by waiting.
#include <filesystem>
#include <functional>

#include <gtest/gtest.h>

#include "ipc/model/messages_json.h"
#include "mesh/document/edit_json.h"
#include "tests/daemon/modeld/restartable_daemon.h"
#include "tests/support/places.h"

namespace prismesh::modeld {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using test::Folder;
using test::kPatience;
using test::RestartableDaemon;

mesh::document::Edit edit_of(const std::string& json) { return mesh::document::parse_edit(json).value(); }

/// All that clients can query of a document, apart from how it was opened.
struct Shown {
  std::string state;
  std::vector<mesh::Vec3> positions;
  std::vector<std::int64_t> node_ids, shell_ids;
  std::vector<mesh::ShellNodes> shells;
  std::vector<mesh::quality::ShellState> quality;
  bool operator==(const Shown&) const = default;
};

Shown shown_by(ipc::Client& client) {
  Shown shown;
  ipc::DocumentState state = std::get<ipc::DocumentState>(client.call(ipc::GetState{}, kPatience).value());
  state.recovered_edits = 0;
  shown.state = ipc::answer_fields(state);
  const auto view = client.snapshot().value();
  for (std::size_t n = 0; n < view->node_count(); ++n) {
    shown.positions.push_back(view->position(n));
    shown.node_ids.push_back(view->node_id(n));
  }
  for (std::size_t s = 0; s < view->shell_count(); ++s) {
    shown.shell_ids.push_back(view->shell_id(s));
    shown.shells.push_back(view->shell(s));
    shown.quality.push_back(view->shell_quality(s));
  }
  return shown;
}

/// The journal of the document's edits, byte for byte.
std::string journal_in(const fs::path& folder) {
  std::string all;
  for (const auto& file : fs::directory_iterator(folder))
    if (file.path().extension() == ".journal") all += test::whole_file(file.path());
  return all;
}

/// A deck, the edits before, and the long edit that is interrupted.
struct Long {
  const char* name;
  int uneven_side;  ///< of the sheet; 0: the even one
  std::vector<std::string> first;
  std::string edit;
};
void PrintTo(const Long& what, std::ostream* out) { *out << what.name; }

/// Nodes scattered over the even sheet.
std::string scattered_nodes() {
  std::string ids;
  for (int row = 2; row < test::kSheetSide - 2; row += 7)
    for (int column = 2; column < test::kSheetSide - 2; column += 7)
      ids += (ids.empty() ? "" : ",") + std::to_string(test::kFirstNode + row * test::kSheetSide + column);
  return ids;
}

Long long_repair() {
  const std::string nodes = scattered_nodes();
  return {"repair",
          0,
          {R"({"edit":"translate","by":[2.5,1.5,4],"falloff":{"profile":"constant"},"on":")" + nodes + "\"}",
           R"({"edit":"select","expr":"1001-1100"})", R"({"edit":"translate","by":[0,0,1],"on":"1300"})"},
          R"({"edit":"repair"})"};
}

Long long_relax() {
#ifdef PRISMESH_THREAD_SANITIZER
  constexpr int kSide = 120;  // long enough where every access is checked
#else
  constexpr int kSide = 240;
#endif
  const std::string centre = std::to_string(test::kFirstNode + kSide * (kSide + 1) / 2);
  return {"relax", kSide, {R"({"edit":"translate","by":[0.5,0,0.5],"on":")" + centre + "\"}"}, R"({"edit":"relax","scope":"all"})"};
}

class CutOff : public ::testing::TestWithParam<Long> {
 protected:
  struct Station {
    explicit Station(const Long& what) : runs(folder, what.uneven_side > 0 ? folder.uneven_sheet(what.uneven_side) : folder.sheet()) {}
    Folder folder;
    RestartableDaemon runs;
  };

  /// A station whose document has had the edits before the long one.
  static std::unique_ptr<Station> edited() {
    auto station = std::make_unique<Station>(GetParam());
    station->runs.start();
    station->runs.wait_until_open();
    for (const std::string& json : GetParam().first) apply(station->runs.client(), json);
    return station;
  }

  static ipc::Edited apply(ipc::Client& client, const std::string& json) {
    const Result<ipc::Answer> answer = client.call(ipc::ApplyEdit{edit_of(json)}, kPatience);
    if (answer) return std::get<ipc::Edited>(*answer);
    ADD_FAILURE() << json << ": " << answer.error().text();
    return {};
  }

  /// The deck as it would be saved.
  static std::string saved(Station& station) {
    const fs::path target = station.folder.path() / "saved.k";
    const Result<ipc::Answer> answer = station.runs.client().call(ipc::Save{target.string()}, kPatience);
    EXPECT_TRUE(answer) << answer.error().text();
    return test::whole_file(target);
  }

  /// Sends the long edit. Returns its number after `messages` progress messages, or 0 if it ended before.
  static std::uint64_t reach_the_middle(ipc::Client& client, int messages) {
    while (client.next_event()) {
    }
    const std::uint64_t number = client.send(ipc::ApplyEdit{edit_of(GetParam().edit)}).value();
    const auto until = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < until) {
      while (const auto event = client.next_event())
        if (const auto* made = std::get_if<ipc::ProgressMade>(&*event); made != nullptr && made->fraction < 1 && --messages == 0)
          return number;
      if (client.next_reply()) return 0;
      if (!client.poll(100ms)) break;
    }
    ADD_FAILURE() << "neither progress nor an answer came";
    return 0;
  }

  /// Waits for the answer to a request.
  static ipc::Answer answer_to(ipc::Client& client, std::uint64_t number) {
    const auto until = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < until) {
      while (auto reply = client.next_reply())
        if (reply->request == number) return std::move(reply->answer);
      if (!client.poll(100ms)) break;
    }
    ADD_FAILURE() << "the answer didn't come";
    return ipc::Done{};
  }
};

/// Max. number of attempts until an interruption is early enough; one misses only if the machine stalls for as long as the edit takes.
constexpr int kMaxTries = 10;

TEST_P(CutOff, a_kill_leaves_the_document_as_it_was) {
  std::string undisturbed;
  {
    const std::unique_ptr<Station> whole = edited();
    const ipc::Edited done = apply(whole->runs.client(), GetParam().edit);
    ASSERT_GT(done.report.nodes_moved, 10u) << "the edit does nothing";
    undisturbed = saved(*whole);
    whole->runs.end_in_order();
  }
  const std::unique_ptr<Station> station = edited();
  RestartableDaemon& runs = station->runs;
  int hits = 0;
  for (int attempt = 0; attempt < kMaxTries && hits < 3 && !HasFailure(); ++attempt) {
    const Shown before = shown_by(runs.client());
    const std::string record = journal_in(station->folder.state());
    const bool in_the_middle = reach_the_middle(runs.client(), 1 + hits) != 0;
    runs.send_kill();
    runs.wait_for_end();
    runs.start();
    runs.wait_until_open();
    const bool was_done = journal_in(station->folder.state()) != record;
    EXPECT_TRUE(in_the_middle || was_done) << "an acknowledged edit was lost";
    if (was_done) {  // too late: the edit is complete
      apply(runs.client(), R"({"edit":"undo"})");
      EXPECT_TRUE(shown_by(runs.client()).positions == before.positions);
      continue;
    }
    ++hits;
    const Shown after = shown_by(runs.client());
    EXPECT_EQ(after.state, before.state);
    EXPECT_TRUE(after == before) << "a half of the edit is in the document";
  }
  EXPECT_GE(hits, 1) << "no kill came in the middle";
  apply(runs.client(), GetParam().edit);
  EXPECT_TRUE(saved(*station) == undisturbed) << "the edit has another result after a kill";
  runs.end_in_order();
}

TEST_P(CutOff, a_cancel_leaves_the_document_as_it_was) {
  const std::unique_ptr<Station> station = edited();
  ipc::Client& client = station->runs.client();
  ipc::Client view = ipc::Client::connect(ipc::model_socket_path(station->folder.path() / "run"), "view").value();
  bool hit = false;
  for (int attempt = 0; attempt < kMaxTries && !hit && !HasFailure(); ++attempt) {
    const Shown before = shown_by(client);
    const std::string record = journal_in(station->folder.state());
    if (const std::uint64_t number = reach_the_middle(client, 1); number != 0) {
      client.send(ipc::Cancel{}).value();
      EXPECT_FALSE(view.call(ipc::Cancel{}, kPatience)) << "another client's edit can't be cancelled";
      const ipc::Answer answer = answer_to(client, number);
      if (const auto* failed = std::get_if<ipc::Failed>(&answer)) {
        hit = true;
        EXPECT_EQ(failed->message, "cancelled");
        EXPECT_EQ(journal_in(station->folder.state()), record);
        const Shown after = shown_by(client);
        EXPECT_EQ(after.state, before.state);
        EXPECT_TRUE(after == before) << "a half of the edit is in the document";
      }
    }
    if (!hit) apply(client, R"({"edit":"undo"})");
  }
  ASSERT_TRUE(hit) << "no cancel came in the middle";
  // Progress messages stop, and the next edit is executed at once.
  double last = 0;
  view.call(ipc::GetState{}, kPatience).value();
  while (const auto event = view.next_event())
    if (const auto* made = std::get_if<ipc::ProgressMade>(&*event)) last = made->fraction;
  EXPECT_EQ(last, 1) << "views would show the edit for ever";
  EXPECT_EQ(apply(client, R"({"edit":"translate","by":[0,0,0.25],"on":"1313"})").report.nodes_moved, 1u);
  apply(client, R"({"edit":"undo"})");
  apply(client, GetParam().edit);
}

/// Repeats an interruption until it comes during the edit; returns false if none did.
bool tried_until_it_hits(const std::function<bool()>& stroke) {
  for (int attempt = 0; attempt < kMaxTries && !::testing::Test::HasFailure(); ++attempt)
    if (stroke()) return true;
  return false;
}

TEST_P(CutOff, the_clients_death_leaves_the_document_as_it_was) {
  const std::unique_ptr<Station> station = edited();
  ipc::Client& watcher = station->runs.client();
  EXPECT_TRUE(tried_until_it_hits([&] {
    const Shown before = shown_by(watcher);
    const std::string record = journal_in(station->folder.state());
    {
      ipc::Client dying = ipc::Client::connect(ipc::model_socket_path(station->folder.path() / "run"), "dying").value();
      reach_the_middle(dying, 1);
    }
    station->runs.wait_until_open();  // the daemon isn't busy any more
    const bool hit = journal_in(station->folder.state()) == record;
    if (hit)
      EXPECT_TRUE(shown_by(watcher) == before);
    else
      apply(watcher, R"({"edit":"undo"})");
    return hit;
  })) << "the edit of a client that had left was applied";
  EXPECT_EQ(apply(watcher, R"({"edit":"translate","by":[0,0,0.25],"on":"1313"})").report.nodes_moved, 1u);
}

TEST_P(CutOff, an_interrupted_command_leaves_the_document_as_it_was) {
  const std::unique_ptr<Station> station = edited();
  ipc::Client& watcher = station->runs.client();
  EXPECT_TRUE(tried_until_it_hits([&] {
    const Shown before = shown_by(watcher);
    const std::string record = journal_in(station->folder.state());
    while (watcher.next_event()) {
    }
    test::Process command({(test::programs_folder() / "prismesh").string(), "session", "--runtime-dir",
                           (station->folder.path() / "run").string(), "edit", GetParam().edit},
                          {});
    bool begun = false;
    for (const auto until = std::chrono::steady_clock::now() + kPatience; !begun && std::chrono::steady_clock::now() < until;) {
      while (const auto event = watcher.next_event())
        begun = begun || std::holds_alternative<ipc::ProgressMade>(*event) || std::holds_alternative<ipc::GenerationPublished>(*event);
      EXPECT_TRUE(watcher.poll(100ms));
    }
    command.kill(SIGINT);
    const int status = command.wait_for_exit();
    const bool hit = journal_in(station->folder.state()) == record;
    EXPECT_EQ(status, hit ? 1 : 0) << command.standard_error();
    if (!hit) {
      apply(watcher, R"({"edit":"undo"})");
      return false;
    }
    EXPECT_NE(command.standard_error().find("cancelled"), std::string::npos) << command.standard_error();
    EXPECT_TRUE(shown_by(watcher) == before);
    return true;
  })) << "no interrupt came in the middle";
}

INSTANTIATE_TEST_SUITE_P(LongEdits, CutOff, ::testing::Values(long_repair(), long_relax()),
                         [](const ::testing::TestParamInfo<Long>& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace prismesh::modeld
