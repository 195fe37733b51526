// A connection that comes back: a daemon may be restarted at any time, and whoever was connected goes on.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "ipc/client.h"
#include "ipc/device_client.h"

namespace prismesh::ipc {

/// For programs with a loop of their own: ask for the client in each turn, say when a call of it failed.
template <class AnyClient>
class Reconnecting {
 public:
  Reconnecting(std::filesystem::path socket, std::string program) : socket_(std::move(socket)), program_(std::move(program)) {}

  /// The connected client, or null; never waits. Tries to connect at most every so often: at once after a loss, then after 50 ms, twice
  /// that, up to a second. A client that is new to the caller (`connections` has changed) knows no snapshots, drags or pages of the old.
  AnyClient* client();
  /// As `client`, trying again for up to `patience`. Errors: why the last try failed.
  Result<AnyClient*> wait(std::chrono::milliseconds patience);
  /// A call failed because the daemon is gone: the connection is given up.
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
