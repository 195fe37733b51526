// A daemon's local socket: decides who may connect, receives lines, sends lines and descriptors, and runs the loop that the daemon's own
// work is posted to. Only `post` and `stop` may be called from other threads than the loop's.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "ipc/wire/descriptor.h"
#include "ipc/wire/roles.h"

namespace prismesh::ipc {

struct ServerLimits {
  std::size_t line_bytes = std::size_t{8} << 20;    ///< max length of a line; the sender of a longer one is disconnected
  std::size_t queue_bytes = std::size_t{32} << 20;  ///< max bytes that wait for a client; with more it is disconnected
  std::size_t descriptors = 0;                      ///< max. number from a client that no request has taken; 0: none are accepted
  std::size_t clients = 32;
  std::chrono::milliseconds stall{10'000};     ///< a client that reads nothing for so long is disconnected
  std::chrono::milliseconds greeting{10'000};  ///< a client that doesn't greet for so long is disconnected
};

using ClientId = std::uint64_t;

/// The daemon's callbacks.
class ServerHandler {
 public:
  virtual ~ServerHandler() = default;
  virtual void connected(ClientId client) = 0;
  virtual void line(ClientId client, std::string_view line) = 0;
  virtual void disconnected(ClientId client, const std::string& why) = 0;
};

class Server {
 public:
  /// Makes the folder if it is missing, takes its lock, replaces a stale socket. Users without a role can't connect; if others than the own
  /// user and root have one, they may enter the folder (0711), else not (0700). Errors: another daemon holds the folder (its process
  /// named), the folder belongs to somebody else or others may write to it, the path is too long for a socket.
  static Result<Server> listen(const std::filesystem::path& socket, ServerHandler& handler, const ServerLimits& limits = {},
                               const RoleTable& roles = {});
  /// Serves a socket that another process made and listens at; it stays there when the server ends. Errors: it can't be served.
  static Result<Server> serve(Descriptor listening, const std::filesystem::path& socket, ServerHandler& handler,
                              const ServerLimits& limits = {}, const RoleTable& roles = {});
  Server(Server&&) noexcept;
  Server& operator=(Server&&) noexcept;
  ~Server();

  /// Serves until `stop`, SIGTERM, SIGINT or a terminal's SIGHUP. At the end sends queued lines to clients that accept them at once.
  void run();
  void stop();
  /// Runs `work` in the loop. May be called from any thread.
  void post(std::function<void()> work);
  /// Calls `work` in the loop every `period`.
  void every(std::chrono::nanoseconds period, std::function<void()> work);

  void send(ClientId client, std::string line, std::vector<Descriptor> descriptors = {});
  /// The next descriptors that the client has sent. Errors: fewer have arrived.
  Result<std::vector<Descriptor>> take_descriptors(ClientId client, std::size_t count);
  /// Of the client's user, when it connected.
  Roles roles(ClientId client) const;
  /// Tells the server that the daemon has welcomed the client.
  void welcome(ClientId client);
  /// A sentence why the client can't be welcomed: too many are connected. Empty if it can.
  std::optional<std::string> refusal(ClientId client) const;
  /// Sends as much of the queue as possible and closes the connection; `disconnected` is called.
  void cut(ClientId client, const std::string& why);

 private:
  struct Impl;
  static Result<Server> start(Descriptor listening, Descriptor lock, const std::filesystem::path& socket, ServerHandler& handler,
                              const ServerLimits& limits, const RoleTable& roles);
  explicit Server(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// A sentence why a client with another protocol version is refused; empty if it has ours.
std::optional<std::string> protocol_refusal(int ours, int theirs, const std::string& program);

/// Takes an exclusive lock on a folder, which ends with the process. Errors: another process holds it (named).
Result<Descriptor> lock_folder(const std::filesystem::path& folder, const std::string& file, const std::string& whose);
/// Makes a folder, if it is missing, that no other user may change. `others_enter`: they may reach what they know the name of; else not.
/// Errors: an existing one that others may change.
Result<void> make_private_folder(const std::filesystem::path& folder, bool others_enter = false);

}  // namespace prismesh::ipc
