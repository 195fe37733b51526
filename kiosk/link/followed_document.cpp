#include "kiosk/link/followed_document.h"

#include <utility>
#include <variant>

#include <fmt/format.h>

#include "ipc/wire/failure.h"
#include "kiosk/link/notice_words.h"

namespace prismesh::kiosk::link {

FollowedDocument::FollowedDocument(Connection& connection, DocumentNumber& number, LinkNotices& notices, notices::Trace trace)
    : connection_(connection), number_(number), notices_(notices), trace_(trace) {
  connection_.add(*this);
}

void FollowedDocument::turn() {
  if (!connection_.connected() || !stale_ || fetching_) return;
  stale_ = false;
  fetching_ = true;
  ipc::GetSnapshot request;
  request.have_segments = connection_.segments();
  connection_.ask(request, [this](const ipc::Answer& answer) { took_snapshot(answer); });
}

void FollowedDocument::heard(const ipc::Event& event) {
  if (const auto* published = std::get_if<ipc::GenerationPublished>(&event)) {
    if (published->made_by != "save") made_by_ = published->made_by;  // a save makes no other state
    take_history(published->history_bytes, published->history_cap);
    outdate();
  }
  if (std::holds_alternative<ipc::DocumentOpened>(event)) opened();
  if (std::holds_alternative<ipc::DocumentClosed>(event)) {
    snapshot_.reset();
    number_.close();
  }
}

void FollowedDocument::opened() {
  fetched_ = false;  // it may be the same deck, read anew
  outdate();
}

void FollowedDocument::take_history(std::uint64_t bytes, std::uint64_t cap) {
  history_bytes_ = bytes;
  history_cap_ = cap;
}

bool FollowedDocument::take_state(const ipc::DocumentState& state) {
  const bool other = !state_ || state_->path != state.path;
  state_ = state;
  take_history(state.history_bytes, state.history_cap);
  return other;
}

void FollowedDocument::follow_state(bool other) {
  number_.follow(state_->path);
  if (other || recovery_said_ != connection_.number()) {
    recovery_said_ = connection_.number();
    if (auto notice = notice_of_recovery(*state_)) notices_.say(std::move(*notice));
  }
  if (other) {
    warnings_ = notices::told_warnings(state_->warnings);
    if (auto notice = notice_of_warnings(warnings_)) notices_.say(std::move(*notice));
  }
  if (!shows(state_->generation) || snapshot_->info().document != state_->path) outdate();
}

bool FollowedDocument::shows(std::uint64_t generation) const { return fetched_ && snapshot_ && snapshot_->info().generation == generation; }

void FollowedDocument::took_snapshot(const ipc::Answer& answer) {
  fetching_ = false;
  const auto* snapshot = std::get_if<ipc::Snapshot>(&answer);
  if (snapshot == nullptr) {
    // Without an open document it is no news that there is none to show.
    const auto* failed = std::get_if<ipc::Failed>(&answer);
    if (failed != nullptr && state_ && state_->open) notices_.say(notice_of_error(ipc::error_from(*failed)));
  } else if (Result<std::shared_ptr<const ipc::SnapshotView>> view = connection_.take(*snapshot)) {
    show(std::move(*view));
  } else {
    notices_.say(notice_of_error(view.error()));
  }
  if (fetched_then_) fetched_then_(snapshot == nullptr ? std::nullopt : std::optional(snapshot->generation));
}

void FollowedDocument::show(std::shared_ptr<const ipc::SnapshotView> view) {
  const ipc::SnapshotInfo& info = view->info();
  // A snapshot that was asked for twice comes twice.
  if (shows(info.generation) && snapshot_->info().document == info.document && snapshot_->info().changed == info.changed) return;
  number_.follow(info.document);
  trace_.line(fmt::format("generation {} selected {} warn {} fail {} changed {}", info.generation, info.selected_nodes, info.counts.warn,
                          info.counts.fail, info.changed ? 1 : 0));
  snapshot_ = std::move(view);
  fetched_ = true;
}

}  // namespace prismesh::kiosk::link
