// The connection to the model server: connects again when it is lost, and asks without waiting.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "base/clock.h"
#include "ipc/model/client.h"
#include "kiosk/link/link_notices.h"
#include "kiosk/link/server_progress.h"
#include "kiosk/notices/trace.h"

namespace prismesh::kiosk::link {

/// Told what happens on the connection.
class ConnectionListener {
 public:
  virtual ~ConnectionListener() = default;
  virtual void connected() {}
  virtual void heard(const ipc::Event& /*event*/) {}
  /// What was asked gets no answer.
  virtual void lost() {}
};

using Then = std::function<void(const ipc::Answer&)>;

class Connection {
 public:
  Connection(std::filesystem::path socket, Clock& clock, notices::Trace trace, LinkNotices& notices);
  /// Listeners are told in the order in which they were added.
  void add(ConnectionListener& listener) { listeners_.push_back(&listener); }

  /// Connects when it is time to, and reads what has arrived.
  void turn();
  const std::filesystem::path& socket() const { return socket_; }
  bool connected() const { return client_.has_value(); }
  /// For poll(2); negative while there is no connection.
  int descriptor() const { return client_ ? client_->descriptor() : -1; }
  /// How long until the next attempt to connect, ms; negative: there is a connection.
  int patience_ms() const;
  /// Counts up with each connection: questions asked on an older one get no answer.
  std::uint64_t number() const { return number_; }
  /// Counts up with each message, connection and loss.
  std::uint64_t changes() const { return changes_; }

  /// From now on requests that the guard refuses are answered here, and not sent.
  void set_guard(std::function<bool(const ipc::Request&)> guard) { guard_ = std::move(guard); }
  /// Sends a request. `then` gets the answer; never, if the connection ends before. Without a connection the user is told.
  void ask(const ipc::Request& request, Then then);
  /// Sends a request that changes nothing: without a connection there is nothing to tell.
  void question(const ipc::Request& request, Then then);
  /// Sends what has no answer or whose answer doesn't matter, if there is a connection.
  void tell(const ipc::Request& request);

  /// Asks to follow a pen, if there is a connection; `pen`: its state page. Wait for the answer before the next one. `then` as of `ask`.
  void follow_pen(const ipc::FollowPen& request, const ipc::Descriptor& pen, Then then);

  // Take what came with an answer.
  Result<ipc::Descriptor> take(const ipc::PenFollowed&) { return client_->take_pen_field(); }
  Result<std::shared_ptr<const ipc::FieldValues>> take(const ipc::FieldMade& made) { return client_->take_field(made); }
  Result<std::shared_ptr<const ipc::SnapshotView>> take(const ipc::Snapshot& snapshot) { return client_->take_snapshot(snapshot); }
  Result<ipc::PreviewReader> take(const ipc::DragBegun& begun) { return client_->take_preview(begun); }
  /// For GetSnapshot: the segments that are here already.
  std::vector<std::uint64_t> segments() const { return client_ ? client_->segments() : std::vector<std::uint64_t>(); }

  ServerProgress& progress() { return progress_; }
  const ServerProgress& progress() const { return progress_; }
  /// Asks the server to stop a request that can be stopped: it has no effect then. With `keep`, a repair keeps what it has reached.
  void stop(bool keep = false);

 private:
  struct Waiting {
    Then then;
    bool can_stop = false;
  };
  void try_connect();
  void read();
  void lost(const Error& error);

  std::filesystem::path socket_;
  std::function<bool(const ipc::Request&)> guard_;
  Clock& clock_;
  notices::Trace trace_;
  LinkNotices& notices_;
  std::vector<ConnectionListener*> listeners_;
  std::optional<ipc::Client> client_;
  std::map<std::uint64_t, Waiting> waiting_;
  ServerProgress progress_;
  std::int64_t next_attempt_ns_ = 0;
  std::int64_t back_off_ns_ = 0;
  std::uint64_t number_ = 0;
  std::uint64_t changes_ = 0;
};

}  // namespace prismesh::kiosk::link
