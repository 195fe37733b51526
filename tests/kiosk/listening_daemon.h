// A device daemon that only listens, at a real socket, and a link to it: for tests of what the kiosk says.
#pragma once

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "ipc/device/messages_json.h"
#include "ipc/device/page.h"
#include "ipc/wire/server.h"
#include "kiosk/device_link.h"

namespace prismesh::kiosk {

/// Welcomes every client, reports the given devices, and writes down what it is told about mask and picture.
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
    if (std::holds_alternative<ipc::Rearm>(request->request)) told_.emplace_back("rearm");
    if (const auto* hold = std::get_if<ipc::HoldMask>(&request->request)) told_.push_back("hold " + std::to_string(hold->position_mm));
    if (std::holds_alternative<ipc::ReleaseMask>(request->request)) told_.emplace_back("release");
    if (std::holds_alternative<ipc::Reload>(request->request)) told_.emplace_back("reload");
    if (const auto* shown = std::get_if<ipc::PictureShown>(&request->request)) {
      told_.emplace_back(shown->mono ? "shows mono" : "shows depth");
      return;  // what has no answer
    }
    if (!refusal_.empty() && std::holds_alternative<ipc::HoldMask>(request->request))
      server_.send(client, ipc::encode_device_answer(request->number, ipc::Failed{"", 0, refusal_}));
    else
      server_.send(client, ipc::encode_device_answer(request->number, ipc::Devices{devices_, "mono"}));
    if (!std::holds_alternative<ipc::Reload>(request->request)) return;
    for (const ipc::DeviceInfo& device : std::exchange(changed_, {}))
      server_.send(client, ipc::encode_device_event(ipc::DeviceChanged{device}));
  }
  /// Sets its answers from now on.
  void have(std::vector<ipc::DeviceInfo> devices) {
    const std::lock_guard lock(mutex_);
    devices_ = std::move(devices);
  }
  /// Says so when it has been told to reload, after the answer.
  void change(ipc::DeviceInfo device) {
    const std::lock_guard lock(mutex_);
    changed_.push_back(std::move(device));
  }
  void refuse_holding(std::string why) {
    const std::lock_guard lock(mutex_);
    refusal_ = std::move(why);
  }
  /// What its clients read.
  ipc::DevicePage& page() { return page_; }
  std::vector<std::string> told() {
    const std::lock_guard lock(mutex_);
    return told_;
  }

 private:
  ipc::DevicePage page_;
  std::mutex mutex_;
  std::vector<std::string> told_;
  std::vector<ipc::DeviceInfo> devices_, changed_;
  std::string refusal_;
  ipc::Server server_;
  std::thread thread_;
};

/// A daemon, and a link that isn't connected yet.
class ListeningDaemonTest : public testing::Test {
 protected:
  ListeningDaemonTest() {
    std::string name = (std::filesystem::temp_directory_path() / "prismesh-link-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    start_daemon();
    link_ = std::make_unique<DeviceLink>(socket(), notices::Trace(nullptr));
  }
  ~ListeningDaemonTest() override {
    link_.reset();
    daemon_.reset();
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  std::filesystem::path socket() const { return folder_ / "deviced.sock"; }
  void start_daemon() { daemon_ = std::make_unique<ListeningDaemon>(socket()); }
  /// It ends, and the link has noticed.
  void stop_daemon() {
    daemon_.reset();
    ASSERT_TRUE(turn_until([&] { return !link_->connected(); }));
  }
  void start_daemon_again() {
    stop_daemon();
    start_daemon();
  }
  template <class Done>
  bool turn_until(const Done& done) {
    for (int tries = 0; tries < 30000 && !done(); ++tries, std::this_thread::sleep_for(std::chrono::milliseconds(1))) link_->turn();
    return done();
  }
  bool turn_until_told(std::size_t messages) {
    return turn_until([&] { return daemon_->told().size() >= messages; });
  }

  std::filesystem::path folder_;
  std::unique_ptr<ListeningDaemon> daemon_;
  std::unique_ptr<DeviceLink> link_;
};

}  // namespace prismesh::kiosk
