#include "daemon/modeld/request_handler.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "base/log.h"
#include "daemon/modeld/contacts_answer.h"
#include "daemon/modeld/edit_preview.h"
#include "ipc/wire/failure.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/pull_lines.h"
#include "mesh/document/quality_figures.h"
#include "mesh/document/weld_checks.h"

namespace prismesh::modeld {

namespace {

/// The outcome of a query: its answer, or Failed with the reason.
template <class Answer>
Outcome told(Result<Answer> found) {
  if (!found) return {ipc::failed_from(found.error()), {}, {}, {}};
  return {std::move(*found), {}, {}, {}};
}

/// `blocked`: by unsaved edits, so that the client can ask its user about them.
Outcome failed_by_edits(const Error& error, bool blocked) {
  ipc::Failed failed = ipc::failed_from(error);
  if (blocked) failed.unsaved_edits = true;
  return {std::move(failed), {}, {}, {}};
}

}  // namespace

/// Publishes the current generation and notifies all clients. The edit stays valid if there is no memory for the snapshot.
void RequestHandler::show(const std::string& made_by, Outcome& outcome) {
  const mesh::document::Document& document = keeper_.document();
  const ipc::DocumentState state = keeper_.state();
  if (Result<ipc::PublishedSnapshot> published = publisher_.publish(document, state.changed))
    publisher_.release(published->lease);  // the publisher keeps the current one
  else if (auto* edited = std::get_if<ipc::Edited>(&outcome.answer))
    edited->report.notes.push_back("the views couldn't be given the new state: " + published.error().text());
  outcome.events.emplace_back(ipc::GenerationPublished{state.generation, made_by, state.history_bytes, state.history_cap});
  outcome.published = PublishedState{std::make_shared<const mesh::document::Document>(document), state};
}

Outcome RequestHandler::opened() {
  contact_ = {};
  Outcome outcome;
  show(keeper_.document().current().made_by, outcome);
  outcome.events.insert(outcome.events.begin(), ipc::DocumentOpened{keeper_.document().path.string()});
  outcome.answer = outcome.published->state;
  return outcome;
}

Outcome RequestHandler::open(const ipc::Open& request, const Progress& progress) {
  const bool blocked = keeper_.is_blocked(request);
  if (!blocked && !request.stored.empty() && request.path.empty()) {
    const Result<ipc::Open> laid_out = models_.lay_out(request);
    if (!laid_out) return {ipc::failed_from(laid_out.error()), {}, {}, {}};
    Outcome outcome = open(*laid_out, progress);
    if (outcome.published) describe_stored(request.stored);
    return outcome;
  }
  const Result<bool> done = keeper_.open(request, progress);
  if (!done) return failed_by_edits(done.error(), blocked);
  // Already open: only the asking client gets the state; other views stay as they are.
  return *done ? opened() : Outcome{keeper_.state(), {}, {}, {}};
}

Outcome RequestHandler::reopen(const Progress& progress) {
  const Result<bool> done = keeper_.reopen(progress);
  if (!done) return {ipc::failed_from(done.error()), {}, {}, {}};
  return *done ? opened() : Outcome{};
}

Outcome RequestHandler::edit(const mesh::document::Edit& edit, const Progress& progress) {
  return edited(keeper_.edit(edit, progress, &clock_));
}

Outcome RequestHandler::go_to(const ipc::GoTo& request, const Progress& progress) {
  return edited(keeper_.go_to(request.generation, progress, &clock_));
}

Outcome RequestHandler::edited(Result<mesh::document::EditReport> report) {
  if (!report) return {ipc::failed_from(report.error()), {}, {}, {}};
  Outcome outcome;
  const std::string made_by = report->edit;
  outcome.answer = ipc::Edited{std::move(*report), keeper_.document().current().number};
  show(made_by, outcome);
  return outcome;
}

Outcome RequestHandler::count(const ipc::Count& request, const Progress& progress) const {
  if (!keeper_.is_open()) return {ipc::failed_from({"", 0, "no document is open"}), {}, {}, {}};
  const mesh::document::Generation& current = keeper_.document().current();
  const Result<mesh::select::Chosen> chosen =
      mesh::select::evaluate(current.model, request.expr, request.kind, current.relations->names, progress);
  if (!chosen) return {ipc::failed_from(chosen.error()), {}, {}, {}};
  return {ipc::Counted{chosen->nodes.size(), chosen->shells.size(), chosen->parts.size()}, {}, {}, {}};
}

Outcome RequestHandler::quality(const ipc::GetQuality& request) const {
  if (!keeper_.is_open()) return {ipc::failed_from({"", 0, "no document is open"}), {}, {}, {}};
  return told(mesh::document::quality_figures(keeper_.document(), request));
}

Outcome RequestHandler::find(const ipc::FindShells& request) const {
  if (!keeper_.is_open()) return {ipc::failed_from({"", 0, "no document is open"}), {}, {}, {}};
  return told(mesh::document::find_shells(keeper_.document(), request));
}

Outcome RequestHandler::preview(const ipc::PreviewEdit& request) const {
  if (!keeper_.is_open()) return {ipc::failed_from({"", 0, "no document is open"}), {}, {}, {}};
  return told(preview_edit(keeper_.document(), request.edit, &clock_));
}

Outcome RequestHandler::followed_edges(const ipc::FindFollowedEdges& request) const {
  if (!keeper_.is_open()) return {ipc::failed_from({"", 0, "no document is open"}), {}, {}, {}};
  const mesh::document::Generation& current = keeper_.document().current();
  const auto lines = mesh::document::find_pull_lines(current, request.edit);
  if (!lines) return {ipc::failed_from(lines.error()), {}, {}, {}};
  ipc::FollowedEdges found;
  found.generation = current.number;
  found.edge_count = lines->followed.size();
  for (const auto& edge : std::span(lines->followed).first(std::min(lines->followed.size(), ipc::kMaxFollowedEdges)))
    found.nodes.insert(found.nodes.end(), {edge[0].value, edge[1].value});
  for (const auto& [from, to] : std::span(lines->halfway).first(std::min(lines->halfway.size(), ipc::kMaxFollowedEdges)))
    found.halfway.push_back({from.x(), from.y(), from.z(), to.x(), to.y(), to.z()});
  return {std::move(found), {}, {}, {}};
}

Outcome RequestHandler::field(const ipc::GetField& request, const Progress& progress) {
  if (!keeper_.is_open()) return {ipc::failed_from({"", 0, "no document is open"}), {}, {}, {}};
  // Most fields are made before a user could read a progress message.
  const auto tell = [&](double fraction) { return fraction <= 0 || progress(fraction); };
  Result<FieldMaker::MadeField> made = fields_.make(keeper_.document(), request, tell);
  Outcome outcome;
  if (made) {
    outcome.answer = std::move(made->answer);
    outcome.descriptors.push_back(std::move(made->values));
  } else {
    outcome.answer = ipc::failed_from(made.error());
  }
  return outcome;
}

Outcome RequestHandler::contacts(const ipc::GetContacts& request, const Progress& progress) {
  if (!keeper_.is_open()) return {ipc::failed_from({"", 0, "no document is open"}), {}, {}, {}};
  const mesh::document::Generation& current = keeper_.document().current();
  const auto tell = [&](double fraction) { return fraction <= 0 || progress(fraction); };
  const std::int64_t began_ns = clock_.now_ns();
  const Result<mesh::document::Contacts> found =
      mesh::document::find_contacts(current, contact_, {request.select, request.gap, request.thickness}, tell);
  if (!found) return {ipc::failed_from(found.error()), {}, {}, {}};
  ipc::Contacts answer = contacts_answer(current.number, *found);
  answer.search_ns = clock_.now_ns() - began_ns;
  return {std::move(answer), {}, {}, {}};
}

Outcome RequestHandler::weld_checks(const ipc::GetWeldChecks& request) const {
  if (!keeper_.is_open()) return {ipc::failed_from({"", 0, "no document is open"}), {}, {}, {}};
  for (const double length : {request.edge_distance, request.pitch})
    if (!std::isfinite(length) || length < 0) return {ipc::failed_from({"", 0, "a length must be at least 0"}), {}, {}, {}};
  const mesh::document::Document& document = keeper_.document();
  const std::int64_t began_ns = clock_.now_ns();
  const mesh::document::WeldChecks checks = mesh::document::check_welds(document, {request.edge_distance, request.pitch});
  ipc::WeldChecks answer;
  answer.generation = document.current().number;
  answer.welds = checks.welds;
  answer.finding_count = checks.findings.size();
  answer.search_ns = clock_.now_ns() - began_ns;
  for (const mesh::document::WeldFinding& finding : checks.findings) {
    if (answer.findings.size() == ipc::kMaxWeldFindings) break;
    answer.findings.push_back({finding.kind, finding.words, {finding.at.x(), finding.at.y(), finding.at.z()}});
  }
  return {std::move(answer), {}, {}, {}};
}

Outcome RequestHandler::save(const ipc::Save& request, const Progress& progress) {
  if (request.asks && request.path) {
    Result<std::optional<ipc::SaveWould>> would = keeper_.would(*request.path);
    if (!would) return {ipc::failed_from(would.error()), {}, {}, {}};
    if (*would) return {std::move(**would), {}, {}, {}};
  }
  Result<ipc::Saved> saved = request.path && request.becomes         ? keeper_.save_as(*request.path, progress)
                             : request.path && request.stays_unsaved ? keeper_.save_copy(*request.path, progress)
                                                                     : keeper_.save(request.path, progress);
  if (!saved) return {ipc::failed_from(saved.error()), {}, {}, {}};
  if (!request.path) give_back(*saved);
  Outcome outcome;
  outcome.answer = std::move(*saved);
  if (request.becomes) outcome.events.emplace_back(ipc::DocumentOpened{keeper_.document().path.string()});
  show("save", outcome);
  return outcome;
}

/// A model of the store that was edited and saved is published as a new one. The save holds whether that works or not.
void RequestHandler::give_back(ipc::Saved& saved) {
  const std::string from = keeper_.state().stored;
  if (from.empty()) return;
  const Result<std::string> model = models_.give_back(keeper_.document().path, from);
  if (!model) {
    saved.notes.push_back("saved on the station; in the store it isn't published: " + model.error().text() + ". Save again to try again");
    return;
  }
  if (*model == from) return;
  keeper_.published_as(*model);
  describe_stored(*model);
  saved.notes.push_back("published in the store as " + *model);
}

/// prismesh-intake reads no deck, so whoever has read one tells it. The model is as good without.
void RequestHandler::describe_stored(const std::string& model) const {
  if (const Result<void> told = models_.describe(model, mesh::document::count_model(keeper_.document())); !told)
    logging::warn("what was found in {} isn't in the catalogue: {}", model, told.error().text());
}

Outcome RequestHandler::close(const ipc::Close& request) {
  const bool blocked = keeper_.is_blocked(request);
  if (const Result<void> done = keeper_.close(request.discard, request.keep); !done) return failed_by_edits(done.error(), blocked);
  publisher_.forget();
  contact_ = {};
  fields_.forget();
  Outcome outcome;
  outcome.events.emplace_back(ipc::DocumentClosed{});
  outcome.published = PublishedState{};
  return outcome;
}

Outcome RequestHandler::begin_drag(std::uint64_t number, const mesh::document::Edit& edit) {
  if (!keeper_.is_open()) return {ipc::failed_from({"", 0, "no document is open"}), {}, {}, {}};
  Result<DragSession> drag = DragSession::begin(number, keeper_.document(), edit, contact_);
  if (!drag) return {ipc::failed_from(drag.error()), {}, {}, {}};
  Result<ipc::Descriptor> preview = drag->preview().duplicate();
  if (!preview) return {ipc::failed_from(preview.error()), {}, {}, {}};
  drag_ = std::move(*drag);
  drag_number_ = number;
  Outcome outcome;
  outcome.answer = drag_->begun();
  outcome.descriptors.push_back(std::move(*preview));
  return outcome;
}

Outcome RequestHandler::step_drag(const ipc::DragStep& step, bool for_pen) {
  Outcome outcome;
  if (!drag_) return outcome;
  drag_->step(step);
  if (for_pen) outcome.felt = drag_->feel();
  return outcome;
}

Outcome RequestHandler::commit_drag() {
  if (!drag_->moved()) {
    Outcome outcome = cancel_drag("it moved nothing");
    outcome.answer = ipc::Edited{{}, keeper_.document().current().number};
    return outcome;
  }
  const mesh::document::Edit what = drag_->edit();
  drag_.reset();
  Outcome outcome = edit(what);
  const auto* problem = std::get_if<ipc::Failed>(&outcome.answer);
  outcome.events.emplace_back(ipc::DragEnded{drag_number_, problem == nullptr, problem != nullptr ? problem->message : ""});
  return outcome;
}

Outcome RequestHandler::cancel_drag(const std::string& why) {
  drag_.reset();
  Outcome outcome;
  outcome.events.emplace_back(ipc::DragEnded{drag_number_, false, why});
  return outcome;
}

}  // namespace prismesh::modeld
