// `prismesh session` with a simulated daemon: its requests, and its behaviour when the daemon ends in the middle of an edit.
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "ipc/model/messages_json.h"
#include "ipc/model/state_page.h"
#include "ipc/wire/server.h"
#include "tests/cli/cli_fixture.h"

namespace prismesh::cli {
namespace {

/// Welcomes everybody, has one state before the first edit and one after it, and writes down what it is asked for.
class PlayedDaemon final : public ipc::ServerHandler {
 public:
  PlayedDaemon(const std::filesystem::path& socket, ipc::DocumentState before, ipc::DocumentState after)
      : page_(ipc::StatePage::create().value()),
        state_(std::move(before)),
        after_(std::move(after)),
        server_(ipc::Server::listen(socket, *this).value()) {
    thread_ = std::thread([this] { server_.run(); });
  }
  ~PlayedDaemon() override {
    server_.stop();
    thread_.join();
  }
  PlayedDaemon(const PlayedDaemon&) = delete;
  PlayedDaemon& operator=(const PlayedDaemon&) = delete;

  void connected(ipc::ClientId) override {}
  void disconnected(ipc::ClientId, const std::string&) override {}
  void line(ipc::ClientId client, std::string_view text) override {
    const auto asked = ipc::decode_request(text);
    ASSERT_TRUE(asked) << asked.error().message;
    if (std::holds_alternative<ipc::Hello>(asked->request)) {
      std::vector<ipc::Descriptor> descriptors;
      descriptors.push_back(page_.descriptor().duplicate().value());
      server_.send(client, ipc::encode_answer(asked->number, ipc::Welcome{ipc::kProtocolVersion, "test", client}, 1),
                   std::move(descriptors));
      return;
    }
    const std::lock_guard lock(mutex_);
    if (std::holds_alternative<ipc::GetState>(asked->request)) return server_.send(client, ipc::encode_answer(asked->number, state_));
    asked_.push_back(asked->request);
    if (!std::holds_alternative<ipc::ApplyEdit>(asked->request))
      return server_.send(client, ipc::encode_answer(asked->number, ipc::Done{}));
    // The first edit is the last thing that it does before it is started again.
    state_ = after_;
    if (asked_.size() == 1) return server_.cut(client, "it ends");
    ipc::Edited edited;
    edited.report.nodes_moved = 1;
    server_.send(client, ipc::encode_answer(asked->number, edited));
  }
  std::vector<ipc::Request> asked() {
    const std::lock_guard lock(mutex_);
    return asked_;
  }

 private:
  ipc::StatePage page_;
  std::mutex mutex_;
  ipc::DocumentState state_, after_;
  std::vector<ipc::Request> asked_;
  ipc::Server server_;
  std::thread thread_;
};

ipc::DocumentState played_state(const std::string& path, std::uint64_t journalled_edits) {
  ipc::DocumentState state;
  state.open = true;
  state.path = path;
  state.journalled_edits = journalled_edits;
  return state;
}

class PlayedSession : public Cli {
 protected:
  Outcome session(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"session", "--runtime-dir", path("run")});
    return prismesh(arguments);
  }
  std::filesystem::path socket() const { return folder / "run" / "model.sock"; }
  /// The only thing that the daemon is asked for.
  ipc::Request asked_by(const std::vector<std::string>& arguments) const {
    PlayedDaemon daemon(socket(), {}, {});
    const Outcome outcome = session(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const std::vector<ipc::Request> asked = daemon.asked();
    EXPECT_EQ(asked.size(), 1u);
    return asked.empty() ? ipc::Request{} : asked.front();
  }
};

TEST_F(PlayedSession, an_edit_is_done_once_though_the_daemon_ends_in_the_middle) {
  struct Case {
    const char* path_after;
    std::uint64_t edits_after;
    int status;
    std::size_t times_asked;
    const char* said;
  };
  for (const Case& each :
       {Case{"/a.k", 8, 0, 1, "the edit is done"}, Case{"/a.k", 7, 0, 2, "1 node moved"}, Case{"/a.k", 9, 1, 1, "others were editing too"},
        Case{"/a.k", 6, 1, 1, "others were editing too"}, Case{"/b.k", 8, 1, 1, "restarted with another document"}}) {
    PlayedDaemon daemon(socket(), played_state("/a.k", 7), played_state(each.path_after, each.edits_after));
    const Outcome outcome = session({"edit", R"({"edit": "translate", "by": [0, 0, 0.25], "on": "1313"})"});
    EXPECT_EQ(outcome.status, each.status) << each.said;
    EXPECT_EQ(daemon.asked().size(), each.times_asked) << each.said;
    EXPECT_THAT(outcome.out + outcome.err, HasSubstr(each.said));
  }
}

TEST_F(PlayedSession, files_are_named_from_the_folder_that_the_command_is_in) {
  const std::filesystem::path here = std::filesystem::current_path();
  const auto open = std::get<ipc::Open>(asked_by({"open", "sub/deck.k", "--criteria", "own.toml"}));
  EXPECT_EQ(open.path, here / "sub/deck.k");
  ASSERT_EQ(open.rules.size(), 1u);
  EXPECT_EQ(open.rules[0].criteria, here / "own.toml");
  const auto whole = std::get<ipc::Open>(asked_by({"open", "/decks/deck.k", "--criteria", "/criteria/own.toml"}));
  EXPECT_EQ(whole.path, "/decks/deck.k");
  ASSERT_EQ(whole.rules.size(), 1u);
  EXPECT_EQ(whole.rules[0].criteria, "/criteria/own.toml");
  EXPECT_TRUE(std::get<ipc::Open>(asked_by({"open", "deck.k"})).rules.empty());
  const auto ours = std::get<ipc::Open>(asked_by({"open", "deck.k", "--criteria", "strict"}));
  ASSERT_EQ(ours.rules.size(), 1u);
  EXPECT_EQ(ours.rules[0].criteria, "strict") << "criteria of ours";
  EXPECT_EQ(std::get<ipc::Save>(asked_by({"save", "copy.k"})).path, here / "copy.k");
  EXPECT_EQ(std::get<ipc::Save>(asked_by({"save"})).path, std::nullopt) << "in place";
}

TEST_F(PlayedSession, unsaved_edits_are_given_up_only_where_that_is_said) {
  EXPECT_FALSE(std::get<ipc::Close>(asked_by({"close"})).discard);
  EXPECT_TRUE(std::get<ipc::Close>(asked_by({"close", "--discard"})).discard);
}

}  // namespace
}  // namespace prismesh::cli
