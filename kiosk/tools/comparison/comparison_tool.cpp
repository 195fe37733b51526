#include "kiosk/tools/comparison/comparison_tool.h"

#include <algorithm>
#include <array>

#include "kiosk/input/key_table.h"
#include "kiosk/panels/gui.h"
#include "kiosk/toolkit/edits.h"
#include "kiosk/toolkit/open_panels.h"
#include "kiosk/toolkit/picking.h"
#include "kiosk/toolkit/tool_set.h"
#include "kiosk/tools/comparison/compare_panel.h"
#include "kiosk/tools/comparison/legend.h"

namespace prismesh::kiosk::tools::comparison {
namespace {

using input::KeyBinding;
using input::Menu;
using panels::PanelLayout;

using display::letter;

constexpr std::string_view kName = "comparison";

enum class ComparisonCommand : std::uint8_t { before_and_after, panel, two_views };

constexpr input::Command command_of(ComparisonCommand command) { return {kName, static_cast<std::uint8_t>(command)}; }

constexpr std::array kKeys = {
    KeyBinding{letter('C'), false, false, command_of(ComparisonCommand::before_and_after), Menu::edit, "C",
               "compare: show the state before the last edit, or after it"},
    KeyBinding{letter('C'), false, true, command_of(ComparisonCommand::panel), Menu::view, "Shift+C",
               "colours by distance and the like, two views"},
    KeyBinding{letter('C'), true, false, command_of(ComparisonCommand::two_views), Menu::view, "Ctrl+C",
               "two views side by side: before and after, or one"},
};

/// The preview of a pull is in the picture.
bool shows_pull(const link::ModelLink& link) {
  const link::RunningDrag* drag = link.drag.running();
  return drag != nullptr && drag->begun() && drag->frame().sequence > 0;
}

}  // namespace

std::span<const KeyBinding> keys() { return kKeys; }

std::string_view ComparisonTool::name() const { return kName; }

void ComparisonTool::command(std::uint8_t number, const toolkit::Pointer&) {
  switch (static_cast<ComparisonCommand>(number)) {
    case ComparisonCommand::before_and_after: before_and_after(); break;
    case ComparisonCommand::panel: toolkit::toggle_in_hand(context_, this); break;
    case ComparisonCommand::two_views: turn_two_views(); break;
  }
}

/// The state before the last edit, or the newest one again.
void ComparisonTool::before_and_after() {
  if (!context_.shown.snapshot || context_.tools.pulling()) return;
  context_.tools.leave_previews();  // they are of the newest state
  before_after_.toggle();
  context_.follow_soon = true;
}

void ComparisonTool::turn_two_views() {
  CompareWish wish = comparing_.wish();
  wish.two_views = !wish.two_views;
  // Before and after: the deck as opened stands beside the current state.
  if (const auto& state = context_.link.document.state(); wish.two_views && !wish.beside && state && !state->generations.empty())
    wish.beside = state->generations.front().number;
  set(wish);
}

void ComparisonTool::set(const CompareWish& wish) {
  context_.tools.cancel_gesture();
  ++context_.changes;
  const bool two = comparing_.two_views();
  comparing_.set(wish);
  context_.view.two_views = comparing_.two_views();
  if (two && !comparing_.two_views()) resize_view(1 / toolkit::kTwoViewsSize);
  context_.follow_soon = true;
}

bool ComparisonTool::leave_colours() {
  CompareWish wish = comparing_.wish();
  if (wish.field.empty()) return false;
  wish.field.clear();
  set(wish);
  return true;
}

bool ComparisonTool::take_back() {
  if (!before_after_.end()) return false;
  context_.follow_soon = true;
  return true;
}

/// While an older state is shown nothing is edited: the newest one is shown in its place.
bool ComparisonTool::allow_edit() {
  if (!comparing_.shows_older()) return true;
  const std::string which = before_after_.shows_before() ? "the state before " + before_after_.edit() : "an older state";
  before_after_.end();
  comparing_.show_current();
  context_.tools.cancel_gesture();
  ++context_.changes;
  context_.follow_soon = true;
  context_.notices.say(notices::Notice::Kind::information,
                       "You were looking at " + which + ". This is the newest state; nothing was edited. Ask again to edit it.");
  return false;
}

// --- following ---

Result<void> ComparisonTool::prepare() {
  const bool two = comparing_.two_views();
  before_after_.follow();
  if (Result<void> followed = comparing_.follow(); !followed) return followed;
  context_.shown.older = comparing_.shows_older();
  context_.view.two_views = comparing_.two_views();
  if (Result<void> set = set_model(); !set) return set;
  before_after_.tell();
  if (two != comparing_.two_views() && context_.shown.snapshot) resize_view(two ? 1 / toolkit::kTwoViewsSize : toolkit::kTwoViewsSize);
  return {};
}

/// Gives the renderer the state that is wanted.
Result<void> ComparisonTool::set_model() {
  const auto wanted = comparing_.model();
  if (wanted == drawn_ && (!wanted || comparing_.hidden() == drawn_hidden_)) return {};
  render::Renderer& renderer = context_.renderer;
  if (Result<void> set = renderer.set_model(wanted ? render::snapshot_source(wanted, comparing_.hidden()) : nullptr); !set) return set;
  drawn_ = wanted;
  drawn_hidden_ = comparing_.hidden();
  const auto& shown = context_.shown.snapshot;
  if (shown && context_.link.document.snapshot() == shown) toolkit::take_model(context_);
  return {};
}

/// What one looked at is looked at in both of two views, and again in the one.
void ComparisonTool::resize_view(double by) {
  context_.view.view.mm_per_unit *= by;
  context_.view.view.pan_mm *= by;
  context_.tools.view_moved();
}

// --- picture and panels ---

void ComparisonTool::add_to_picture(render::Picture& picture) const { comparing_.dress(picture, toolkit::two_views(context_.view)); }

std::vector<toolkit::RailEntry> ComparisonTool::rail() const {
  return {{toolkit::RailPlace::compare, "Compare", &input::binding_of(kKeys, command_of(ComparisonCommand::panel)),
           context_.open.in_hand == this}};
}

void ComparisonTool::draw_options(panels::OptionRow& row) {
  row.toggle("before", before_after_.shows_before(), input::binding_of(kKeys, command_of(ComparisonCommand::before_and_after)));
  row.toggle("two views", comparing_.two_views(), input::binding_of(kKeys, command_of(ComparisonCommand::two_views)));
}

std::string ComparisonTool::setting_words() const {
  const std::string& field = comparing_.wish().field;
  return std::string("Compare \u00b7 ") + (comparing_.two_views() ? "two views" : "one view") + (field.empty() ? "" : " \u00b7 " + field);
}

void ComparisonTool::draw_panel(PanelLayout& layout) {
  if (const std::optional<CompareWish> wanted = compare_panel(comparing_.facts(toolkit::two_views(context_.view)), entry_))
    layout.ask([this, wish = *wanted] { set(wish); });
}

/// The value of what is under the pointer.
void ComparisonTool::probe(LegendFacts& legend) const {
  const auto& shown = context_.shown.snapshot;
  if (!shown || comparing_.shows_older()) return;
  const std::optional<mesh::NodeIndex> node = context_.pointed.node;
  const std::optional<mesh::ShellIndex> shell = context_.pointed.shell;
  if (comparing_.coloured_by() == Comparing::Of::nodes && node && node->value < shown->node_count()) {
    legend.probed_at = "node " + std::to_string(shown->node_id(node->value));
    legend.probed = comparing_.value_of(node->value);
  } else if (comparing_.coloured_by() == Comparing::Of::shells && shell && shell->value < shown->shell_count()) {
    legend.probed_at = "shell " + std::to_string(shown->shell_id(shell->value));
    legend.probed = comparing_.value_of(shell->value);
  }
}

void ComparisonTool::draw_over_picture(PanelLayout& layout) {
  CompareFacts facts = comparing_.facts(toolkit::two_views(context_.view));
  for (LegendFacts& each : facts.legends) {
    // Of the right one of two views: in the other nothing is pulled.
    const bool model = each.pane == static_cast<std::size_t>(render::Pane::model);
    each.before_pull = shows_pull(context_.link) && model;
    if (model) probe(each);
    const DrawnLegend drawn = legend(each, layout);
    if (drawn.wanted) layout.ask([this, limits = *drawn.wanted] { comparing_.set_limits(limits); });
    layout.bottom = std::min(layout.bottom, static_cast<double>(drawn.top) - static_cast<double>(panels::kGrid));
  }
  view_captions(facts, layout.picture.width, static_cast<float>(layout.top));
}

}  // namespace prismesh::kiosk::tools::comparison
