// The document that the model server has open, as far as it has told: its state, its deck's warnings and its newest generation.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kiosk/link/connection.h"
#include "kiosk/notices/deck_warnings.h"

namespace prismesh::kiosk::link {

class FollowedDocument final : public ConnectionListener {
 public:
  FollowedDocument(Connection& connection, DocumentNumber& number, LinkNotices& notices, notices::Trace trace);

  const std::optional<ipc::DocumentState>& state() const { return state_; }
  /// Of the deck that is open, the worst first.
  const std::vector<notices::ToldWarning>& warnings() const { return warnings_; }
  /// The current generation; null while no document is open. Stays while the server is away.
  const std::shared_ptr<const ipc::SnapshotView>& snapshot() const { return snapshot_; }
  /// Of the document that is shown; empty: none is.
  std::string length_unit() const { return snapshot_ ? snapshot_->info().length_unit : std::string(); }
  /// Counts up each time that another document is opened.
  std::uint64_t number() const { return number_.value(); }
  /// No newer generation is known or requested.
  bool up_to_date() const { return !stale_ && !fetching_; }
  /// The edit that made the current generation, if this client was told.
  const std::string& made_by() const { return made_by_; }
  /// Bytes that the states kept for undo and redo use, and their cap; 0: not known.
  std::uint64_t history_bytes() const { return history_bytes_; }
  std::uint64_t history_cap() const { return history_cap_; }

  // For what opens, edits and drags:

  /// Takes a state that the server has told. True: of another document than the state before.
  bool take_state(const ipc::DocumentState& state);
  /// Follows the document of that state. `other`: what `take_state` has returned.
  void follow_state(bool other);
  /// The document was opened, possibly the same deck anew.
  void opened();
  /// The current generation is the one of this number.
  bool shows(std::uint64_t generation) const;
  /// A newer generation exists, or the same one after saving.
  void outdate() { stale_ = true; }

  /// Calls it whenever the server has answered a request for a snapshot, with its generation; with nothing if there is none.
  void when_fetched(std::function<void(std::optional<std::uint64_t>)> then) { fetched_then_ = std::move(then); }
  /// Fetches a newer generation.
  void turn();

  void heard(const ipc::Event& event) override;
  void lost() override { stale_ = fetching_ = fetched_ = false; }

 private:
  void took_snapshot(const ipc::Answer& answer);
  void show(std::shared_ptr<const ipc::SnapshotView> view);
  void take_history(std::uint64_t bytes, std::uint64_t cap);

  Connection& connection_;
  DocumentNumber& number_;
  LinkNotices& notices_;
  notices::Trace trace_;
  std::optional<ipc::DocumentState> state_;
  std::vector<notices::ToldWarning> warnings_;
  std::uint64_t recovery_said_ = 0;  ///< the connection whose recovered edits were announced
  std::shared_ptr<const ipc::SnapshotView> snapshot_;
  bool stale_ = false;     ///< a newer generation exists
  bool fetching_ = false;  ///< a snapshot is requested and hasn't arrived
  bool fetched_ = false;   ///< the snapshot is of this connection
  std::function<void(std::optional<std::uint64_t>)> fetched_then_;
  std::string made_by_;
  std::uint64_t history_bytes_ = 0, history_cap_ = 0;
};

}  // namespace prismesh::kiosk::link
