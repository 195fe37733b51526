// A client of modeld: one connection for requests, answers and events. Never blocks longer than the caller allows.
#pragma once

#include <chrono>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "ipc/model/field_page.h"
#include "ipc/model/messages.h"
#include "ipc/model/preview.h"
#include "ipc/model/snapshot.h"
#include "ipc/model/state_page.h"
#include "ipc/wire/reconnecting.h"
#include "ipc/wire/runtime_directory.h"

namespace prismesh::ipc {

/// modeld's socket in the runtime folder.
std::filesystem::path model_socket_path(const std::optional<std::filesystem::path>& override = {});

class Client {
 public:
  /// Connects and exchanges hellos. Errors: nobody listens (names the socket and says how to start), other protocol version.
  static Result<Client> connect(const std::filesystem::path& socket, const std::string& program);
  /// Connects and sends the hello without waiting for the welcome, for loops that mustn't block. Until `greeted` returns true, call nothing
  /// else.
  static Result<Client> begin(const std::filesystem::path& socket, const std::string& program);
  /// Whether the welcome has arrived; waits for it at most `patience`. Errors as of `connect`.
  Result<bool> greeted(std::chrono::milliseconds patience = std::chrono::milliseconds(0));
  Client(Client&&) noexcept;
  Client& operator=(Client&&) noexcept;
  ~Client();

  /// Sends without waiting; returns the request's number. Fails when the daemon is gone.
  Result<std::uint64_t> send(const Request& request);
  /// Sends and waits for the answer; events that arrive meanwhile are kept for `next_event`. A Failed answer is an Error.
  Result<Answer> call(const Request& request, std::chrono::milliseconds patience = std::chrono::minutes(10));

  struct Reply {
    std::uint64_t request = 0;
    Answer answer;
  };
  /// Reads what has arrived, at most `patience` waiting for the first byte. Errors: the daemon is gone.
  Result<void> poll(std::chrono::milliseconds patience = std::chrono::milliseconds(0));
  std::optional<Event> next_event();
  std::optional<Reply> next_reply();  ///< answers to `send`

  /// The current generation; segments shared with earlier snapshots stay mapped. The view's destructor returns the lease.
  Result<std::shared_ptr<const SnapshotView>> snapshot();
  /// The segments to list in GetSnapshot::have_segments when it is sent with `send`.
  std::vector<std::uint64_t> segments() const;
  /// The snapshot that came with a Snapshot answer to `send`.
  Result<std::shared_ptr<const SnapshotView>> take_snapshot(const Snapshot& answer);
  /// The values that came with a FieldMade answer.
  Result<std::shared_ptr<const FieldValues>> take_field(const FieldMade& made);
  /// The preview that came with a DragBegun answer.
  Result<PreviewReader> take_preview(const DragBegun& begun);

  /// Hands the state page of the pen's process over without waiting for the answer; returns the request's number. Wait for its answer
  /// before the next one: the daemon takes one at a time. Fails when the daemon is gone.
  Result<std::uint64_t> send_follow_pen(const FollowPen& request, const Descriptor& pen);
  /// The page with the fields that came with the newest PenFollowed answer.
  Result<Descriptor> take_pen_field();
  /// Hands the state page of the pen's process over and waits for the page with the fields, which that process attaches. Errors: as of
  /// `call`.
  Result<Descriptor> follow_pen(const FollowPen& request, const Descriptor& pen,
                                std::chrono::milliseconds patience = std::chrono::seconds(10));

  const Welcome& welcome() const;
  /// modeld's health, read from its state page without a request; empty before its first heartbeat.
  std::optional<Health> health() const;

  int descriptor() const;  ///< for poll(2)

 private:
  struct Impl;
  explicit Client(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

using ReconnectingClient = Reconnecting<Client>;

}  // namespace prismesh::ipc
