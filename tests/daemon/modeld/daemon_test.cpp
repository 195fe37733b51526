// The daemon as its clients see it, in this process, so that ThreadSanitizer sees both sides.
#include "daemon/modeld/daemon.h"

#include <algorithm>
#include <thread>

#include <gtest/gtest.h>
#include <poll.h>

#include "ipc/model/client.h"
#include "ipc/model/messages_json.h"
#include "ipc/wire/line_socket.h"
#include "ipc/wire/server.h"
#include "tests/daemon/modeld/folder.h"

namespace prismesh::modeld {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using namespace mesh::document;
using ipc::Client;
using test::Folder;

constexpr auto kServingPatience = 60s;

class Serving : public ::testing::Test {
 protected:
  void SetUp() override { start(); }
  void TearDown() override { stop(); }

  void start() {
    daemon_.emplace(Daemon::start({folder_.path() / "run", folder_.state()}).value());
    thread_ = std::thread([this] { daemon_->run(); });
  }
  void stop() {
    if (!daemon_) return;
    daemon_->stop();
    thread_.join();
    daemon_.reset();
  }
  Client client(const std::string& name = "test") { return Client::connect(ipc::model_socket_path(folder_.path() / "run"), name).value(); }

  ipc::DocumentState open(Client& client, const fs::path& deck) {
    ipc::Open request;
    request.path = deck.string();
    return std::get<ipc::DocumentState>(client.call(request, kServingPatience).value());
  }

  Folder folder_;
  std::optional<Daemon> daemon_;
  std::thread thread_;
};

Translate move_node(std::int64_t id, double by) {
  Translate translate;
  translate.by = {0, 0, by};
  translate.shaping.on = std::to_string(id);
  return translate;
}
Translate patch() {
  Translate translate;
  translate.shaping.on = "1001-1200";
  return translate;
}

/// Returns the next event of a type; fails the test if none comes.
template <class E>
std::optional<E> next(Client& client) {
  const auto until = std::chrono::steady_clock::now() + kServingPatience;
  while (std::chrono::steady_clock::now() < until) {
    while (const auto event = client.next_event())
      if (const auto* wanted = std::get_if<E>(&*event)) return *wanted;
    if (!client.poll(100ms)) break;
  }
  ADD_FAILURE() << "the event didn't come";
  return std::nullopt;
}

double height(const ipc::SnapshotView& view, std::int64_t id) {
  for (std::size_t n = 0; n < view.node_count(); ++n)
    if (view.node_id(n) == id) return view.position(n).z();
  ADD_FAILURE() << "no node " << id;
  return 0;
}

TEST_F(Serving, two_clients_watch_one_document) {
  Client editor = client("editor");
  Client watcher = client("watcher");
  EXPECT_NE(editor.welcome().client, watcher.welcome().client);
  EXPECT_EQ(open(editor, folder_.sheet()).nodes, 625u);
  EXPECT_TRUE(next<ipc::DocumentOpened>(watcher));
  const auto before = watcher.snapshot();
  ASSERT_TRUE(before) << before.error().text();

  const auto edited = editor.call(ipc::ApplyEdit{move_node(1313, 0.25)}, kServingPatience);
  ASSERT_TRUE(edited) << edited.error().text();
  EXPECT_EQ(std::get<ipc::Edited>(*edited).report.nodes_moved, 1u);
  std::optional<ipc::GenerationPublished> published = next<ipc::GenerationPublished>(watcher);
  while (published && published->made_by != "translate") published = next<ipc::GenerationPublished>(watcher);
  const auto after = watcher.snapshot();
  ASSERT_TRUE(after);
  EXPECT_EQ(height(**after, 1313), height(**before, 1313) + 0.25);
  EXPECT_TRUE((*after)->info().changed);
  EXPECT_EQ((*after)->chunk_version(ipc::SnapshotArray::shell_nodes, 0), (*before)->chunk_version(ipc::SnapshotArray::shell_nodes, 0));
  EXPECT_NE((*after)->chunk_version(ipc::SnapshotArray::positions, 0), (*before)->chunk_version(ipc::SnapshotArray::positions, 0));
}

TEST_F(Serving, a_drag_is_previewed_and_committed) {
  Client owner = client();
  open(owner, folder_.sheet());
  const auto answer = owner.call(ipc::BeginDrag{patch()}, kServingPatience);
  ASSERT_TRUE(answer) << answer.error().text();
  const auto& begun = std::get<ipc::DragBegun>(*answer);
  const ipc::PreviewReader preview = owner.take_preview(begun).value();
  ASSERT_EQ(preview.nodes().size(), begun.nodes);
  ASSERT_GT(begun.nodes, 0u);

  // Hundreds of steps without a pause: intermediate ones may be skipped, the last one arrives.
  for (std::uint64_t i = 1; i <= 500; ++i) ASSERT_TRUE(owner.send(ipc::DragStep{begun.drag, i, {0, 0, 0.001 * static_cast<double>(i)}, 0}));
  const auto committed = owner.call(ipc::CommitDrag{begun.drag}, kServingPatience);
  ASSERT_TRUE(committed) << committed.error().text();
  ipc::PreviewFrame frame;
  ASSERT_TRUE(preview.latest(frame));
  EXPECT_EQ(frame.sequence, 500u);
  const auto view = owner.snapshot().value();
  for (std::size_t i = 0; i < preview.nodes().size(); ++i) EXPECT_EQ(view->position(preview.nodes()[i].value), frame.positions[i]);
  EXPECT_TRUE(next<ipc::DragEnded>(owner)->committed);
}

TEST_F(Serving, an_expression_is_counted_and_selects_nothing) {
  Client client = this->client();
  const ipc::DocumentState before = open(client, folder_.sheet());
  const auto ask = [&](const std::string& expr, mesh::select::EntityKind kind) {
    return client.call(ipc::Count{expr, kind}, kServingPatience).value();
  };
  EXPECT_EQ(std::get<ipc::Counted>(ask("1001-1025", mesh::select::EntityKind::node)).nodes, 25u);
  const auto parts = std::get<ipc::Counted>(ask("all", mesh::select::EntityKind::part));
  EXPECT_EQ(parts.parts, before.parts);
  EXPECT_EQ(parts.shells, before.shells);
  const auto refused = client.call(ipc::Count{"1001,9", mesh::select::EntityKind::node}, kServingPatience);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().file, "expression");
  EXPECT_EQ(refused.error().line, 6) << "the column";
  const auto after = std::get<ipc::DocumentState>(client.call(ipc::GetState{}, kServingPatience).value());
  EXPECT_EQ(after.generation, before.generation);
  EXPECT_EQ(after.selected_nodes, 0u);
}

TEST_F(Serving, counting_a_long_expression_can_be_cancelled) {
  Client asker = client();
  open(asker, folder_.sheet());
  std::string expression = "1001";
#ifdef PRISMESH_THREAD_SANITIZER
  constexpr std::size_t kLong = 2 << 20;  // long enough where every access is checked
#else
  constexpr std::size_t kLong = 7 << 20;
#endif
  while (expression.size() < kLong) expression += ",1002,!1003";
  const std::uint64_t number = asker.send(ipc::Count{expression, mesh::select::EntityKind::node}).value();
  EXPECT_TRUE(asker.call(ipc::Cancel{}, kServingPatience)) << "it is under way";
  for (const auto until = std::chrono::steady_clock::now() + kServingPatience; std::chrono::steady_clock::now() < until;) {
    const auto reply = asker.next_reply();
    if (!reply && asker.poll(100ms)) continue;
    ASSERT_TRUE(reply && reply->request == number);
    const auto* failed = std::get_if<ipc::Failed>(&reply->answer);
    ASSERT_NE(failed, nullptr);
    EXPECT_EQ(failed->message, "cancelled");
    return;
  }
  FAIL() << "no answer came";
}

TEST_F(Serving, only_the_owner_steps_and_ends_a_drag) {
  Client owner = client("owner");
  Client other = client("other");
  open(owner, folder_.sheet());
  const auto begun = std::get<ipc::DragBegun>(owner.call(ipc::BeginDrag{patch()}, kServingPatience).value());
  const ipc::PreviewReader preview = owner.take_preview(begun).value();
  const auto second = other.call(ipc::BeginDrag{patch()}, kServingPatience);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().message, "another view is dragging; try again when it has let go");
  EXPECT_FALSE(other.call(ipc::CommitDrag{begun.drag}, kServingPatience));
  EXPECT_FALSE(other.call(ipc::CancelDrag{begun.drag}, kServingPatience));
  ASSERT_TRUE(other.send(ipc::DragStep{begun.drag, 9, {0, 0, 1}, 0}));
  ASSERT_TRUE(other.call(ipc::GetState{}, kServingPatience));
  ASSERT_TRUE(owner.call(ipc::CancelDrag{begun.drag}, kServingPatience));
  ipc::PreviewFrame frame;
  EXPECT_FALSE(preview.latest(frame)) << "a stranger's step was taken";
  EXPECT_FALSE(next<ipc::DragEnded>(other)->committed);
  EXPECT_FALSE(std::get<ipc::DocumentState>(owner.call(ipc::GetState{}, kServingPatience).value()).changed);
}

TEST_F(Serving, edits_wait_until_the_drag_ends) {
  Client owner = client("owner");
  Client other = client("other");
  open(owner, folder_.sheet());
  const auto begun = std::get<ipc::DragBegun>(owner.call(ipc::BeginDrag{patch()}, kServingPatience).value());
  const std::uint64_t edit = other.send(ipc::ApplyEdit{move_node(1313, 0.25)}).value();
  ASSERT_TRUE(other.call(ipc::GetState{}, kServingPatience)) << "states are reported during a drag";
  ASSERT_TRUE(other.snapshot()) << "and snapshots are sent";
  EXPECT_FALSE(other.next_reply()) << "the edit didn't wait";
  ASSERT_TRUE(owner.send(ipc::DragStep{begun.drag, 1, {0, 0, 1}, 0}));
  ASSERT_TRUE(owner.call(ipc::CommitDrag{begun.drag}, kServingPatience));
  std::optional<Client::Reply> reply;
  while (!(reply = other.next_reply())) ASSERT_TRUE(other.poll(100ms));
  EXPECT_EQ(reply->request, edit);
  EXPECT_TRUE(std::holds_alternative<ipc::Edited>(reply->answer));
}

TEST_F(Serving, the_owners_death_cancels_its_drag) {
  Client watcher = client("watcher");
  open(watcher, folder_.sheet());
  {
    Client owner = client("owner");
    const auto begun = std::get<ipc::DragBegun>(owner.call(ipc::BeginDrag{patch()}, kServingPatience).value());
    ASSERT_TRUE(owner.send(ipc::DragStep{begun.drag, 1, {0, 0, 1}, 0}));
  }
  const auto ended = next<ipc::DragEnded>(watcher);
  ASSERT_TRUE(ended);
  EXPECT_FALSE(ended->committed);
  EXPECT_EQ(ended->why, "its client has gone");
  EXPECT_FALSE(std::get<ipc::DocumentState>(watcher.call(ipc::GetState{}, kServingPatience).value()).changed);
  EXPECT_TRUE(watcher.call(ipc::BeginDrag{patch()}, kServingPatience)) << "others may drag again";
}

TEST_F(Serving, a_drag_that_moves_nothing_leaves_nothing) {
  Client owner = client();
  const std::uint64_t generation = open(owner, folder_.sheet()).generation;
  const auto begun = std::get<ipc::DragBegun>(owner.call(ipc::BeginDrag{patch()}, kServingPatience).value());
  const auto committed = owner.call(ipc::CommitDrag{begun.drag}, kServingPatience);
  ASSERT_TRUE(committed);
  EXPECT_EQ(std::get<ipc::Edited>(*committed).generation, generation);
  EXPECT_FALSE(next<ipc::DragEnded>(owner)->committed);
}

TEST_F(Serving, refusals_are_sentences) {
  Client one = client();
  EXPECT_EQ(one.call(ipc::ApplyEdit{move_node(1, 0.25)}, kServingPatience).error().message, "no document is open");
  EXPECT_EQ(one.snapshot().error().message, "no document is open");
  EXPECT_EQ(one.call(ipc::BeginDrag{patch()}, kServingPatience).error().message, "no document is open");
  EXPECT_EQ(one.call(ipc::CommitDrag{7}, kServingPatience).error().message, "you hold no drag 7");
  for (const ipc::Request& request :
       {ipc::Request(ipc::Save{}), ipc::Request(ipc::Count{"1", {}}), ipc::Request(ipc::GetQuality{}), ipc::Request(ipc::FindShells{}),
        ipc::Request(ipc::PreviewEdit{move_node(1, 0.25)}), ipc::Request(ipc::FindFollowedEdges{move_node(1, 0.25)}),
        ipc::Request(ipc::GetField{}), ipc::Request(ipc::GetContacts{})}) {
    const auto refused = one.call(request, kServingPatience);
    ASSERT_FALSE(refused) << request.index();
    EXPECT_EQ(refused.error().message, "no document is open") << request.index();
  }
  ipc::Open nothing;
  nothing.path = (folder_.path() / "nothing.k").string();
  EXPECT_EQ(one.call(nothing, kServingPatience).error().file, nothing.path);
  open(one, folder_.sheet());
  const auto refused = one.call(ipc::ApplyEdit{move_node(99, 0.25)}, kServingPatience);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().file, "expression");
  ASSERT_TRUE(one.call(ipc::ApplyEdit{move_node(1313, 0.25)}, kServingPatience));
  EXPECT_FALSE(one.call(ipc::Close{false}, kServingPatience)) << "unsaved edits";
  EXPECT_TRUE(one.call(ipc::Close{true}, kServingPatience));
  EXPECT_TRUE(next<ipc::DocumentClosed>(one));
}

TEST_F(Serving, tells_which_free_edges_would_follow) {
  Client one = client();
  open(one, folder_.sheet());
  mesh::document::Translate all;
  all.shaping.on = "all";
  all.shaping.weights.falloff.profile = mesh::shape::Profile::constant;
  const auto answer = one.call(ipc::FindFollowedEdges{all}, kServingPatience);
  ASSERT_TRUE(answer) << answer.error().text();
  const auto* found = std::get_if<ipc::FollowedEdges>(&*answer);
  ASSERT_NE(found, nullptr);
  EXPECT_GT(found->edge_count, 3u);
  EXPECT_EQ(found->nodes.size(), 2 * found->edge_count);
  EXPECT_FALSE(one.call(ipc::FindFollowedEdges{mesh::document::Undo{}}, kServingPatience));
  const auto state = one.call(ipc::GetState{}, kServingPatience);
  ASSERT_TRUE(state) << state.error().text();
  EXPECT_EQ(std::get<ipc::DocumentState>(*state).generation, found->generation) << "nothing was done";
}

TEST_F(Serving, every_client_learns_which_deck_a_save_continues_as) {
  Client editor = client("editor"), watcher = client("watcher");
  const fs::path deck = folder_.sheet(), other = folder_.path() / "other.k", copy = folder_.path() / "copy.k";
  open(editor, deck);
  ASSERT_EQ(next<ipc::DocumentOpened>(watcher)->path, deck.string());
  ipc::Save save;
  save.path = copy.string();
  ASSERT_TRUE(editor.call(save, kServingPatience));
  save.path = other.string();
  save.becomes = true;
  ASSERT_TRUE(editor.call(save, kServingPatience));
  EXPECT_EQ(next<ipc::DocumentOpened>(watcher)->path, other.string()) << "and not of the copy";
  // Without a new journal to continue with, it is saved in place.
  ASSERT_TRUE(editor.call(ipc::ApplyEdit{move_node(1313, 0.25)}, kServingPatience));
  save.path.reset();
  const auto saved = editor.call(save, kServingPatience);
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(std::get<ipc::DocumentState>(editor.call(ipc::GetState{}, kServingPatience).value()).path, other.string());
}

TEST_F(Serving, a_client_must_greet_in_the_same_protocol) {
  const fs::path path = ipc::model_socket_path(folder_.path() / "run");
  const auto first_answer = [&](const std::string& line) -> std::string {
    ipc::LineSocket socket(ipc::connect_to(path).value(), {});
    socket.queue(line);
    EXPECT_TRUE(socket.flush());
    for (;;) {
      if (const auto answer = socket.next_line()) return std::string(*answer);
      pollfd ready{socket.descriptor(), POLLIN, 0};
      if (::poll(&ready, 1, 60'000) <= 0 || !socket.receive()) return "nothing";
    }
  };
  EXPECT_NE(
      first_answer(R"({"request": "hello", "protocol": 99, "program": "old thing"})").find("speaks protocol 1, old thing protocol 99"),
      std::string::npos);
  EXPECT_NE(first_answer(R"({"request": "get_state", "number": 4})").find("must be a hello"), std::string::npos);
  EXPECT_NE(first_answer(R"({"request": "hello", "protocl": 1, "number": 5})").find("the nearest is \\\"protocol\\\""), std::string::npos);
  EXPECT_NE(first_answer("rubbish").find("it isn't JSON"), std::string::npos);
}

TEST_F(Serving, clients_that_never_greet_block_no_other_client) {
  const fs::path path = ipc::model_socket_path(folder_.path() / "run");
  Client first = client("first");
  std::vector<ipc::Descriptor> silent;
  for (std::size_t i = 0; i < ipc::ServerLimits{}.clients; ++i) silent.push_back(ipc::connect_to(path).value());
  Client last = client("last");  // behind all of them
  EXPECT_TRUE(last.call(ipc::GetState{}, kServingPatience));
  const auto state = first.call(ipc::GetState{}, kServingPatience);
  EXPECT_TRUE(state) << state.error().text();
}

TEST_F(Serving, two_snapshots_are_transferred_together) {
  Client client = this->client();
  open(client, folder_.sheet());
  std::vector<std::shared_ptr<const ipc::SnapshotView>> held{client.snapshot().value()};
  const double flat = height(*held.front(), 1313);
  const auto take = [&](std::uint64_t request) {
    while (const auto reply = client.next_reply())
      if (reply->request == request) return client.take_snapshot(std::get<ipc::Snapshot>(reply->answer));
    return Result<std::shared_ptr<const ipc::SnapshotView>>(fail("", "no answer"));
  };
  // Holds the memory of each state, so that sooner or later a state uses other segments than its predecessor.
  bool left_a_segment = false;
  for (int i = 1; i <= 8; ++i) {
    SCOPED_TRACE(i);
    ipc::GetSnapshot ask;
    ask.have_segments = client.segments();
    const std::vector<std::uint64_t>& before = ask.have_segments;
    ASSERT_TRUE(client.call(ipc::ApplyEdit{move_node(1313, i)}, kServingPatience));
    const std::uint64_t edited = client.send(ask).value();
    ASSERT_TRUE(client.call(ipc::ApplyEdit{Undo{}}, kServingPatience));
    const std::uint64_t undone = client.send(ask).value();
    ASSERT_TRUE(client.call(ipc::GetState{}, kServingPatience));
    const auto one = take(edited);
    ASSERT_TRUE(one) << one.error().text();
    const std::vector<std::uint64_t> between = client.segments();
    left_a_segment |= !std::includes(between.begin(), between.end(), before.begin(), before.end());
    const auto other = take(undone);
    ASSERT_TRUE(other) << other.error().text();
    EXPECT_EQ(height(**one, 1313), flat + i);
    EXPECT_EQ(height(**other, 1313), flat);
    held.push_back(*one);
  }
  EXPECT_TRUE(left_a_segment) << "this looks at nothing";
}

TEST_F(Serving, health_is_published_without_a_request) {
  Client one = client();
  const auto first = one.health();
  ASSERT_TRUE(first);
  EXPECT_FALSE(first->open);
  open(one, folder_.sheet());
  for (int i = 0; i < 600 && !one.health()->open; ++i) std::this_thread::sleep_for(10ms);
  EXPECT_TRUE(one.health()->open);
  const std::int64_t heartbeat = one.health()->heartbeat_ns;
  for (int i = 0; i < 600 && one.health()->heartbeat_ns == heartbeat; ++i) std::this_thread::sleep_for(10ms);
  EXPECT_GT(one.health()->heartbeat_ns, heartbeat) << "the heartbeat continues by itself";
}

TEST_F(Serving, a_restart_is_seen_and_the_document_is_back) {
  const fs::path deck = folder_.sheet();
  Client one = client();
  open(one, deck);
  ASSERT_TRUE(one.call(ipc::ApplyEdit{move_node(1313, 0.25)}, kServingPatience));
  const double moved = height(**one.snapshot(), 1313);
  stop();
  EXPECT_FALSE(one.call(ipc::GetState{}, kServingPatience));
  start();
  Client again = client();
  ipc::DocumentState state;
  for (int i = 0; i < 6000 && !state.open; ++i) {
    state = std::get<ipc::DocumentState>(again.call(ipc::GetState{}, kServingPatience).value());
    std::this_thread::sleep_for(10ms);
  }
  EXPECT_EQ(state.path, deck.string());
  EXPECT_EQ(state.recovered_edits, 1u);
  EXPECT_EQ(height(**again.snapshot(), 1313), moved);
}

TEST_F(Serving, one_state_folder_has_one_daemon) {
  const auto second = Daemon::start({folder_.path() / "run2", folder_.state()});
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("already runs here"), std::string::npos);
  const auto third = Daemon::start({folder_.path() / "run", folder_.path() / "state2"});
  ASSERT_FALSE(third);
  EXPECT_NE(third.error().message.find("already runs here"), std::string::npos);
}

TEST_F(Serving, snapshots_of_a_client_that_dies_are_returned) {
  Client editor = client("editor");
  open(editor, folder_.sheet());
  for (int i = 0; i < 20; ++i) {
    Client viewer = client("viewer");
    for (int k = 0; k < 20; ++k) {
      ASSERT_TRUE(editor.call(ipc::ApplyEdit{move_node(1313, 0.25)}, kServingPatience));
      const auto view = viewer.snapshot();
      ASSERT_TRUE(view) << view.error().text();
    }
  }
  // The segment number shows that memory is reused: 400 generations would need dozens of segments.
  const auto last = editor.call(ipc::GetSnapshot{}, kServingPatience);
  EXPECT_LE(std::get<ipc::Snapshot>(*last).segments.size(), 12u);
}

}  // namespace
}  // namespace prismesh::modeld
