// A daemon that gets no more memory answers so and goes on: its document is whole, and the next request is served.
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "daemon/modeld/daemon.h"
#include "ipc/client.h"
#include "mesh/document/edit_json.h"
#include "tests/daemon/modeld/folder.h"
#include "tests/faults/refused_memory.h"

namespace prismesh::modeld {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kLittle = 70'000;  ///< what the sockets' side of the daemon needs is less

TEST(Memory, WhereThereIsNoneTheClientIsToldAndTheDocumentIsWhole) {
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
    const auto state = [&] { return std::get<ipc::State>(client->call(ipc::GetState{}, 60s).value()); };
    const ipc::State before = state();
    const ipc::Request requests[] = {ipc::GetQuality{"", false},
                                     ipc::GetField{},
                                     ipc::PreviewEdit{parsed(R"({"edit":"relax","scope":"all"})")},
                                     ipc::ApplyEdit{parsed(R"({"edit":"lift","distance":2,"on":"all"})")},
                                     ipc::ApplyEdit{parsed(R"({"edit":"select","expr":"all"})")},
                                     ipc::Count{"1-20000", mesh::select::Kind::node},
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
      const ipc::State after = state();
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

}  // namespace
}  // namespace prismesh::modeld
