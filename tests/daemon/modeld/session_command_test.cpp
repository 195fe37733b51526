// `prismesh session` and modeld as two programs, with the daemon killed in between.
#include <csignal>
#include <future>
#include <thread>

#include <gtest/gtest.h>

#include "tests/daemon/modeld/folder.h"
#include "tests/station/process.h"
#include "tests/support/places.h"

namespace prismesh::modeld {
namespace {

using test::Folder;
using test::Process;

class SessionCommand : public ::testing::Test {
 protected:
  struct Ran {
    int status = 0;
    std::string out;
    std::string err;
  };

  void start() {
    daemon_ = std::make_unique<Process>(
        std::vector<std::string>{program("prismesh-modeld"), "--runtime-dir", run_folder(), "--state-dir", folder_.state().string()},
        std::map<std::string, std::string>{});
  }
  static std::string program(const std::string& name) { return (test::programs_folder() / name).string(); }
  std::string run_folder() const { return (folder_.path() / "run").string(); }

  Ran session(const std::vector<std::string>& arguments) {
    std::vector<std::string> command{program("prismesh"), "session", "--runtime-dir", run_folder()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    Process process(command, {});
    Ran ran;
    ran.status = process.wait_for_exit();
    ran.out = process.all_output();
    ran.err = process.standard_error();
    return ran;
  }
  /// Requests the state until the daemon's socket exists.
  void wait_until_there() {
    for (int i = 0; i < 500 && session({"state"}).status != 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }

  Folder folder_;
  std::unique_ptr<Process> daemon_;
};

const char* const kMoveCorner = R"({"edit": "translate", "by": [0, 0, 0.25], "on": "1313"})";

TEST_F(SessionCommand, without_a_daemon_it_says_so_at_once) {
  const Ran ran = session({"state"});
  EXPECT_EQ(ran.status, 1);
  EXPECT_NE(ran.err.find("nobody listens there"), std::string::npos) << ran.err;
}

TEST_F(SessionCommand, edits_and_saves_the_open_document) {
  const auto deck = folder_.sheet();
  const std::string original = test::whole_file(deck);
  start();
  wait_until_there();
  EXPECT_EQ(session({"edit", kMoveCorner}).status, 1) << "nothing is open";
  ASSERT_EQ(session({"open", deck.string()}).status, 0);
  const Ran edited = session({"--json", "edit", kMoveCorner, kMoveCorner});
  EXPECT_EQ(edited.status, 0) << edited.err;
  EXPECT_EQ(std::count(edited.out.begin(), edited.out.end(), '\n'), 2);
  EXPECT_NE(edited.out.find("\"nodes_moved\":1"), std::string::npos) << edited.out;
  EXPECT_EQ(session({"undo"}).status, 0);
  EXPECT_EQ(session({"close"}).status, 1) << "unsaved edits";
  EXPECT_EQ(session({"edit", "{"}).status, 2) << "no JSON is wrong usage";
  EXPECT_EQ(session({"save"}).status, 0);
  EXPECT_EQ(test::compare_decks(original, test::whole_file(deck)).nodes, std::vector<std::int64_t>{1313});
  EXPECT_EQ(session({"close"}).status, 0);
  EXPECT_NE(session({"state"}).out.find("no document is open"), std::string::npos);
  daemon_->kill(SIGTERM);
  EXPECT_EQ(daemon_->wait_for_exit(), 0);
}

TEST_F(SessionCommand, prints_the_warnings_of_the_open_deck) {
  const auto deck = folder_.two_files();
  std::filesystem::remove(folder_.path() / "rest.k");
  start();
  wait_until_there();
  const Ran opened = session({"open", deck.string()});
  EXPECT_EQ(opened.status, 0);
  EXPECT_NE(opened.err.find(deck.string() + ":7: warning: the include file rest.k isn't there"), std::string::npos) << opened.err;
  EXPECT_EQ(session({"state"}).err, opened.err);
  const Ran json = session({"--json", "state"});
  EXPECT_NE(json.out.find("missing-include"), std::string::npos) << json.out;
  EXPECT_EQ(json.err, "");
}

/// Exceeding the limit on file sizes ends a program by a signal unless the program ignores it.
TEST_F(SessionCommand, a_file_that_may_not_grow_is_an_error_and_does_not_end_it) {
  const auto deck = folder_.sheet();
  const std::string limited = "ulimit -f 8; exec \"$@\"";
  daemon_ = std::make_unique<Process>(std::vector<std::string>{"/bin/sh", "-c", limited, "sh", program("prismesh-modeld"), "--runtime-dir",
                                                               run_folder(), "--state-dir", folder_.state().string()},
                                      std::map<std::string, std::string>{});
  wait_until_there();
  ASSERT_EQ(session({"open", deck.string()}).status, 0);
  std::vector<std::string> many{"edit"};
  many.resize(100, kMoveCorner);
  const Ran refused = session(many);
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.err.find("the edit wasn't made"), std::string::npos) << refused.err;
  EXPECT_EQ(session({"state"}).status, 0) << "the daemon lives";

  const auto target = folder_.path() / "out/sample.k";
  Process sample({"/bin/sh", "-c", limited, "sh", program("prismesh"), "sample", "-o", target.string()}, {});
  EXPECT_EQ(sample.wait_for_exit(), 1);
  EXPECT_NE(sample.standard_error().find("can't be written"), std::string::npos) << sample.standard_error();
  EXPECT_FALSE(std::filesystem::exists(target.parent_path())) << "a failed save leaves no folder";
}

TEST_F(SessionCommand, continues_when_the_daemon_is_restarted) {
  const auto deck = folder_.sheet();
  start();
  wait_until_there();
  ASSERT_EQ(session({"open", deck.string()}).status, 0);
  ASSERT_EQ(session({"edit", kMoveCorner}).status, 0);
  daemon_->kill(SIGKILL);
  daemon_->wait_for_exit();
  // The test's own thread starts the daemon, because it ends with the thread that started it (see Process).
  std::future<Ran> editing = std::async(std::launch::async, [this] { return session({"edit", kMoveCorner}); });
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  start();
  const Ran edited = editing.get();
  EXPECT_EQ(edited.status, 0) << edited.err;
  const Ran state = session({"--json", "state"});
  EXPECT_NE(state.out.find("\"recovered_edits\":1"), std::string::npos) << state.out;
  EXPECT_NE(state.out.find("\"journalled_edits\":2"), std::string::npos) << state.out;
}

}  // namespace
}  // namespace prismesh::modeld
