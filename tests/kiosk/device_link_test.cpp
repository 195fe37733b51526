// What the kiosk says to the device daemon, and to one that has been started again.
#include "kiosk/device_link.h"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ipc/device_messages_json.h"
#include "ipc/server.h"

namespace prismesh::kiosk {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

/// Welcomes everybody, has no device, and writes down what it is told about the mask.
class ListeningDaemon final : public ipc::ServerHandler {
 public:
  explicit ListeningDaemon(const std::filesystem::path& socket)
      : page_(ipc::DevicePage::create().value()), server_(ipc::Server::listen(socket, *this).value()) {
    thread_ = std::thread([this] { server_.run(); });
  }
  ~ListeningDaemon() override {
    server_.stop();
    thread_.join();
  }
  ListeningDaemon(const ListeningDaemon&) = delete;
  ListeningDaemon& operator=(const ListeningDaemon&) = delete;

  void connected(ipc::ClientId) override {}
  void disconnected(ipc::ClientId, const std::string&) override {}
  void line(ipc::ClientId client, std::string_view text) override {
    const auto request = ipc::decode_device_request(text);
    ASSERT_TRUE(request) << request.error().message;
    if (std::holds_alternative<ipc::DeviceHello>(request->request)) {
      std::vector<ipc::Descriptor> descriptors;
      descriptors.push_back(page_.descriptor().duplicate().value());
      server_.send(client, ipc::encode_device_answer(request->number, ipc::DeviceWelcome{ipc::kDeviceProtocolVersion, "test"}, 1),
                   std::move(descriptors));
      return;
    }
    const std::lock_guard lock(mutex_);
    if (const auto* hold = std::get_if<ipc::HoldMask>(&request->request)) told_.push_back("hold " + std::to_string(hold->position_mm));
    if (std::holds_alternative<ipc::ReleaseMask>(request->request)) told_.emplace_back("release");
    if (std::holds_alternative<ipc::Reload>(request->request)) told_.emplace_back("reload");
    server_.send(client, ipc::encode_device_answer(request->number, ipc::Devices{{}, "mono"}));
  }
  std::vector<std::string> told() {
    const std::lock_guard lock(mutex_);
    return told_;
  }

 private:
  ipc::DevicePage page_;
  std::mutex mutex_;
  std::vector<std::string> told_;
  ipc::Server server_;
  std::thread thread_;
};

class DeviceLinkTest : public testing::Test {
 protected:
  DeviceLinkTest() {
    std::string name = (std::filesystem::temp_directory_path() / "prismesh-link-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    daemon_ = std::make_unique<ListeningDaemon>(socket());
    link_ = std::make_unique<DeviceLink>(socket(), Trace(nullptr));
  }
  ~DeviceLinkTest() override {
    link_.reset();
    daemon_.reset();
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  std::filesystem::path socket() const { return folder_ / "deviced.sock"; }
  template <class Done>
  bool turn_until(const Done& done) {
    for (int tries = 0; tries < 30000 && !done(); ++tries, std::this_thread::sleep_for(1ms)) link_->turn();
    return done();
  }
  bool turn_until_told(std::size_t messages) {
    return turn_until([&] { return daemon_->told().size() >= messages; });
  }

  std::filesystem::path folder_;
  std::unique_ptr<ListeningDaemon> daemon_;
  std::unique_ptr<DeviceLink> link_;
};

TEST_F(DeviceLinkTest, holds_and_releases_once_however_often_it_is_asked) {
  ASSERT_TRUE(turn_until([&] { return link_->connected(); }));
  link_->release_mask();  // nothing is held
  for (int i = 0; i < 5; ++i) link_->hold_mask(0.25);
  link_->hold_mask(0.5);
  for (int i = 0; i < 5; ++i) link_->release_mask();
  link_->reload();
  ASSERT_TRUE(turn_until_told(4));
  EXPECT_THAT(daemon_->told(), ElementsAre("hold 0.250000", "hold 0.500000", "release", "reload"));
}

TEST_F(DeviceLinkTest, a_daemon_that_is_started_again_holds_the_mask_too) {
  ASSERT_TRUE(turn_until([&] { return link_->connected(); }));
  link_->hold_mask(0.25);
  ASSERT_TRUE(turn_until_told(1));
  daemon_.reset();
  ASSERT_TRUE(turn_until([&] { return !link_->connected(); }));
  daemon_ = std::make_unique<ListeningDaemon>(socket());
  ASSERT_TRUE(turn_until_told(1));
  EXPECT_THAT(daemon_->told(), ElementsAre("hold 0.250000"));
}

TEST_F(DeviceLinkTest, a_mask_that_was_let_go_meanwhile_is_not_held_again) {
  ASSERT_TRUE(turn_until([&] { return link_->connected(); }));
  link_->hold_mask(0.25);
  ASSERT_TRUE(turn_until_told(1));
  daemon_.reset();
  ASSERT_TRUE(turn_until([&] { return !link_->connected(); }));
  link_->release_mask();
  daemon_ = std::make_unique<ListeningDaemon>(socket());
  ASSERT_TRUE(turn_until([&] { return link_->connected(); }));
  link_->reload();
  ASSERT_TRUE(turn_until_told(1));
  EXPECT_THAT(daemon_->told(), ElementsAre("reload"));
}

}  // namespace
}  // namespace prismesh::kiosk
