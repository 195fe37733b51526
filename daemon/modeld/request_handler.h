// Handles requests on the worker thread: each call is one request from beginning to end, with its answer and the events for all clients.
// Single-threaded; knows no clients.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/clock.h"
#include "base/progress.h"
#include "daemon/modeld/document_keeper.h"
#include "daemon/modeld/drag_session.h"
#include "daemon/modeld/field_maker.h"
#include "ipc/messages.h"
#include "ipc/snapshot_publisher.h"

namespace prismesh::modeld {

/// What may be shown of the document; a value that later work doesn't change.
struct PublishedState {
  std::shared_ptr<const mesh::document::Document> document;  ///< null: none is open
  ipc::DocumentState state;
};

struct Outcome {
  ipc::Answer answer = ipc::Done{};
  std::vector<ipc::Descriptor> descriptors;
  std::vector<ipc::Event> events;
  std::optional<PublishedState> published;  ///< if it changed
};

class RequestHandler {
 public:
  RequestHandler(StateFolder folder, ipc::SnapshotPublisher& publisher, std::size_t history_bytes, Clock& clock)
      : keeper_(std::move(folder), history_bytes), publisher_(publisher), clock_(clock) {}

  Outcome open(const ipc::Open& request, const Progress& progress);
  /// What was open when the last life ended. The answer is Failed if that couldn't be opened.
  Outcome reopen(const Progress& progress);
  /// `progress` is asked by long edits only; told to stop, they leave everything as it was.
  Outcome edit(const mesh::document::Edit& edit, const Progress& progress = {});
  Outcome count(const ipc::Count& request, const Progress& progress = {}) const;
  Outcome quality(const ipc::GetQuality& request) const;
  Outcome find(const ipc::FindShells& request) const;
  Outcome preview(const ipc::PreviewEdit& request) const;
  /// A field as views colour by it; another deck that it is compared with is read here, and kept for the next time.
  Outcome field(const ipc::GetField& request, const Progress& progress);
  /// Told to stop before the first file is put in place, it leaves all files as they were; from then on it goes on.
  Outcome save(const ipc::Save& request, const Progress& progress = {});
  Outcome close(const ipc::Close& request);
  /// The answer is DragBegun, or Failed and there is no drag.
  Outcome begin_drag(std::uint64_t number, const mesh::document::Edit& edit);
  void step_drag(const ipc::DragStep& step);
  Outcome commit_drag();
  Outcome cancel_drag(const std::string& why);

 private:
  Outcome opened();
  void show(const std::string& made_by, Outcome& outcome);

  DocumentKeeper keeper_;
  FieldMaker fields_;
  ipc::SnapshotPublisher& publisher_;
  Clock& clock_;  ///< for how long edits take
  std::optional<DragSession> drag_;
  std::uint64_t drag_number_ = 0;
};

}  // namespace prismesh::modeld
