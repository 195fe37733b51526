// A client of deviced: one connection, its state page, requests with answers, events in between. Never blocks longer than the
// caller allows; looking at the page costs no call at all.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "ipc/device_messages.h"
#include "ipc/device_page.h"

namespace prismesh::ipc {

/// deviced's socket in the runtime folder (`runtime_directory` in ipc/client.h).
std::filesystem::path device_socket_path(const std::optional<std::filesystem::path>& override = {});

class DeviceClient {
 public:
  /// Connects and exchanges hellos. Errors: nobody listens (names the socket and says how to start), other protocol version.
  static Result<DeviceClient> connect(const std::filesystem::path& socket, const std::string& program);
  /// Connects and sends the hello without waiting for the welcome, for loops that mustn't stand still. Until `greeted` is true nothing
  /// else may be called.
  static Result<DeviceClient> begin(const std::filesystem::path& socket, const std::string& program);
  /// Whether the welcome has come, waiting for it at most `patience`. Errors as of `connect`.
  Result<bool> greeted(std::chrono::milliseconds patience = std::chrono::milliseconds(0));
  DeviceClient(DeviceClient&&) noexcept;
  DeviceClient& operator=(DeviceClient&&) noexcept;
  ~DeviceClient();

  /// Sends without waiting; returns the request's number. Fails when the daemon is gone.
  Result<std::uint64_t> send(const DeviceRequest& request);
  /// Sends and waits for the answer; events that come meanwhile are kept for `next_event`. A Failed answer is an Error.
  Result<DeviceAnswer> call(const DeviceRequest& request, std::chrono::milliseconds patience = std::chrono::seconds(10));

  struct Reply {
    std::uint64_t request = 0;
    DeviceAnswer answer;
  };
  /// Reads what has arrived, at most `patience` waiting for the first byte. Errors: the daemon is gone.
  Result<void> poll(std::chrono::milliseconds patience = std::chrono::milliseconds(0));
  std::optional<DeviceEvent> next_event();
  std::optional<Reply> next_reply();  ///< answers to `send`

  const DeviceWelcome& welcome() const;
  /// The state page of this life of the daemon. It stays as it was when the daemon dies: look at its times.
  const DevicePageReader& page() const;

  int descriptor() const;  ///< for poll(2)

 private:
  struct State;
  explicit DeviceClient(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace prismesh::ipc
