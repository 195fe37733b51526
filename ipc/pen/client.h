// A client of the process that drives the pen: one connection for requests, answers and events, and the daemon's state page. Never blocks
// longer than the caller allows; reading the page needs no system call.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "ipc/pen/messages.h"
#include "ipc/pen/page.h"
#include "ipc/wire/descriptor.h"
#include "ipc/wire/reconnecting.h"
#include "ipc/wire/runtime_directory.h"

namespace prismesh::ipc {

/// the pen socket in the runtime folder.
std::filesystem::path pen_socket_path(const std::optional<std::filesystem::path>& override = {});

class PenClient {
 public:
  /// Connects and exchanges hellos. Errors: nobody listens (names the socket and says how to start), other protocol version.
  static Result<PenClient> connect(const std::filesystem::path& socket, const std::string& program);
  /// Connects and sends the hello without waiting for the welcome, for loops that mustn't block. Until `greeted` returns true, call nothing
  /// else.
  static Result<PenClient> begin(const std::filesystem::path& socket, const std::string& program);
  /// Whether the welcome has arrived; waits for it at most `patience`. Errors as of `connect`.
  Result<bool> greeted(std::chrono::milliseconds patience = std::chrono::milliseconds(0));
  PenClient(PenClient&&) noexcept;
  PenClient& operator=(PenClient&&) noexcept;
  ~PenClient();

  /// Sends without waiting; returns the request's number. Fails when the daemon is gone.
  Result<std::uint64_t> send(const PenRequest& request);
  /// Hands a field's page over without waiting for the answer; returns the request's number. Fails when the daemon is gone.
  Result<std::uint64_t> send_field(const Descriptor& page);
  /// Hands a field's page over and waits for the answer. Errors: as of `call`.
  Result<PenAnswer> attach_field(const Descriptor& page, std::chrono::milliseconds patience = std::chrono::seconds(10));
  /// Sends and waits for the answer; events that arrive meanwhile are kept for `next_event`. A Failed answer is an Error.
  Result<PenAnswer> call(const PenRequest& request, std::chrono::milliseconds patience = std::chrono::seconds(10));

  struct Reply {
    std::uint64_t request = 0;
    PenAnswer answer;
  };
  /// Reads what has arrived, at most `patience` waiting for the first byte. Errors: the daemon is gone.
  Result<void> poll(std::chrono::milliseconds patience = std::chrono::milliseconds(0));
  std::optional<PenEvent> next_event();
  std::optional<Reply> next_reply();  ///< answers to `send`

  const PenWelcome& welcome() const;
  /// The state page of the daemon's process. It keeps its content when the daemon dies: check its times.
  const PenPageReader& page() const;
  /// Of that page, for modeld (FollowPen).
  const Descriptor& page_descriptor() const;

  int descriptor() const;  ///< for poll(2)

 private:
  struct Impl;
  explicit PenClient(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

using ReconnectingPenClient = Reconnecting<PenClient>;

}  // namespace prismesh::ipc
