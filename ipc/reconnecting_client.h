// A connection that is restored when a daemon restarts.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "ipc/client.h"
#include "ipc/device_client.h"

namespace prismesh::ipc {

/// For programs with a loop of their own: get the client in each turn, and report when a call of it fails.
template <class AnyClient>
class Reconnecting {
 public:
  Reconnecting(std::filesystem::path socket, std::string program) : socket_(std::move(socket)), program_(std::move(program)) {}

  /// The connected client, or null; never waits. Tries to connect at once after a loss, then after 50 ms, 100 ms and so on, up to a second.
  /// A new client (`connections` has changed) knows no snapshots, drags or pages of the old one.
  AnyClient* client();
  /// As `client`, trying again for up to `patience`. Errors: why the last try failed.
  Result<AnyClient*> wait(std::chrono::milliseconds patience);
  /// Closes the connection, after a call failed because the daemon is gone.
  void lost(const Error& why);

  std::size_t connections() const { return connections_; }
  /// Why there is no client.
  const Error& trouble() const { return trouble_; }

 private:
  void try_again_later(Error why);

  std::filesystem::path socket_;
  std::string program_;
  std::optional<AnyClient> client_;
  bool greeted_ = false;
  std::chrono::steady_clock::time_point begun_{};
  std::size_t connections_ = 0;
  Error trouble_{"", 0, "not connected yet"};
  std::chrono::steady_clock::time_point next_try_{};
  std::chrono::milliseconds pause_{0};
};

extern template class Reconnecting<Client>;
extern template class Reconnecting<DeviceClient>;
using ReconnectingClient = Reconnecting<Client>;
using ReconnectingDeviceClient = Reconnecting<DeviceClient>;

}  // namespace prismesh::ipc
