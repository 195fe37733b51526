// A daemon's side of its local socket: who may connect, lines in, lines and descriptors out, and the loop that the daemon's
// own work is posted to. All calls but `post` and `stop` belong to the thread that runs the loop.
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
#include "ipc/descriptor.h"

namespace prismesh::ipc {

struct ServerLimits {
  std::size_t line_bytes = std::size_t{8} << 20;    ///< a longer line cuts its sender off
  std::size_t queue_bytes = std::size_t{32} << 20;  ///< more waiting for a client cuts it off
  std::size_t clients = 32;
  std::chrono::milliseconds stall{10'000};     ///< a client that takes nothing for so long is cut off
  std::chrono::milliseconds greeting{10'000};  ///< so is one that hasn't greeted for so long
};

using ClientId = std::uint64_t;

/// What a server tells its daemon.
class ServerHandler {
 public:
  virtual ~ServerHandler() = default;
  virtual void connected(ClientId client) = 0;
  virtual void line(ClientId client, std::string_view line) = 0;
  virtual void disconnected(ClientId client, const std::string& why) = 0;
};

class Server {
 public:
  /// Makes the folder if need be (0700), takes its lock, replaces a stale socket. Errors: another daemon holds the folder (its
  /// process named), the folder belongs to somebody else or others may write to it, the path is too long for a socket.
  static Result<Server> listen(const std::filesystem::path& socket, ServerHandler& handler, const ServerLimits& limits = {});
  Server(Server&&) noexcept;
  Server& operator=(Server&&) noexcept;
  ~Server();

  /// Serves until `stop`, or until SIGTERM, SIGINT or a terminal's SIGHUP. What was queued for clients is sent where they take it at once.
  void run();
  void stop();
  /// Runs `work` in the loop, soon. From any thread.
  void post(std::function<void()> work);
  /// Calls `work` in the loop again and again.
  void every(std::chrono::nanoseconds period, std::function<void()> work);

  void send(ClientId client, std::string line, std::vector<Descriptor> descriptors = {});
  /// The daemon has welcomed the client.
  void welcome(ClientId client);
  /// Why the client can't be welcomed, in a sentence: as many as there may be are connected. Nothing if it can.
  std::optional<std::string> refusal(ClientId client) const;
  /// Closes the connection after what is queued was sent as far as possible; `disconnected` is called.
  void cut(ClientId client, const std::string& why);

 private:
  struct State;
  explicit Server(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Why a client that speaks another protocol is sent away, in a sentence; nothing if it speaks ours.
std::optional<std::string> protocol_refusal(int ours, int theirs, const std::string& program);

/// An exclusive lock on a folder, for the process's life; it can't outlive the process. Errors: another process holds it (named).
Result<Descriptor> lock_folder(const std::filesystem::path& folder, const std::string& file, const std::string& whose);
/// A folder of our own that nobody else may enter or change: made if need be.
Result<void> make_private_folder(const std::filesystem::path& folder);

}  // namespace prismesh::ipc
