// modeld as a separate program that may be killed and restarted, and a client that reconnects.
#pragma once

#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "ipc/model/client.h"
#include "tests/daemon/modeld/folder.h"
#include "tests/station/process.h"
#include "tests/support/places.h"

namespace prismesh::test {

/// The consecutive processes of a daemon with one deck. A process dies with the thread that started it, so call `start` from the test's own
/// thread.
class RestartableDaemon {
 public:
  /// The sockets and journals are in `folder`, which must outlive this.
  RestartableDaemon(const Folder& folder, std::filesystem::path deck)
      : run_(folder.path() / "run"), state_(folder.state()), deck_(std::move(deck)), client_(ipc::model_socket_path(run_), "test") {}

  void start() {
    daemon_ = std::make_unique<Process>(std::vector<std::string>{(test::programs_folder() / "prismesh-modeld").string(), "--runtime-dir",
                                                                 run_.string(), "--state-dir", state_.string()},
                                        std::map<std::string, std::string>{});
  }

  /// Connects and waits until the document is open: by itself, or by a request if the daemon was killed too often while it opened it.
  ipc::DocumentState wait_until_open() {
    using namespace std::chrono_literals;
    const auto until = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < until) {
      const Result<ipc::Client*> client = client_.wait(5s);
      if (!client) continue;
      const auto answer = (*client)->call(ipc::GetState{}, kPatience);
      if (!answer) {
        client_.lost(answer.error());
        continue;
      }
      const auto& state = std::get<ipc::DocumentState>(*answer);
      if (state.open && !state.busy) return state;
      if (!state.busy) {
        ipc::Open open;
        open.path = deck_.string();
        (void)(*client)->call(open, kPatience);
      }
      std::this_thread::sleep_for(2ms);
    }
    ADD_FAILURE() << "the document didn't come back: " << daemon_->standard_error();
    return {};
  }

  /// Only sends the signal; may be called from any thread.
  void send_kill() { daemon_->kill(SIGKILL); }
  /// Waits for the killed process and cleans up.
  void wait_for_end() {
    client_.lost({"", 0, "killed"});
    if (daemon_->wait_for_exit() != 128 + SIGKILL) ADD_FAILURE() << daemon_->standard_error();
  }
  void end_in_order() {
    daemon_->kill(SIGTERM);
    EXPECT_EQ(daemon_->wait_for_exit(), 0) << daemon_->standard_error();
  }

  ipc::Client& client() { return *client_.client(); }
  const std::filesystem::path& deck() const { return deck_; }

 private:
  std::filesystem::path run_, state_, deck_;
  std::unique_ptr<Process> daemon_;
  ipc::ReconnectingClient client_;
};

}  // namespace prismesh::test
