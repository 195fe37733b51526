#include "kiosk/tools/quality/quality_tool.h"

#include <algorithm>

#include <fmt/format.h>

#include "kiosk/input/key_table.h"
#include "kiosk/panels/number_box.h"
#include "kiosk/toolkit/edits.h"
#include "kiosk/toolkit/open_panels.h"
#include "kiosk/toolkit/picking.h"
#include "kiosk/toolkit/tool_set.h"
#include "kiosk/tools/quality/counts_section.h"
#include "kiosk/tools/quality/quality_keys.h"
#include "kiosk/tools/quality/quality_panel.h"
#include "kiosk/tools/quality/quality_words.h"
#include "kiosk/tools/quality/set_limit.h"
#include "mesh/quality/criteria.h"

namespace prismesh::kiosk::tools::quality {

using mesh::document::Relax;
using mesh::document::RelaxMode;
using mesh::document::Repair;
using mesh::document::Scope;
using panels::PanelLayout;
using toolkit::Pointer;

std::span<const input::KeyBinding> keys() { return kKeys; }

std::string_view QualityTool::name() const { return kName; }

void QualityTool::command(std::uint8_t number, const Pointer& pointer) {
  switch (static_cast<QualityCommand>(number)) {
    case QualityCommand::panel: toolkit::toggle_in_hand(context_, this); break;
    case QualityCommand::next_error: step_error(1); break;
    case QualityCommand::previous_error: step_error(-1); break;
    case QualityCommand::damaged_only: next_glyphs(); break;
    case QualityCommand::relax_selection: relax(Scope::selection); break;
    case QualityCommand::relax_part: relax(Scope::part); break;
    case QualityCommand::relax_failed: relax(Scope::failed); break;
    case QualityCommand::relax_from: relax_from(pointer); break;
    case QualityCommand::repair_damaged: repair(Scope::damaged); break;
    case QualityCommand::repair_selection: repair(Scope::selection); break;
    case QualityCommand::repair_all: repair(Scope::all); break;
    case QualityCommand::sheet_limit: type_limit(MendLimit::sheet); break;
    case QualityCommand::line_limit: type_limit(MendLimit::line); break;
    case QualityCommand::relax_threshold: type_limit(MendLimit::threshold); break;
  }
}

// --- edits ---

void QualityTool::relax(Scope scope) {
  Relax edit;
  edit.scope = scope;
  edit.max_move = limits_.max_move;
  edit.angle = context_.selection.crease_angle;
  if (context_.keeps_apart) edit.contact = mesh::document::ContactRule::keep_apart;
  toolkit::send(context_, edit);
}

void QualityTool::relax_from(const Pointer& pointer) {
  const auto node = pointer ? toolkit::shown_node_at(context_, *pointer) : std::nullopt;
  if (!node) {
    context_.notices.say(notices::Notice::Kind::information, "Point at the node from which the mesh shall be relaxed.");
    return;
  }
  Relax edit;
  edit.mode = RelaxMode::from;
  edit.at = context_.shown.snapshot->node_id(node->value);
  edit.scope = Scope::all;
  edit.threshold = limits_.threshold;
  edit.max_move = limits_.max_move;
  edit.angle = context_.selection.crease_angle;
  if (context_.keeps_apart) edit.contact = mesh::document::ContactRule::keep_apart;
  toolkit::send(context_, edit);
}

void QualityTool::repair(Scope scope) {
  Repair edit;
  edit.scope = scope;
  edit.max_move = limits_.max_move;
  edit.angle = context_.selection.crease_angle;
  if (context_.keeps_apart) edit.contact = mesh::document::ContactRule::keep_apart;
  toolkit::send(context_, edit);
}

// --- limits ---

void QualityTool::type_limit(MendLimit which) {
  limit_problem_.clear();
  toolkit::open_dialog(context_, this, static_cast<int>(which));
}

void QualityTool::enter_limit(MendLimit which, const std::string& text) {
  const Result<MendLimits> wanted = with_limit(limits_, which, text);
  if (!wanted) {
    limit_problem_ = wanted.error().message;
    return;
  }
  limits_ = *wanted;
  toolkit::close_dialog(context_);
  const auto told = [&](MendLimit each) {
    const std::string typed = typed_limit(limits_, each);
    return typed.empty() ? std::string("none") : typed;
  };
  context_.trace.line(
      fmt::format("limits sheet {} line {} threshold {}", told(MendLimit::sheet), told(MendLimit::line), told(MendLimit::threshold)));
}

// --- figures ---

Result<void> QualityTool::follow() {
  follow_figures();
  return {};
}

/// Figures come while the panel is open, for the generation that is shown.
void QualityTool::follow_figures() {
  if (!is_open() || !context_.shown.snapshot) return link_.forget();
  link_.want(wish_, context_.shown.snapshot->info().generation);
  const ipc::Quality* figures = link_.figures();
  if (figures == nullptr) return;
  if (const std::string text = fmt::format("quality generation {} errors {}", figures->generation, figures->error_count); text != traced_)
    context_.trace.line(traced_ = text);
  if (!error_) return;
  // An error that is gone gives way to the one that took its place in the list.
  const auto same =
      std::find_if(figures->errors.begin(), figures->errors.end(), [&](const ipc::QualityError& error) { return is_the_error(error); });
  if (same != figures->errors.end()) error_ = static_cast<std::size_t>(same - figures->errors.begin());
  marked_ = toolkit::shell_with_id(context_, error_shell_);
}

void QualityTool::panel_changed() {
  if (!is_open()) leave_error();
  follow_figures();
}

/// All, only damage, none. Figures and errors are of damage in the second case, else of all.
void QualityTool::next_glyphs() {
  const bool damaged = !wish_.damaged && !without_glyphs_;
  without_glyphs_ = wish_.damaged;
  context_.trace.line("glyphs " + glyph_words());
  if (damaged == wish_.damaged) return;
  wish_.damaged = damaged;
  leave_error();
  follow_figures();
}

std::string QualityTool::glyph_words() const { return without_glyphs_ ? "none" : wish_.damaged ? "only damage" : "all"; }

void QualityTool::choose_metric(const std::string& metric) {
  wish_.metric = metric;
  leave_error();
  follow_figures();
}

void QualityTool::select_bar(const BarClicked& bar) {
  if (!context_.tools.allow_edit()) return;
  context_.selection.last_region.reset();
  context_.selection.last_clicked.reset();
  link_.select(bar.bar, wish_, bar.mode);
}

// --- errors ---

void QualityTool::leave_error() {
  error_.reset();
  marked_.reset();
}

void QualityTool::step_error(int by) {
  if (!context_.shown.snapshot) return;
  if (!is_open()) return toolkit::take_in_hand(context_, this);
  const ipc::Quality* figures = link_.figures();
  if (figures == nullptr || figures->errors.empty()) return;
  const auto count = static_cast<std::ptrdiff_t>(figures->errors.size());
  std::ptrdiff_t at = 0;
  if (error_) {
    at = static_cast<std::ptrdiff_t>(std::min(*error_, figures->errors.size() - 1));
    // If the shell was mended, the next one has its place already.
    const bool still_there = is_the_error(figures->errors[static_cast<std::size_t>(at)]);
    at = by > 0 && !still_there ? at : (at + by + count) % count;
  } else if (by < 0) {
    at = count - 1;
  }
  go_to_error(static_cast<std::size_t>(at));
}

/// The target size of a shell's part; the deck's without a shell.
double QualityTool::target_size_at(const std::optional<mesh::ShellIndex>& shell) const {
  const auto& shown = context_.shown.snapshot;
  if (!shell || shell->value >= shown->shell_count()) return shown->info().target_size;
  const mesh::PartIndex part = shown->shell_part(shell->value);
  return part.value < shown->info().parts.size() ? shown->info().parts[part.value].target_size : shown->info().target_size;
}

void QualityTool::go_to_error(std::size_t error) {
  const ipc::Quality* figures = link_.figures();
  if (figures == nullptr || error >= figures->errors.size()) return;
  const ipc::QualityError& wrong = figures->errors[error];
  error_ = error;
  error_shell_ = wrong.shell;
  error_node_ = wrong.node;
  marked_ = toolkit::shell_with_id(context_, wrong.shell);
  toolkit::PictureView& view = context_.view;
  const mesh::Vec3 at(wrong.at[0], wrong.at[1], wrong.at[2]);
  const double scale = toolkit::scale_to_look_at(target_size_at(marked_), view.view.mm_per_unit, toolkit::aim(view).mm_per_pixel());
  view.glide.begin(at, scale, context_.clock.now_ns());
  context_.trace.line(fmt::format("error {} of {} {}", error + 1, figures->error_count, error_words(wrong)));
}

// --- picture and panels ---

void QualityTool::add_to_picture(render::Picture& picture) const {
  picture.damaged_only = wish_.damaged;
  picture.quality_glyphs = picture.quality_glyphs && !without_glyphs_;
  picture.marked = marked_;
}

std::string QualityTool::glyphs_hidden() const {
  return without_glyphs_ ? "glyphs are off (Shift+J)" : wish_.damaged ? "glyphs only of what edits made worse" : "";
}

void QualityTool::act(const QualityAction& action) {
  if (const auto* metric = std::get_if<ChooseMetric>(&action))
    choose_metric(metric->metric);
  else if (const auto* bar = std::get_if<BarClicked>(&action))
    select_bar(*bar);
  else if (const auto* size = std::get_if<SizeChosen>(&action))
    toolkit::send(context_, mesh::document::SetTargetSize{size->size, std::nullopt});
  else if (const auto* criteria = std::get_if<CriteriaChosen>(&action))
    toolkit::send(context_, mesh::document::SetCriteria{criteria->criteria, std::nullopt, std::nullopt});
  else if (std::holds_alternative<CriteriaListed>(action))
    list_criteria();
  else
    go_to_error(std::get<ErrorClicked>(action).error);
}

std::optional<SizeFacts> QualityTool::size_facts(const ipc::SnapshotInfo& info) const {
  SizeFacts sizes;
  for (const ipc::SnapshotPart& part : info.parts) {
    if (part.shells == 0) continue;
    const bool first = sizes.max == 0;
    sizes.min = first ? part.target_size : std::min(sizes.min, part.target_size);
    sizes.max = std::max(sizes.max, part.target_size);
  }
  if (sizes.max == 0) return std::nullopt;
  sizes.unit = info.length_unit;
  sizes.of_selection = info.selected_nodes + info.selected_shells > 0;
  return sizes;
}

void QualityTool::list_criteria() {
  if (!context_.shown.snapshot || context_.options.exhibition) return;
  const std::filesystem::path deck = context_.shown.snapshot->info().document;
  criteria_files_ = mesh::quality::criteria_files_in(deck.parent_path());
}

/// The limits are lengths in the old deck's unit, the criteria files lie beside it.
void QualityTool::document_changed() {
  leave_error();
  limits_ = {};
  if (context_.open.dialog.owner == this) toolkit::close_dialog(context_);
  if (!criteria_files_.empty()) list_criteria();
}

void QualityTool::draw_panel(PanelLayout& layout) {
  QualityFacts facts;
  facts.figures = link_.figures();
  facts.stale = !link_.up_to_date(wish_, context_.shown.snapshot->info().generation);
  facts.metric = wish_.metric;
  facts.damaged = wish_.damaged;
  facts.glyphs = glyph_words();
  facts.error = error_;
  facts.limits = limits_;
  facts.length_unit = context_.shown.snapshot->info().length_unit;
  facts.sizes = size_facts(context_.shown.snapshot->info());
  if (facts.sizes) facts.criteria = criteria_facts(context_.shown.snapshot->info(), criteria_files_);
  for (const QualityAction& action : quality_panel(facts, layout)) layout.ask([this, action] { act(action); });
}

std::vector<toolkit::RailEntry> QualityTool::rail() const {
  return {{toolkit::RailPlace::quality, "Quality", &input::binding_of(kKeys, command_of(QualityCommand::panel)), is_open()}};
}

void QualityTool::draw_options(panels::OptionRow& row) {
  const auto key = [](QualityCommand command) -> const input::KeyBinding& { return input::binding_of(kKeys, command_of(command)); };
  row.command("<", key(QualityCommand::previous_error));
  row.command(">", key(QualityCommand::next_error));
  row.words("repair");
  row.command("damage", key(QualityCommand::repair_damaged));
  row.command("selection", key(QualityCommand::repair_selection));
  row.command("all", key(QualityCommand::repair_all));
  row.words("relax");
  row.command("nodes", key(QualityCommand::relax_selection));
  row.command("parts", key(QualityCommand::relax_part));
  row.command("failed", key(QualityCommand::relax_failed));
  row.value("glyphs", glyph_words(), key(QualityCommand::damaged_only));
}

std::string QualityTool::setting_words() const {
  return wish_.damaged ? "Quality \u00b7 only what edits made worse" : "Quality \u00b7 all shells";
}

void QualityTool::draw_status(PanelLayout&) {
  CountsFacts facts;
  facts.counts = context_.shown.snapshot->info().counts;
  facts.clusters = context_.shown.snapshot->size(ipc::SnapshotArray::clusters);
  const link::RunningDrag* drag = context_.tools.pulling() ? context_.link.drag.running() : nullptr;
  if (drag != nullptr && drag->begun() && drag->frame().sequence > 0) facts.pulled = drag->frame().counts;
  facts.hidden_glyphs = context_.tools.glyphs_hidden();
  facts.glyphs_left_out = context_.glyphs_left_out;
  counts_section(facts);
}

void QualityTool::draw_dialog(int kind, bool opened, PanelLayout& layout) {
  const auto which = static_cast<MendLimit>(kind);
  const panels::NumberFacts facts{title_of(which), hint_of(which), typed_limit(limits_, which), limit_problem_};
  if (const std::optional<std::string> entered = panels::number_box(facts, layout.view(), opened, entry_))
    layout.ask([this, which, text = *entered] { enter_limit(which, text); });
}

}  // namespace prismesh::kiosk::tools::quality
