// A daemon that hangs ends itself; its supervisor restarts it, and all acknowledged edits are still there.
#include <csignal>
#include <fstream>

#include <gtest/gtest.h>

#include "ipc/model/client.h"
#include "mesh/document/edit_json.h"
#include "tests/daemon/modeld/folder.h"
#include "tests/station/process.h"
#include "tests/support/places.h"

namespace prismesh::modeld {
namespace {

namespace fs = std::filesystem;
using test::kPatience;
using test::Process;

class Hang : public ::testing::Test {
 protected:
  Hang() { std::ofstream(settings()) << "[document]\nhang_s = 3\n"; }

  fs::path settings() const { return folder_.path() / "settings.toml"; }
  fs::path run() const { return folder_.path() / "run"; }
  /// The next call of that kind never returns.
  void hang_next() const { std::ofstream(folder_.path() / "mark") << "hang"; }
  std::map<std::string, std::string> environment(const std::string& call) const {
    return {{"LD_PRELOAD", (test::programs_folder() / "libfile_calls_preload.so").string()},
            {"PRISMESH_HANG_IN", call},
            {"PRISMESH_HANG_MARK", (folder_.path() / "mark").string()}};
  }
  std::vector<std::string> modeld() const {
    return {(test::programs_folder() / "prismesh-modeld").string(),
            "--runtime-dir",
            run().string(),
            "--state-dir",
            folder_.state().string(),
            "--config",
            settings().string()};
  }
  static Result<ipc::Answer> lift(ipc::Client& client) {
    const char* const edit = R"({"edit":"translate","by":[0,0,0.25],"on":"1313","falloff":{"profile":"constant"}})";
    return client.call(ipc::ApplyEdit{mesh::document::parse_edit(edit).value()}, kPatience);
  }
  /// Opens the deck and makes an edit.
  void begin(ipc::Client& client) {
    ipc::Open open;
    open.path = folder_.sheet().string();
    ASSERT_TRUE(client.call(open, kPatience));
    ASSERT_TRUE(lift(client));
  }
  static std::uint64_t journalled(ipc::Client& client) {
    const Result<ipc::Answer> state = client.call(ipc::GetState{}, kPatience);
    return state ? std::get<ipc::DocumentState>(*state).journalled_edits : 0;
  }

  test::Folder folder_;
};

TEST_F(Hang, an_edit_that_cant_be_journalled_ends_the_daemon) {
  Process daemon(modeld(), environment("sync"));
  ipc::ReconnectingClient connection(ipc::model_socket_path(run()), "test");
  const Result<ipc::Client*> client = connection.wait(kPatience);
  ASSERT_TRUE(client) << client.error().text();
  begin(**client);
  hang_next();
  EXPECT_FALSE(lift(**client)) << "it was never acknowledged";
  EXPECT_EQ(daemon.wait_for_exit(), 128 + SIGABRT);
  EXPECT_NE(daemon.standard_error().find("the work under way makes no progress"), std::string::npos) << daemon.standard_error();
}

TEST_F(Hang, clients_that_arent_served_end_the_daemon) {
  Process daemon(modeld(), environment("accept"));
  ipc::ReconnectingClient connection(ipc::model_socket_path(run()), "test");
  const Result<ipc::Client*> client = connection.wait(kPatience);
  ASSERT_TRUE(client) << client.error().text();
  hang_next();
  EXPECT_FALSE(ipc::Client::connect(ipc::model_socket_path(run()), "another"));
  EXPECT_EQ(daemon.wait_for_exit(), 128 + SIGABRT);
  EXPECT_NE(daemon.standard_error().find("clients aren't served"), std::string::npos) << daemon.standard_error();
}

TEST_F(Hang, the_station_starts_it_anew) {
  // A station whose kiosk is a program that only stays.
  const fs::path programs = folder_.path() / "bin", home = folder_.path() / "home";
  fs::create_directories(programs);
  fs::create_directories(home / "prismesh");
  fs::copy_file(settings(), home / "prismesh/prismesh.toml");
  for (const char* name : {"prismesh-modeld", "prismesh-deviced", "prismesh"})
    fs::create_symlink(test::programs_folder() / name, programs / name);
  std::ofstream(programs / "prismesh-kiosk") << "#!/bin/sh\nexec sleep 1000\n";
  fs::permissions(programs / "prismesh-kiosk", fs::perms::owner_all);
  std::map<std::string, std::string> around = environment("sync");
  around.insert({{"PRISMESH_PROGRAMS", programs.string()},
                 {"XDG_CONFIG_HOME", home.string()},
                 {"RUNTIME_DIRECTORY", run().string()},
                 {"STATE_DIRECTORY", folder_.state().string()},
                 {"DISPLAY", ":none"}});
  Process station({(test::source_folder() / "demo/station").string()}, around);
  ipc::ReconnectingClient connection(ipc::model_socket_path(run()), "test");
  const Result<ipc::Client*> first = connection.wait(kPatience);
  ASSERT_TRUE(first) << first.error().text() << station.standard_error();
  begin(**first);
  hang_next();
  const Result<ipc::Answer> unanswered = lift(**first);
  ASSERT_FALSE(unanswered);
  connection.lost(unanswered.error());
  const Result<ipc::Client*> second = connection.wait(kPatience);
  ASSERT_TRUE(second) << second.error().text() << station.standard_error();
  // It waits for the opening, which comes first.
  EXPECT_TRUE(lift(**second));
  EXPECT_GE(journalled(**second), 2u) << "what was acknowledged, and this; the one that hung was written already, and may have come back";
  station.kill(SIGTERM);
  station.wait_for_exit();
  EXPECT_NE(station.standard_error().find("modeld died (status 134); it is started again"), std::string::npos) << station.standard_error();
}

}  // namespace
}  // namespace prismesh::modeld
