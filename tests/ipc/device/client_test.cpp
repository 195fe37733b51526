// A client of deviced against a correct daemon, one that hangs, and one that sends false data.
#include <stdlib.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "ipc/device/client.h"
#include "ipc/device/messages_json.h"
#include "ipc/wire/server.h"

namespace prismesh::ipc {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// Answers each hello as the test wants.
class FakeDeviced final : public ServerHandler {
 public:
  using Greeting = std::function<void(FakeDeviced&, ClientId, std::uint64_t number)>;
  FakeDeviced(const fs::path& socket, Greeting greeting)
      : greeting_(std::move(greeting)), server_(Server::listen(socket, *this).value()), thread_([this] { server_.run(); }) {}
  ~FakeDeviced() override {
    server_.stop();
    thread_.join();
  }
  void connected(ClientId) override {}
  void line(ClientId client, std::string_view line) override {
    const auto request = decode_device_request(line);
    if (!request) return;
    if (std::holds_alternative<DeviceHello>(request->request)) return greeting_(*this, client, request->number);
    DeviceInfo tracker;
    tracker.role = "eye tracker";
    // An event goes before each answer.
    server_.send(client, encode_device_event(DeviceChanged{tracker}));
    server_.send(client, encode_device_answer(request->number, std::holds_alternative<GetDevices>(request->request)
                                                                   ? DeviceAnswer(Devices{{}, "mono"})
                                                                   : DeviceAnswer(Failed{"", 0, "no servo"})));
  }
  void disconnected(ClientId, const std::string&) override {}
  void welcome(ClientId client, std::uint64_t number, Result<Descriptor> page) {
    std::vector<Descriptor> descriptors;
    if (page) descriptors.push_back(std::move(*page));
    const std::size_t count = descriptors.size();
    server_.send(client, encode_device_answer(number, DeviceWelcome{kDeviceProtocolVersion, "1"}, count), std::move(descriptors));
  }
  void refuse(ClientId client, std::uint64_t number, const std::string& why) {
    server_.send(client, encode_device_answer(number, Failed{"", 0, why}));
  }

 private:
  Greeting greeting_;
  Server server_;
  std::thread thread_;
};

class DeviceClients : public ::testing::Test {
 protected:
  DeviceClients() {
    std::string name = (fs::temp_directory_path() / "prismesh-devices-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~DeviceClients() override {
    std::error_code problem;
    fs::remove_all(folder_, problem);
  }
  fs::path socket() const { return device_socket_path(folder_); }
  fs::path folder_;
};

TEST_F(DeviceClients, gets_the_page_answers_and_events) {
  DevicePage page = DevicePage::create().value();
  EyesState eyes;
  eyes.records = 42;
  page.set_eyes(eyes);
  FakeDeviced daemon(socket(), [&](FakeDeviced& self, ClientId client, std::uint64_t number) {
    self.welcome(client, number, page.descriptor().duplicate());
  });
  DeviceClient client = DeviceClient::connect(socket(), "test").value();
  EXPECT_EQ(client.welcome().version, "1");
  EXPECT_EQ(client.page().eyes()->records, 42u);
  const Result<DeviceAnswer> answer = client.call(GetDevices{});
  ASSERT_TRUE(answer) << answer.error().text();
  EXPECT_EQ(std::get<Devices>(*answer).profile, "mono");
  const auto event = client.next_event();
  ASSERT_TRUE(event);
  EXPECT_EQ(std::get<DeviceChanged>(*event).device.role, "eye tracker");
  EXPECT_EQ(client.call(HoldMask{1}).error().message, "no servo");
  const std::uint64_t number = client.send(GetDevices{}).value();
  std::optional<DeviceClient::Reply> reply;
  while (!reply) {
    ASSERT_TRUE(client.poll(100ms));
    reply = client.next_reply();
  }
  EXPECT_EQ(reply->request, number);
}

TEST_F(DeviceClients, a_daemon_that_is_not_there_is_said_with_what_to_do) {
  const Result<DeviceClient> client = DeviceClient::connect(socket(), "test");
  ASSERT_FALSE(client);
  EXPECT_EQ(client.error().file, socket().string());
  EXPECT_NE(client.error().message.find("prismesh-deviced"), std::string::npos);
}

TEST_F(DeviceClients, one_that_hangs_holds_nobody_up) {
  std::atomic<bool> hangs{true};
  DevicePage page = DevicePage::create().value();
  FakeDeviced daemon(socket(), [&](FakeDeviced& self, ClientId client, std::uint64_t number) {
    if (!hangs) self.welcome(client, number, page.descriptor().duplicate());
  });
  ReconnectingDeviceClient connection(socket(), "test");
  // If each waited for the greeting, ten seconds, the test would be ended from outside.
  for (int turn = 0; turn < 100; ++turn) EXPECT_EQ(connection.client(), nullptr);
  EXPECT_NE(connection.trouble().message.find("hasn't answered the greeting"), std::string::npos) << connection.trouble().message;
  hangs = false;
  connection.lost(Error{"", 0, "given up"});
  EXPECT_TRUE(connection.wait(20s));
  EXPECT_EQ(connection.connections(), 1u);
}

TEST_F(DeviceClients, a_false_page_is_refused) {
  const auto refused = [&](FakeDeviced::Greeting greeting) {
    FakeDeviced daemon(socket(), std::move(greeting));
    const Result<DeviceClient> client = DeviceClient::connect(socket(), "test");
    return client ? "accepted" : client.error().text();
  };
  EXPECT_NE(refused([](FakeDeviced& self, ClientId client, std::uint64_t number) {
              self.welcome(client, number, make_shared_memory("small", 64));
            }).find("F_SEAL_FUTURE_WRITE is missing"),
            std::string::npos);
  EXPECT_NE(refused([](FakeDeviced& self, ClientId client, std::uint64_t number) {
              self.welcome(client, number, make_sealed_memory("other", std::vector<std::byte>(sizeof(DevicePageLayout))));
            }).find("it is none"),
            std::string::npos);
  EXPECT_NE(refused([](FakeDeviced& self, ClientId client, std::uint64_t number) {
              self.welcome(client, number, fail("", "none"));
            }).find("the state page is missing"),
            std::string::npos);
  EXPECT_NE(
      refused([](FakeDeviced& self, ClientId client, std::uint64_t number) { self.refuse(client, number, "too old"); }).find("too old"),
      std::string::npos);
}

}  // namespace
}  // namespace prismesh::ipc
