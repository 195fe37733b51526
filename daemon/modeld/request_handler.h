// Handles requests on the worker thread. Each call handles one request and returns its answer and the events for all clients. Used by one
// thread; knows no clients.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/clock.h"
#include "base/progress.h"
#include "daemon/modeld/document_keeper.h"
#include "daemon/modeld/drag_session.h"
#include "daemon/modeld/field_maker.h"
#include "daemon/modeld/stored_models.h"
#include "ipc/model/messages.h"
#include "ipc/model/snapshot_publisher.h"
#include "mesh/document/contacts.h"

namespace prismesh::modeld {

/// An immutable view of the document for answers and snapshots.
struct PublishedState {
  std::shared_ptr<const mesh::document::Document> document;  ///< null: no document is open
  ipc::DocumentState state;
};

struct Outcome {
  ipc::Answer answer = ipc::Done{};
  std::vector<ipc::Descriptor> descriptors;
  std::vector<ipc::Event> events;
  std::optional<PublishedState> published;  ///< if it changed
  std::optional<DragFeel> felt{};           ///< of a drag's step, if it was asked for
};

class RequestHandler {
 public:
  RequestHandler(StateFolder folder, ipc::SnapshotPublisher& publisher, std::size_t history_bytes, Clock& clock, DeckSource decks = {},
                 StoredModels models = {})
      : keeper_(std::move(folder), history_bytes, std::move(decks)), models_(std::move(models)), publisher_(publisher), clock_(clock) {}

  Outcome open(const ipc::Open& request, const Progress& progress);
  /// Reopens the deck that was open when the daemon ended. The answer is Failed if that can't be opened.
  Outcome reopen(const Progress& progress);
  /// Only long edits report to `progress`; a cancelled edit changes nothing.
  Outcome edit(const mesh::document::Edit& edit, const Progress& progress = {});
  Outcome count(const ipc::Count& request, const Progress& progress = {}) const;
  Outcome quality(const ipc::GetQuality& request) const;
  Outcome find(const ipc::FindShells& request) const;
  Outcome preview(const ipc::PreviewEdit& request) const;
  Outcome followed_edges(const ipc::FindFollowedEdges& request) const;
  /// Makes a field that views colour by. A deck to compare with is read here and kept for the next request.
  Outcome field(const ipc::GetField& request, const Progress& progress);
  /// Finds where shells cross or are too close.
  Outcome go_to(const ipc::GoTo& request, const Progress& progress);
  Outcome contacts(const ipc::GetContacts& request, const Progress& progress);
  Outcome weld_checks(const ipc::GetWeldChecks& request) const;
  /// A cancel before the first file is replaced leaves all files as they were; a later one is ignored.
  Outcome save(const ipc::Save& request, const Progress& progress = {});
  Outcome close(const ipc::Close& request);
  /// Answers DragBegun, or Failed; then no drag is under way.
  Outcome begin_drag(std::uint64_t number, const mesh::document::Edit& edit);
  Outcome step_drag(const ipc::DragStep& step, bool for_pen);
  Outcome commit_drag();
  Outcome cancel_drag(const std::string& why);

  /// As DocumentKeeper::appending. May be read from any thread.
  const daemon::Heartbeat& appending() const { return keeper_.appending(); }

 private:
  Outcome opened();
  Outcome edited(Result<mesh::document::EditReport> report);
  void show(const std::string& made_by, Outcome& outcome);

  void give_back(ipc::Saved& saved);
  void describe_stored(const std::string& model) const;

  DocumentKeeper keeper_;
  StoredModels models_;
  FieldMaker fields_;
  mesh::document::ContactSearch contact_;  ///< of the open document
  ipc::SnapshotPublisher& publisher_;
  Clock& clock_;  ///< measures how long edits take
  std::optional<DragSession> drag_;
  std::uint64_t drag_number_ = 0;
};

}  // namespace prismesh::modeld
