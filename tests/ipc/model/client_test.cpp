#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <thread>

#include <gtest/gtest.h>

#include "ipc/model/client.h"
#include "ipc/wire/server.h"

namespace prismesh::ipc {
namespace {

namespace fs = std::filesystem;

class ClientTest : public ::testing::Test {
 protected:
  ClientTest() {
    std::string name = (fs::temp_directory_path() / "prismesh-ipc-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~ClientTest() override {
    std::error_code problem;
    fs::remove_all(folder_, problem);
  }
  fs::path socket() const { return model_socket_path(folder_); }

  fs::path folder_;
};

TEST_F(ClientTest, finds_the_socket_in_the_runtime_folder) { EXPECT_EQ(model_socket_path("/named"), "/named/model.sock"); }

TEST_F(ClientTest, says_that_no_daemon_is_there) {
  const Result<Client> client = Client::connect(socket(), "test");
  ASSERT_FALSE(client);
  EXPECT_EQ(client.error().file, socket().string());
  EXPECT_NE(client.error().message.find("nobody listens there"), std::string::npos);
  ReconnectingClient again(socket(), "test");
  EXPECT_EQ(again.client(), nullptr);
  EXPECT_FALSE(again.wait(std::chrono::milliseconds(150)));
}

/// A server that returns each line.
struct Echo final : ServerHandler {
  Server* server = nullptr;
  void connected(ClientId) override {}
  void line(ClientId client, std::string_view line) override { server->send(client, std::string(line)); }
  void disconnected(ClientId, const std::string&) override {}
};

TEST_F(ClientTest, says_that_what_listens_is_no_daemon) {
  Echo echo;
  Result<Server> server = Server::listen(socket(), echo);
  ASSERT_TRUE(server) << server.error().text();
  echo.server = &*server;
  std::jthread running([&] { server->run(); });
  const Result<Client> client = Client::connect(socket(), "test");
  EXPECT_FALSE(client) << "an echo isn't a welcome";
  server->stop();
}

}  // namespace
}  // namespace prismesh::ipc
