#include "kiosk/link/remote_drag.h"

#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "ipc/wire/failure.h"
#include "kiosk/link/notice_words.h"
#include "kiosk/link/result_words.h"

namespace prismesh::kiosk::link {
namespace {

/// After this time a step without a preview frame counts as lost.
constexpr std::int64_t kStepPatienceNs = 250'000'000;

}  // namespace

RemoteDrag::RemoteDrag(Connection& connection, FollowedDocument& document, LinkNotices& notices, Clock& clock, notices::Trace trace)
    : connection_(connection), document_(document), notices_(notices), clock_(clock), trace_(trace) {
  connection_.add(*this);
  document_.when_fetched([this](std::optional<std::uint64_t> generation) { fetched(generation); });
}

void RemoteDrag::begin(mesh::document::Edit edit) {
  drag_ = Drag{};
  drag_->edit = edit;
  connection_.ask(ipc::BeginDrag{std::move(edit)}, [this](const ipc::Answer& answer) { began(answer); });
  if (!connection_.connected()) drag_.reset();
}

void RemoteDrag::began(const ipc::Answer& answer) {
  if (const auto* failed = std::get_if<ipc::Failed>(&answer)) {
    notices_.say(notice_of_error(ipc::error_from(*failed)));
    return drop("refused");
  }
  const auto* begun = std::get_if<ipc::DragBegun>(&answer);
  if (begun == nullptr || !drag_) return;
  Result<ipc::PreviewReader> reader = connection_.take(*begun);
  drag_->told.begun_ = *begun;
  if (!reader) {
    notices_.say(notice_of_error(reader.error()));
    drag_->wish = Wish::cancel;
    return;
  }
  drag_->told.reader_ = std::move(*reader);
  trace_.line(fmt::format("drag begun {} nodes {} grab {}", begun->drag, begun->nodes, begun->grab));
}

void RemoteDrag::pull(const mesh::document::Displacement& displacement) {
  if (!drag_ || drag_->wish != Wish::hold) return;
  const mesh::document::Displacement& before = drag_->wanted;
  if (before.by == displacement.by && before.distance == displacement.distance && before.degrees == displacement.degrees) return;
  drag_->wanted = displacement;
  drag_->moved = true;
}

void RemoteDrag::commit() {
  if (drag_ && drag_->wish == Wish::hold) drag_->wish = Wish::commit;
}

void RemoteDrag::cancel() {
  if (drag_ && !drag_->end_sent) drag_->wish = Wish::cancel;
}

void RemoteDrag::turn() {
  if (!connection_.connected() || !drag_ || !drag_->told.begun() || drag_->end_sent) return;
  Drag& drag = *drag_;
  RunningDrag& told = drag.told;
  if (told.reader_ && told.reader_->latest(told.frame_)) ++changes_;
  if (drag.wish == Wish::cancel || (drag.wish == Wish::commit && drag.sequence == 0 && !drag.moved)) {
    drag.end_sent = true;
    return connection_.ask(ipc::CancelDrag{told.facts().drag}, [this](const ipc::Answer&) { drop("cancelled"); });
  }
  const bool seen = told.frame().sequence >= drag.sequence || clock_.now_ns() - drag.sent_ns > kStepPatienceNs;
  if (drag.moved && (seen || drag.wish == Wish::commit)) send_step();
  if (drag_ && drag_->wish == Wish::commit) send_commit();  // the step may have lost the connection
}

void RemoteDrag::send_step() {
  Drag& drag = *drag_;
  ipc::DragStep step;
  step.drag = drag.told.facts().drag;
  step.sequence = ++drag.sequence;
  step.by = {drag.wanted.by.x(), drag.wanted.by.y(), drag.wanted.by.z()};
  step.distance = drag.wanted.distance;
  step.degrees = drag.wanted.degrees;
  drag.moved = false;
  drag.sent_ns = clock_.now_ns();
  connection_.tell(step);
}

void RemoteDrag::send_commit() {
  drag_->end_sent = true;
  connection_.ask(ipc::CommitDrag{drag_->told.facts().drag}, [this](const ipc::Answer& answer) {
    if (const auto* failed = std::get_if<ipc::Failed>(&answer)) {
      notices_.say(notice_of_error(ipc::error_from(*failed)));
      return drop("refused");
    }
    if (const auto* edited = std::get_if<ipc::Edited>(&answer)) committed(*edited);
  });
}

void RemoteDrag::committed(const ipc::Edited& edited) {
  if (!drag_) return;
  mesh::document::set_displacement(drag_->edit, drag_->wanted);
  notices_.tell_edit(words_of_edit(drag_->edit, document_.length_unit()), edited.report, document_.length_unit(), edited.generation);
  // Without its preview the nodes would jump back until the generation is here.
  drag_->made = edited.generation;
  if (document_.shows(edited.generation))
    drop("committed");
  else
    document_.outdate();
}

/// If a newer generation is on its way already, somebody may have undone the drag meanwhile: then it is that one's turn.
void RemoteDrag::fetched(std::optional<std::uint64_t> generation) {
  if (drag_ && drag_->made && (!generation || *generation == *drag_->made || document_.up_to_date())) drop("committed");
}

void RemoteDrag::heard(const ipc::Event& event) {
  const auto* ended = std::get_if<ipc::DragEnded>(&event);
  if (ended == nullptr || !drag_ || !drag_->told.begun() || drag_->told.facts().drag != ended->drag || ended->committed) return;
  if (!drag_->end_sent) notices_.say(notice_of_ended_drag(*ended));
  drop("cancelled");
}

void RemoteDrag::drop(const char* how) {
  if (!drag_) return;
  drag_.reset();
  ++changes_;
  trace_.line(std::string("drag ") + how);
}

}  // namespace prismesh::kiosk::link
