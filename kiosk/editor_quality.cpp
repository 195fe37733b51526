// The editor's checking and mending: errors gone to one after the other, relaxing and repairing, and operations by hand with a preview.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "kiosk/editor.h"

namespace prismesh::kiosk {
namespace {

using mesh::document::Relax;
using mesh::document::RelaxMode;
using mesh::document::Repair;
using mesh::document::Scope;
using mesh::repair::Operation;
using tools::Command;
using tools::Pixel;

std::optional<Operation> operation_of(Command command) {
  switch (command) {
    case Command::split: return Operation::split;
    case Command::collapse: return Operation::collapse;
    case Command::merge: return Operation::merge;
    case Command::swap: return Operation::swap;
    default: return std::nullopt;
  }
}

}  // namespace

QualityLink::Wish Editor::quality_wish() const { return {review_.metric, review_.damaged}; }

bool Editor::quality_command(Command command, const std::optional<Pixel>& pointer) {
  if (const auto operation = operation_of(command)) return pick_operation(*operation, pointer), true;
  switch (command) {
    case Command::quality_panel: toggle_left(LeftPanel::quality); return true;
    case Command::next_error: step_error(1); return true;
    case Command::previous_error: step_error(-1); return true;
    case Command::damaged_only:
      review_.damaged = !review_.damaged;
      leave_error();
      follow_quality();
      return true;
    case Command::relax_selection: relax(Scope::selection); return true;
    case Command::relax_part: relax(Scope::part); return true;
    case Command::relax_failed: relax(Scope::failed); return true;
    case Command::relax_from: relax_from(pointer); return true;
    case Command::repair_damaged: repair(Scope::damaged); return true;
    case Command::repair_selection: repair(Scope::selection); return true;
    case Command::repair_all: repair(Scope::all); return true;
    case Command::do_previewed: do_operation(); return true;
    default: return false;
  }
}

void Editor::relax(Scope scope) {
  Relax edit;
  edit.scope = scope;
  edit.angle = region_angle_;
  send(edit);
}

void Editor::relax_from(const std::optional<Pixel>& pointer) {
  const auto node = pointer && shown_ ? node_at(*pointer) : std::nullopt;
  if (!node || node->value >= shown_->node_count()) {
    notices_.say(panels::Notice::Kind::information, "Point at the node from which the mesh shall be relaxed.");
    return;
  }
  Relax edit;
  edit.mode = RelaxMode::from;
  edit.at = shown_->node_id(node->value);
  edit.scope = Scope::all;
  edit.angle = region_angle_;
  send(edit);
}

void Editor::repair(Scope scope) {
  Repair edit;
  edit.scope = scope;
  edit.angle = region_angle_;
  send(edit);
}

// --- figures and errors ---

/// Figures come while somebody looks at them, and for the generation that is shown.
void Editor::follow_quality() {
  follow_operation();
  if (!review_.open || !shown_) return quality_.forget();
  quality_.want(quality_wish(), shown_->info().generation);
  const ipc::Quality* figures = quality_.figures();
  if (figures == nullptr) return;
  if (const std::string text = fmt::format("quality generation {} errors {}", figures->generation, figures->error_count);
      text != traced_quality_)
    trace_.line(traced_quality_ = text);
  if (!review_.error) return;
  // An error that is there no more gives way to the one that took its place in the list.
  const auto same = std::find_if(figures->errors.begin(), figures->errors.end(),
                                 [&](const ipc::QualityError& error) { return error.shell == review_.shell; });
  if (same != figures->errors.end()) review_.error = static_cast<std::size_t>(same - figures->errors.begin());
  review_.marked = shell_with_id(review_.shell);
}

void Editor::leave_error() {
  review_.error.reset();
  review_.marked.reset();
}

void Editor::step_error(int by) {
  if (!shown_) return;
  if (!review_.open) return show_left(LeftPanel::quality);
  const ipc::Quality* figures = quality_.figures();
  if (figures == nullptr || figures->errors.empty()) return;
  const auto count = static_cast<std::ptrdiff_t>(figures->errors.size());
  std::ptrdiff_t at = 0;
  if (review_.error) {
    at = static_cast<std::ptrdiff_t>(std::min(*review_.error, figures->errors.size() - 1));
    // Where the shell was mended, the next one has its place already.
    const bool still_there = figures->errors[static_cast<std::size_t>(at)].shell == review_.shell;
    at = by > 0 && !still_there ? at : (at + by + count) % count;
  } else if (by < 0) {
    at = count - 1;
  }
  go_to_error(static_cast<std::size_t>(at));
}

void Editor::go_to_error(std::size_t error) {
  const ipc::Quality* figures = quality_.figures();
  if (figures == nullptr || error >= figures->errors.size()) return;
  const ipc::QualityError& wrong = figures->errors[error];
  review_.error = error;
  review_.shell = wrong.shell;
  review_.marked = shell_with_id(wrong.shell);
  const mesh::Vec3 at(wrong.at[0], wrong.at[1], wrong.at[2]);
  const double scale = tools::scale_to_look_at(shown_->info().target_size, view_.mm_per_unit, aim().mm_per_pixel());
  glide_.begin(at, scale, clock_.now_ns());
  trace_.line(fmt::format("error {} of {} {}", error + 1, figures->error_count, panels::error_words(wrong)));
}

std::optional<mesh::ShellIndex> Editor::shell_with_id(std::int64_t id) const {
  if (!shown_) return std::nullopt;
  for (std::size_t c = 0; c < shown_->chunk_count(ipc::SnapshotArray::shell_ids); ++c) {
    const auto ids = shown_->chunk<std::int64_t>(ipc::SnapshotArray::shell_ids, c);
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (ids[i] == id && shown_->shell(c * mesh::kChunkSize + i).node[0].valid()) return mesh::ShellIndex(c * mesh::kChunkSize + i);
  }
  return std::nullopt;
}

std::optional<panels::QualityFacts> Editor::quality_facts() const {
  if (!review_.open || !shown_) return std::nullopt;
  panels::QualityFacts facts;
  facts.figures = quality_.figures();
  facts.stale = !quality_.up_to_date(quality_wish(), shown_->info().generation);
  facts.metric = review_.metric;
  facts.damaged = review_.damaged;
  facts.error = review_.error;
  return facts;
}

bool Editor::quality_action(const panels::PanelAction& action) {
  if (const auto* metric = std::get_if<panels::ChooseMetric>(&action)) {
    review_.metric = metric->metric;
    leave_error();
    follow_quality();
  } else if (const auto* bar = std::get_if<panels::BarClicked>(&action)) {
    if (leave_older_state()) return true;
    last_region_.reset();
    last_clicked_.reset();
    quality_.select(bar->bar, quality_wish(), bar->mode);
  } else if (const auto* error = std::get_if<panels::ErrorClicked>(&action)) {
    go_to_error(error->error);
  } else {
    return false;
  }
  return true;
}

// --- operations by hand ---

void Editor::pick_operation(Operation operation, const std::optional<Pixel>& pointer) {
  if (!shown_ || pull_) return;
  leave_operation();
  by_hand_.operation = operation;
  trace_.line("operation " + std::string(name(operation)));
  if (pointer) operation_clicked(*pointer);
}

/// The first click shows what would be done, a second one on the same place does it.
void Editor::operation_clicked(const Pixel& at) {
  if (!pickable(at)) return;
  const auto shell = shown_ ? renderer_.shell_at(aim(), at) : std::nullopt;
  const auto target = shell ? tools::hand_target(*renderer_.model(), aim(), *by_hand_.operation, *shell, at) : std::nullopt;
  if (!target) return;
  if (by_hand_.target == target && quality_.previewed() && quality_.previewed()->would) return do_operation();
  by_hand_.target = target;
  mesh::document::Restructure edit;
  edit.operation = *by_hand_.operation;
  for (const mesh::ShellIndex each : target->shells) edit.at.push_back(fmt::format("shell:{}", shown_->shell_id(each.value)));
  for (const mesh::NodeIndex each : target->nodes) edit.at.push_back(fmt::format("node:{}", shown_->node_id(each.value)));
  by_hand_.edit = edit;
  by_hand_.generation = shown_->info().generation;
  quality_.preview(edit);
}

void Editor::do_operation() {
  if (!by_hand_.edit || !quality_.previewed() || !quality_.previewed()->would) return;
  send(*by_hand_.edit);
  // What was seen before stays to be seen until it is so.
  const std::uint64_t generation = by_hand_.generation;
  if (std::exchange(by_hand_.shown, 0) != 0) preview_kept_ = generation;
  leave_operation_picked();
}

void Editor::leave_operation() {
  if (by_hand_.shown != 0 || std::exchange(preview_kept_, std::nullopt)) renderer_.end_preview();
  leave_operation_picked();
}

void Editor::leave_operation_picked() {
  if (by_hand_.operation) trace_.line("operation none");
  by_hand_ = {};
  quality_.forget_preview();
}

/// Shows the preview when it has come; one of another generation would lie about this one.
void Editor::follow_operation() {
  const bool in_doubt = link_.editing() || !link_.up_to_date();
  if (preview_kept_ && !(shown_ && shown_->info().generation == *preview_kept_ && in_doubt)) {
    preview_kept_.reset();
    renderer_.end_preview();
  }
  if (!by_hand_.edit) return;
  if (!shown_ || shown_->info().generation != by_hand_.generation) return leave_operation();
  const auto& previewed = quality_.previewed();
  if (!previewed || previewed->number == by_hand_.shown) return;
  if (by_hand_.shown != 0) renderer_.end_preview();
  by_hand_.shown = previewed->number;
  if (!previewed->would) {
    trace_.line("operation refused " + previewed->problem);
    return;
  }
  render::MeshChange change;
  for (const auto& point : previewed->would->points) change.points.emplace_back(point[0], point[1], point[2]);
  for (const ipc::PreviewedShell& shell : previewed->would->shells) {
    if (shell.corners.size() != 4) continue;
    change.corners.push_back({shell.corners[0], shell.corners[1], shell.corners[2], shell.corners[3]});
    change.states.push_back({static_cast<std::uint16_t>(shell.warn), static_cast<std::uint16_t>(shell.fail)});
  }
  for (const std::int64_t id : previewed->would->replaced)
    if (const auto shell = shell_with_id(id)) change.replaced.push_back(*shell);
  if (const Result<void> done = renderer_.show_change(change); !done) notices_.say(panels::Notice::Kind::error, done.error().text());
  const mesh::document::EditReport& report = previewed->would->report;
  trace_.line(
      fmt::format("operation previewed shells {} warn {} fail {}", previewed->would->shell_count, report.after.warn, report.after.fail));
}

std::string Editor::operation_words() const {
  const std::string what(name(*by_hand_.operation));
  if (!by_hand_.edit) return what + ": click a shell or next to an edge, Esc gives up";
  std::string at;
  for (const std::string& each : by_hand_.edit->at) at += (at.empty() ? " " : ", ") + each;
  const auto& previewed = quality_.previewed();
  if (!previewed) return what + at + " ..";
  if (!previewed->would) return what + at + ": " + previewed->problem + "   (another click, or Esc)";
  const mesh::document::EditReport& report = previewed->would->report;
  return fmt::format("{}{}: warn {} \u2192 {}, fail {} \u2192 {}   Enter or a click does it, Esc not", what, at, report.before.warn,
                     report.after.warn, report.before.fail, report.after.fail);
}

}  // namespace prismesh::kiosk
