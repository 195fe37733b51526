// A daemon that gets no more memory answers so and goes on: its document is whole, and the next request is served.
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "daemon/modeld/daemon.h"
#include "ipc/model/client.h"
#include "mesh/document/edit_json.h"
#include "tests/daemon/modeld/folder.h"
#include "tests/faults/refused_memory.h"

namespace prismesh::modeld {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kLittle = 70'000;  ///< the daemon's socket code needs less

TEST(Memory, where_there_is_none_the_client_is_told_and_the_document_is_whole) {
  const test::Folder folder;
  DaemonOptions options;
  options.runtime_directory = folder.path() / "run";
  options.state_directory = folder.state();
  Result<Daemon> daemon = Daemon::start(options);
  ASSERT_TRUE(daemon) << daemon.error().text();
  std::thread running([&] { daemon->run(); });
  {
    Result<ipc::Client> client = ipc::Client::connect(ipc::model_socket_path(options.runtime_directory), "test");
    ASSERT_TRUE(client) << client.error().text();
    ipc::Open open;
    open.path = folder.uneven_sheet(150).string();
    ASSERT_TRUE(client->call(open, 60s));
    const auto parsed = [](const char* json) { return mesh::document::parse_edit(json).value(); };
    ASSERT_TRUE(client->call(ipc::ApplyEdit{parsed(R"({"edit":"translate","by":[0,0,0.5],"on":"all"})")}, 60s));
    const auto state = [&] { return std::get<ipc::DocumentState>(client->call(ipc::GetState{}, 60s).value()); };
    const ipc::DocumentState before = state();
    const ipc::Request requests[] = {ipc::GetQuality{"", false},
                                     ipc::GetField{},
                                     ipc::GetContacts{},
                                     ipc::PreviewEdit{parsed(R"({"edit":"relax","scope":"all"})")},
                                     ipc::ApplyEdit{parsed(R"({"edit":"lift","distance":2,"on":"all"})")},
                                     ipc::ApplyEdit{parsed(R"({"edit":"select","expr":"all"})")},
                                     ipc::Count{"1-20000", mesh::select::EntityKind::node},
                                     ipc::Save{}};
    std::size_t refused = 0;
    for (const ipc::Request& request : requests) {
      SCOPED_TRACE(request.index());
      test::refuse_allocations_from(kLittle);
      const auto answer = client->call(request, 60s);
      test::allow_all_allocations();
      if (answer) continue;  // it did with little
      ++refused;
      EXPECT_NE(answer.error().message.find("memory"), std::string::npos) << answer.error().text();
      const ipc::DocumentState after = state();
      EXPECT_EQ(after.generation, before.generation);
      EXPECT_EQ(after.journalled_edits, before.journalled_edits);
      EXPECT_EQ(after.changed, before.changed);
      ASSERT_TRUE(client->call(ipc::GetField{}, 60s)) << "the daemon goes on";
    }
    EXPECT_GE(refused, 4u);
    ASSERT_TRUE(client->call(ipc::ApplyEdit{parsed(R"({"edit":"lift","distance":2,"on":"all"})")}, 60s));
    ASSERT_TRUE(client->call(ipc::Save{}, 60s));
  }
  daemon->stop();
  running.join();
}

/// The thread that serves clients: their lines, answers and events.
TEST(Memory, where_the_loop_has_none_clients_are_told_or_cut_off_and_the_daemon_goes_on) {
  const test::Folder folder;
  DaemonOptions options;
  options.runtime_directory = folder.path() / "run";
  options.state_directory = folder.state();
  Result<Daemon> daemon = Daemon::start(options);
  ASSERT_TRUE(daemon) << daemon.error().text();
  std::thread running([&] {
    test::mark_this_thread();
    daemon->run();
  });
  {
    const auto connect = [&] { return ipc::Client::connect(ipc::model_socket_path(options.runtime_directory), "test"); };
    Result<ipc::Client> client = connect();
    ASSERT_TRUE(client) << client.error().text();
    ipc::Open open;
    open.path = folder.uneven_sheet(60).string();
    ASSERT_TRUE(client->call(open, 60s));
    const auto parsed = [](const std::string& json) { return mesh::document::parse_edit(json).value(); };
    const auto lift = parsed(R"({"edit":"lift","distance":1,"on":"all"})");
    ASSERT_TRUE(client->call(ipc::ApplyEdit{lift}, 60s));
    const auto journalled = [&] { return std::get<ipc::DocumentState>(client->call(ipc::GetState{}, 60s).value()).journalled_edits; };
    std::uint64_t edits = journalled();
    const ipc::Request requests[] = {ipc::GetQuality{"warpage", false},
                                     ipc::Count{"1" + std::string(5'000, ' '), mesh::select::EntityKind::node},
                                     ipc::GetState{},
                                     ipc::ApplyEdit{lift},
                                     ipc::GetSnapshot{},
                                     ipc::Save{}};
    std::size_t refused = 0, cut_off = 0;
    for (const ipc::Request& request : requests) {
      for (const std::size_t from : {4'000, 1'000, 300}) {
        SCOPED_TRACE(std::to_string(request.index()) + " from " + std::to_string(from));
        test::refuse_allocations_from(from, test::Where::in_marked_threads);
        const auto answer = client->call(request, 60s);
        test::allow_all_allocations();
        if (!answer && answer.error().message.find("memory") != std::string::npos) {
          ++refused;
        } else if (!answer) {
          ++cut_off;
          client = connect();
          ASSERT_TRUE(client) << client.error().text();
        }
        const std::uint64_t now = journalled();
        if (std::holds_alternative<ipc::ApplyEdit>(request)) {
          EXPECT_TRUE(now == edits + 1 || (!answer && now == edits));
        } else if (!std::holds_alternative<ipc::Save>(request)) {
          EXPECT_EQ(now, edits);
        }
        edits = now;
        ASSERT_TRUE(client->call(ipc::ApplyEdit{lift}, 60s)) << "the daemon goes on";
        ++edits;
      }
    }
    EXPECT_GE(refused, 1u);
    EXPECT_GE(cut_off, 1u);
  }
  daemon->stop();
  running.join();
}

}  // namespace
}  // namespace prismesh::modeld
