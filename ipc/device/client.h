// A client of deviced: one connection for requests, answers and events, and the daemon's state page. Never blocks longer than the caller
// allows; reading the page needs no system call.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "ipc/device/messages.h"
#include "ipc/device/page.h"
#include "ipc/wire/reconnecting.h"
#include "ipc/wire/runtime_directory.h"

namespace prismesh::ipc {

/// deviced's socket in the runtime folder.
std::filesystem::path device_socket_path(const std::optional<std::filesystem::path>& override = {});

class DeviceClient {
 public:
  /// Connects and exchanges hellos. Errors: nobody listens (names the socket and says how to start), other protocol version.
  static Result<DeviceClient> connect(const std::filesystem::path& socket, const std::string& program);
  /// Connects and sends the hello without waiting for the welcome, for loops that mustn't block. Until `greeted` returns true, call nothing
  /// else.
  static Result<DeviceClient> begin(const std::filesystem::path& socket, const std::string& program);
  /// Whether the welcome has arrived; waits for it at most `patience`. Errors as of `connect`.
  Result<bool> greeted(std::chrono::milliseconds patience = std::chrono::milliseconds(0));
  DeviceClient(DeviceClient&&) noexcept;
  DeviceClient& operator=(DeviceClient&&) noexcept;
  ~DeviceClient();

  /// Sends without waiting; returns the request's number. Fails when the daemon is gone.
  Result<std::uint64_t> send(const DeviceRequest& request);
  /// Sends and waits for the answer; events that arrive meanwhile are kept for `next_event`. A Failed answer is an Error.
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
  /// The state page of the daemon's process. It keeps its content when the daemon dies: check its times.
  const DevicePageReader& page() const;

  int descriptor() const;  ///< for poll(2)

 private:
  struct Impl;
  explicit DeviceClient(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

using ReconnectingDeviceClient = Reconnecting<DeviceClient>;

}  // namespace prismesh::ipc
