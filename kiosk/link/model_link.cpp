#include "kiosk/link/model_link.h"

#include <algorithm>
#include <array>
#include <chrono>

#include <fmt/format.h>

#include "base/progress.h"
#include "base/readable_number.h"
#include "ipc/wire/failure.h"
#include "kiosk/notices/notices.h"
#include "mesh/document/edit_kinds.h"

namespace prismesh::kiosk::link {
namespace {

using notices::Notice;

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kFirstBackOff = 100 * kMillisecond;
constexpr std::int64_t kMaxBackOff = 2000 * kMillisecond;
/// After this time a step without a preview frame counts as lost.
constexpr std::int64_t kStepPatience = 250 * kMillisecond;
constexpr int kDigits = 6;  ///< of what an edit reports

template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

std::string text_of(const ipc::Failed& failed) { return ipc::error_from(failed).text(); }

}  // namespace

bool was_stopped(const ipc::Failed& failed) { return is_cancelled(ipc::error_from(failed)); }

static bool is_of(std::string_view edit, mesh::document::EditGroup group) {
  const mesh::document::EditKind* kind = mesh::document::find_edit_kind(edit);
  return kind != nullptr && kind->group == group;
}

bool is_selecting(std::string_view edit) { return is_of(edit, mesh::document::EditGroup::selection); }

constexpr std::string_view kRepair = "repair";  ///< the work that can be stopped and kept

/// What the server is doing, in words.
static std::string busy_words(const ipc::ProgressMade& made, bool can_stop) {
  const std::string& what = made.what;
  std::string words = what == "open" ? "opening" : what == "relax" ? "relaxing" : what == kRepair ? "repairing" : what;
  if (!words.empty() && words[0] >= 'a' && words[0] <= 'z') words[0] = static_cast<char>(words[0] - 'a' + 'A');
  if (!made.doing.empty()) words += fmt::format(": {}, {} s", made.doing, made.seconds);
  if (!can_stop) return words + " ..";
  return words + (what == kRepair ? "\nEsc stops and discards it, Shift+Esc stops and keeps it" : " ..   Esc stops it");
}

/// Whether the server tells how far it is with it, and can be asked to stop.
static bool is_long(const ipc::Request& request) {
  return std::holds_alternative<ipc::Open>(request) || std::holds_alternative<ipc::Save>(request) ||
         std::holds_alternative<ipc::ApplyEdit>(request) || std::holds_alternative<ipc::GetField>(request);
}

bool is_mending(std::string_view edit) { return is_of(edit, mesh::document::EditGroup::mending); }

ModelLink::ModelLink(std::filesystem::path socket, std::optional<std::filesystem::path> deck, Clock& clock, notices::Trace trace)
    : socket_(std::move(socket)), deck_(std::move(deck)), clock_(clock), trace_(trace) {}

void ModelLink::turn() {
  if (!client_) try_connect();
  if (client_) read();
  if (client_ && stale_ && !fetching_) fetch_snapshot();
  if (client_ && drag_) turn_drag();
}

int ModelLink::patience_ms() const {
  if (!client_) return static_cast<int>(std::max<std::int64_t>(0, (next_attempt_ns_ - clock_.now_ns() + kMillisecond - 1) / kMillisecond));
  // Nothing announces a preview's next picture: while one is on its way, look again soon.
  const bool awaiting = drag_ && drag_->begun() && !drag_->end_sent_ && drag_->frame_.sequence < drag_->sequence_;
  return awaiting ? 2 : -1;
}

void ModelLink::try_connect() {
  const std::int64_t now = clock_.now_ns();
  if (now < next_attempt_ns_) return;
  Result<ipc::Client> client = ipc::Client::connect(socket_, "prismesh-kiosk");
  if (!client) {
    back_off_ns_ = std::clamp(back_off_ns_ * 2, kFirstBackOff, kMaxBackOff);
    next_attempt_ns_ = now + back_off_ns_;
    return;
  }
  client_ = std::move(*client);
  back_off_ns_ = 0;
  ++changes_;
  ++connections_;
  trace_.line("connected");
  ask_state();
}

void ModelLink::lost(const Error& error) {
  client_.reset();
  waiting_.clear();
  busy_.clear();
  stale_ = fetching_ = fetched_ = counting_ = opening_ = false;
  edits_ = long_ = 0;
  becoming_.clear();
  if (drag_) drop_drag("lost");
  next_attempt_ns_ = clock_.now_ns();
  ++changes_;
  trace_.line("disconnected " + error.text());
}

void ModelLink::ask(const ipc::Request& request, Then then) {
  if (!client_) return say(Notice::Kind::error, "The model server is not running: nothing was done. It will be tried again.");
  const Result<std::uint64_t> sent = client_->send(request);
  if (!sent) return lost(sent.error());
  const bool counts = is_long(request);
  long_ += counts ? 1 : 0;
  waiting_.emplace(*sent, Waiting{std::move(then), counts});
}

void ModelLink::question(const ipc::Request& request, Then then) {
  if (client_) ask(request, std::move(then));
}

void ModelLink::read() {
  if (Result<void> polled = client_->poll(); !polled) return lost(polled.error());
  while (client_) {
    if (const std::optional<ipc::Event> event = client_->next_event()) {
      heard(*event);
      continue;
    }
    const std::optional<ipc::Client::Reply> reply = client_->next_reply();
    if (!reply) break;
    auto node = waiting_.extract(reply->request);
    if (node.empty()) continue;
    ++changes_;
    const Waiting& waited = node.mapped();
    if (waited.is_long && --long_ == 0) busy_.clear();
    if (waited.then) waited.then(reply->answer);
  }
}

void ModelLink::heard(const ipc::Event& event) {
  ++changes_;
  std::visit(Overloaded{
                 [&](const ipc::GenerationPublished& published) {
                   if (published.made_by != "save") made_by_ = published.made_by;  // a save makes no other state
                   history_bytes_ = published.history_bytes;
                   history_cap_ = published.history_cap;
                   busy_.clear();
                   stale_ = true;
                 },
                 [&](const ipc::DocumentOpened& opened) {
                   if (!opening_) deck_ = opened.path;
                   fetched_ = false;  // it may be the same deck, read anew
                   busy_.clear();
                   stale_ = true;
                   ask_state();
                 },
                 [&](const ipc::DocumentClosed&) {
                   deck_.reset();
                   snapshot_.reset();
                   document_path_.clear();
                   ask_state();
                 },
                 [&](const ipc::ProgressMade& progress) {
                   const bool over = progress.fraction >= 1, named = progress.what == "open" && busy_.starts_with("Opening ");
                   if (over || !named) busy_ = over ? std::string() : busy_words(progress, long_ > 0);
                   busy_fraction_ = progress.fraction;
                 },
                 [&](const ipc::CameraMoved& moved) { camera_ = moved.camera; },
                 [&](const ipc::DragEnded& ended) {
                   if (!drag_ || !drag_->begun() || drag_->facts().drag != ended.drag) return;
                   if (!ended.committed && !drag_->end_sent_) say(Notice::Kind::warning, "The drag has ended: " + ended.why);
                   if (!ended.committed) drop_drag("cancelled");
                 },
             },
             event);
}

void ModelLink::ask_state() {
  ask(ipc::GetState{}, [this](const ipc::Answer& answer) {
    if (const auto* state = std::get_if<ipc::DocumentState>(&answer)) took_state(*state);
  });
}

void ModelLink::is_document(const std::string& path) {
  // Under another name of its own it isn't another document.
  if (std::exchange(document_path_, path) != path && path != becoming_) ++document_number_;
}

void ModelLink::took_state(const ipc::DocumentState& state) {
  const bool first = !state_ || state_->path != state.path;
  state_ = state;
  history_bytes_ = state.history_bytes;
  history_cap_ = state.history_cap;
  if (!state.open) {
    // The server is new: it brings the journal's edits back when it opens the deck. While it opens by itself what was open before, a kiosk
    // that was just started with a deck waits for its turn.
    const bool started = connections_ == 1 && document_number_ == 0;
    if (deck_ && !opening_ && (!state.busy || started)) open(*deck_);
    return;
  }
  if (deck_ && deck_->string() != state.path && !snapshot_ && !opening_) {
    const std::filesystem::path wanted = *deck_;
    deck_ = state.path;
    open(wanted);
    return;
  }
  if (!opening_) deck_ = state.path;
  is_document(state.path);
  if (first || recovered_said_ != connections_) say_recovered(state);
  if (first) say_warnings();
  if (!fetched_ || !snapshot_ || snapshot_->info().generation != state.generation || snapshot_->info().document != state.path)
    stale_ = true;
}

/// The worst of them; the list has all.
void ModelLink::say_warnings() {
  warnings_ = notices::told_warnings(state_->warnings);
  if (warnings_.empty()) return;
  const notices::ToldWarning& worst = warnings_.front();
  std::string text = worst.place + ": " + worst.text;
  if (warnings_.size() > 1) text += fmt::format("\n{} about this deck: Ctrl+I lists them.", notices::counts_of(warnings_));
  say(worst.is_error ? Notice::Kind::error : Notice::Kind::warning, std::move(text));
  notices_.back().lists_warnings = warnings_.size() > 1;
}

void ModelLink::say_recovered(const ipc::DocumentState& state) {
  recovered_said_ = connections_;
  // Without a change these are steps that a save has carried over, such as the selection.
  if (state.recovered_edits == 0 || !state.changed) return;
  // A warning stays until it is closed, and comes before those of the deck.
  say(Notice::Kind::warning,
      fmt::format("{} edit{} of {} that had not been saved {} recovered.", state.recovered_edits, state.recovered_edits == 1 ? "" : "s",
                  std::filesystem::path(state.path).filename().string(), state.recovered_edits == 1 ? "was" : "were"));
}

void ModelLink::fetch_snapshot() {
  stale_ = false;
  fetching_ = true;
  ipc::GetSnapshot request;
  request.have_segments = client_->segments();
  ask(request, [this](const ipc::Answer& answer) { took_snapshot(answer); });
}

void ModelLink::took_snapshot(const ipc::Answer& answer) {
  fetching_ = false;
  const auto* snapshot = std::get_if<ipc::Snapshot>(&answer);
  if (snapshot == nullptr) {
    // Without an open document it is no news that there is none to show.
    const auto* failed = std::get_if<ipc::Failed>(&answer);
    if (failed != nullptr && state_ && state_->open) say(Notice::Kind::error, text_of(*failed));
    if (drag_ && drag_->made_) drop_drag("committed");
    return;
  }
  Result<std::shared_ptr<const ipc::SnapshotView>> view = client_->take_snapshot(*snapshot);
  if (view)
    show(std::move(*view));
  else
    say(Notice::Kind::error, view.error().text());
  // If a newer one is on its way already, somebody may have undone the drag meanwhile: then it is that one's turn.
  if (drag_ && drag_->made_ && (*drag_->made_ == snapshot->generation || !stale_)) drop_drag("committed");
}

void ModelLink::show(std::shared_ptr<const ipc::SnapshotView> view) {
  const ipc::SnapshotInfo& info = view->info();
  // A snapshot that was asked for twice comes twice.
  if (fetched_ && snapshot_ && snapshot_->info().generation == info.generation && snapshot_->info().document == info.document &&
      snapshot_->info().changed == info.changed)
    return;
  is_document(info.document);
  trace_.line(fmt::format("generation {} selected {} warn {} fail {} changed {}", info.generation, info.selected_nodes, info.counts.warn,
                          info.counts.fail, info.changed ? 1 : 0));
  snapshot_ = std::move(view);
  fetched_ = true;
}

void ModelLink::open(const std::filesystem::path& deck, Unsaved unsaved) {
  std::error_code ignored;
  const std::filesystem::path whole = std::filesystem::absolute(deck, ignored);
  busy_ = busy_words({"Opening " + whole.filename().string()}, true);
  busy_fraction_ = 0;
  ipc::Open request;
  request.path = whole.string();
  request.discard = unsaved == Unsaved::discard;
  request.keep = unsaved == Unsaved::keep;
  const std::string kept = unsaved == Unsaved::keep ? std::filesystem::path(document_path_).filename().string() : std::string();
  opening_ = client_.has_value();
  ask(request, [this, whole, kept](const ipc::Answer& answer) { took_opened(answer, whole, kept); });
  if (!client_) busy_.clear();
}

/// `kept`: the deck whose unsaved edits were kept; empty: none.
void ModelLink::took_opened(const ipc::Answer& answer, const std::filesystem::path& whole, const std::string& kept) {
  busy_.clear();
  opening_ = false;
  if (const auto* failed = std::get_if<ipc::Failed>(&answer)) {
    if (was_stopped(*failed))
      say_failed(*failed, whole.filename().string() + " was not opened");
    else if (failed->unsaved_edits.value_or(false))
      refused_ = whole;
    else
      say(Notice::Kind::error, fmt::format("{} was not opened. {}", whole.filename().string(), text_of(*failed)));
    if (snapshot_) return;
    // What the server has open instead is shown: nobody could save it unseen.
    deck_.reset();
    return ask_state();
  }
  deck_ = whole;
  fetched_ = false;
  stale_ = true;
  trace_.line("document " + whole.string());
  if (!kept.empty())
    say(Notice::Kind::information, fmt::format("The unsaved edits of {} are kept: they come back when it is opened again.", kept));
  if (const auto* state = std::get_if<ipc::DocumentState>(&answer))
    took_state(*state);
  else
    ask_state();
}

void ModelLink::close(Then then) {
  ask(ipc::Close{true}, [this, then = std::move(then)](const ipc::Answer& answer) {
    if (const auto* failed = std::get_if<ipc::Failed>(&answer)) say_failed(*failed, "nothing was discarded");
    then(answer);
  });
}

void ModelLink::save(const ipc::Save& request, const std::string& remark, Then then) {
  becoming_ = request.becomes && request.path ? *request.path : std::string();
  ask(request, [this, becomes = request.becomes, remark, then = std::move(then)](const ipc::Answer& answer) {
    busy_.clear();
    becoming_.clear();
    if (const auto* failed = std::get_if<ipc::Failed>(&answer)) say_failed(*failed, "nothing was saved");
    if (const auto* saved = std::get_if<ipc::Saved>(&answer)) took_saved(*saved, becomes, remark);
    then(answer);
  });
}

void ModelLink::took_saved(const ipc::Saved& saved, bool becomes, const std::string& remark) {
  trace_.line(fmt::format("saved {} {}", saved.lines_changed, saved.path));
  if (becomes) {
    document_path_ = saved.path;
    deck_ = saved.path;
  }
  std::string text = fmt::format("Saved {}: {} lines changed.", saved.path, saved.lines_changed);
  if (!remark.empty()) text += " " + remark;
  for (const std::string& note : saved.notes) text += "\n" + note;
  say(saved.notes.empty() ? Notice::Kind::information : Notice::Kind::warning, std::move(text));
  stale_ = true;
  ask_state();
}

void ModelLink::edit(mesh::document::Edit edit) {
  const bool selecting = is_selecting(mesh::document::name(edit));
  if (client_) ++edits_;
  ask(ipc::ApplyEdit{std::move(edit)}, [this, selecting](const ipc::Answer& answer) {
    --edits_;
    busy_.clear();
    if (const auto* failed = std::get_if<ipc::Failed>(&answer)) return say_failed(*failed, "the model is as it was");
    const auto* edited = std::get_if<ipc::Edited>(&answer);
    if (edited == nullptr) return;
    if (!fetched_ || !snapshot_ || snapshot_->info().generation != edited->generation) stale_ = true;
    if (!selecting) say_report(edited->report);  // what a selection did is in the picture
  });
}

void ModelLink::share_camera(const ipc::Camera& camera) {
  if (!client_) return;
  if (const Result<std::uint64_t> sent = client_->send(ipc::ShareCamera{camera}); !sent) lost(sent.error());
}

void ModelLink::stop(bool keep) {
  if (client_ && long_ > 0) ask(ipc::Cancel{keep}, [](const ipc::Answer&) {});  // the answer doesn't matter: it may be over already
}

void ModelLink::begin_drag(mesh::document::Edit edit) {
  drag_.emplace(edit);
  ask(ipc::BeginDrag{std::move(edit)}, [this](const ipc::Answer& answer) { drag_began(answer); });
  if (!client_) drag_.reset();
}

void ModelLink::drag_began(const ipc::Answer& answer) {
  if (const auto* failed = std::get_if<ipc::Failed>(&answer)) {
    say(Notice::Kind::error, text_of(*failed));
    return drop_drag("refused");
  }
  const auto* begun = std::get_if<ipc::DragBegun>(&answer);
  if (begun == nullptr || !drag_) return;
  Result<ipc::PreviewReader> reader = client_->take_preview(*begun);
  drag_->begun_ = *begun;
  if (!reader) {
    say(Notice::Kind::error, reader.error().text());
    drag_->wish_ = RemoteDrag::Wish::cancel;
    return;
  }
  drag_->reader_ = std::move(*reader);
  trace_.line(fmt::format("drag begun {} nodes {} grab {}", begun->drag, begun->nodes, begun->grab));
}

void ModelLink::pull(const mesh::document::Displacement& displacement) {
  if (!drag_ || drag_->wish_ != RemoteDrag::Wish::hold) return;
  const mesh::document::Displacement& before = drag_->wanted_;
  if (before.by == displacement.by && before.distance == displacement.distance && before.degrees == displacement.degrees) return;
  drag_->wanted_ = displacement;
  drag_->moved_ = true;
}

void ModelLink::count(const std::string& expr, mesh::select::EntityKind kind) {
  to_count_ = Count{expr, kind, std::nullopt, std::nullopt};
  ask_count();
}

void ModelLink::ask_count() {
  if (!client_ || counting_ || !to_count_) return;
  Count what = *std::exchange(to_count_, std::nullopt);
  counting_ = true;
  ask(ipc::Count{what.expr, what.kind}, [this, what](const ipc::Answer& answer) mutable {
    counting_ = false;
    if (const auto* failed = std::get_if<ipc::Failed>(&answer)) what.failed = *failed;
    if (const auto* counted = std::get_if<ipc::Counted>(&answer)) what.counted = *counted;
    trace_.line(fmt::format("counted {} {}", what.counted ? std::to_string(what.counted->nodes) : "none", what.expr));
    counted_ = std::move(what);
    ask_count();
  });
}

void ModelLink::commit_drag() {
  if (drag_ && drag_->wish_ == RemoteDrag::Wish::hold) drag_->wish_ = RemoteDrag::Wish::commit;
}

void ModelLink::cancel_drag() {
  if (drag_ && !drag_->end_sent_) drag_->wish_ = RemoteDrag::Wish::cancel;
}

void ModelLink::turn_drag() {
  RemoteDrag& drag = *drag_;
  if (!drag.begun() || drag.end_sent_) return;
  if (drag.reader_ && drag.reader_->latest(drag.frame_)) ++changes_;
  const std::uint64_t id = drag.facts().drag;
  if (drag.wish_ == RemoteDrag::Wish::cancel || (drag.wish_ == RemoteDrag::Wish::commit && drag.sequence_ == 0 && !drag.moved_)) {
    drag.end_sent_ = true;
    ask(ipc::CancelDrag{id}, [this](const ipc::Answer&) { drop_drag("cancelled"); });
    return;
  }
  const bool seen = drag.frame_.sequence >= drag.sequence_ || clock_.now_ns() - drag.sent_ns_ > kStepPatience;
  if (drag.moved_ && (seen || drag.wish_ == RemoteDrag::Wish::commit)) send_step();
  if (!client_ || !drag_ || drag_->wish_ != RemoteDrag::Wish::commit) return;
  drag.end_sent_ = true;
  ask(ipc::CommitDrag{id}, [this](const ipc::Answer& answer) {
    if (const auto* failed = std::get_if<ipc::Failed>(&answer)) {
      say(Notice::Kind::error, text_of(*failed));
      return drop_drag("refused");
    }
    const auto* edited = std::get_if<ipc::Edited>(&answer);
    if (edited == nullptr) return;
    say_report(edited->report);
    committed_drag(edited->generation);
  });
}

void ModelLink::committed_drag(std::uint64_t generation) {
  if (!drag_) return;
  // Without its preview the nodes would jump back until the generation is here.
  drag_->made_ = generation;
  if (fetched_ && snapshot_ && snapshot_->info().generation == generation)
    drop_drag("committed");
  else
    stale_ = true;
}

void ModelLink::send_step() {
  RemoteDrag& drag = *drag_;
  ipc::DragStep step;
  step.drag = drag.facts().drag;
  step.sequence = ++drag.sequence_;
  step.by = {drag.wanted_.by.x(), drag.wanted_.by.y(), drag.wanted_.by.z()};
  step.distance = drag.wanted_.distance;
  step.degrees = drag.wanted_.degrees;
  drag.moved_ = false;
  drag.sent_ns_ = clock_.now_ns();
  if (const Result<std::uint64_t> sent = client_->send(step); !sent) lost(sent.error());
}

void ModelLink::drop_drag(const char* how) {
  if (!drag_) return;
  drag_.reset();
  ++changes_;
  trace_.line(std::string("drag ") + how);
}

void ModelLink::say_failed(const ipc::Failed& failed, const std::string& if_stopped) {
  if (was_stopped(failed)) return say(Notice::Kind::information, "Stopped: " + if_stopped + ".");
  say(Notice::Kind::error, text_of(failed));
}

void ModelLink::say_report(const mesh::document::EditReport& report) {
  std::string text;
  if (is_mending(report.edit))
    text = fmt::format("{}: warn {} \u2192 {}, fail {} \u2192 {}", report.edit, report.before.warn, report.after.warn, report.before.fail,
                       report.after.fail);
  if (report.clusters_before != report.clusters_after)
    text += fmt::format("{}clusters of triangles {} \u2192 {}", text.empty() ? "" : ", ", report.clusters_before, report.clusters_after);
  for (const std::string& note : report.notes) text += (text.empty() ? "" : "\n") + note;
  if (report.mass_before && report.mass_after) {
    text += fmt::format("{}mass {} \u2192 {}", text.empty() ? "" : "\n", readable(*report.mass_before, kDigits),
                        readable(*report.mass_after, kDigits));
    if (const auto& from = report.centre_before, &to = report.centre_after; from && to)
      text += fmt::format(", centre of gravity ({}) \u2192 ({})", readable(*from, kDigits), readable(*to, kDigits));
  }
  if (text.empty()) return;
  say(Notice::Kind::information, std::move(text));
}

void ModelLink::say(Notice::Kind kind, std::string text) {
  ++changes_;
  notices_.push_back({kind, std::move(text), document_number_});
  trace_.line(notices::trace_of(notices_.back()));
}

}  // namespace prismesh::kiosk::link
