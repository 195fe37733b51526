#include "kiosk/tools/shaping/shaping_tool.h"

#include <utility>

#include <fmt/format.h>

#include "kiosk/input/key_table.h"
#include "kiosk/panels/text.h"
#include "kiosk/toolkit/open_panels.h"
#include "kiosk/toolkit/picking.h"
#include "kiosk/toolkit/tool_set.h"
#include "kiosk/tools/shaping/falloff_direction.h"
#include "kiosk/tools/shaping/handle_outline.h"
#include "kiosk/tools/shaping/shaping_keys.h"
#include "kiosk/tools/shaping/shaping_panel.h"
#include "kiosk/tools/shaping/touch_words.h"
#include "kiosk/tools/shaping/typed_number.h"

namespace prismesh::kiosk::tools::shaping {
namespace {

using input::Gesture;
using input::Under;
using panels::PanelLayout;

using Use = render::Handle::Use;

Use use_of(Under handle) {
  switch (handle) {
    case Under::slide_handle: return Use::disk;
    case Under::move_handle: return Use::ring;
    case Under::turn_handle: return Use::arc;
    default: return Use::arrow;
  }
}

/// What dragging a part of the handle does.
std::string drag_words(Under handle) {
  switch (handle) {
    case Under::slide_handle: return "drag: slide";
    case Under::move_handle: return "drag: move";
    case Under::turn_handle: return "drag: turn";
    default: return "drag: lift";
  }
}

}  // namespace

std::span<const input::KeyBinding> keys() { return kKeys; }

std::string_view ShapingTool::name() const { return kName; }

void ShapingTool::command(std::uint8_t number, const toolkit::Pointer& pointer) {
  switch (static_cast<ShapingCommand>(number)) {
    case ShapingCommand::type_number: begin_number({}, std::nullopt); break;
    case ShapingCommand::next_handle: next_handle(); break;
    case ShapingCommand::pick_axis: pick_two_nodes(TwoNodes::axis); break;
    case ShapingCommand::axis_edge: axis_from_edge(pointer); break;
    case ShapingCommand::axis_x: axis_from_deck(DeckAxis::x); break;
    case ShapingCommand::axis_y: axis_from_deck(DeckAxis::y); break;
    case ShapingCommand::axis_z: axis_from_deck(DeckAxis::z); break;
    case ShapingCommand::no_axis: set_axis(std::nullopt, "none"); break;
    case ShapingCommand::along: set_falloff(next_falloff(options_.along)); break;
    case ShapingCommand::along_nodes: pick_two_nodes(TwoNodes::falloff); break;
    case ShapingCommand::along_edge: falloff_from_edge(pointer); break;
    case ShapingCommand::along_view: set_falloff(next_falloff_of_view(options_.along, toolkit::aim(context_.view).view.rotation)); break;
    case ShapingCommand::panel: toolkit::toggle_in_hand(context_, this); break;
    default: change_option(static_cast<ShapingCommand>(number)); break;
  }
}

bool ShapingTool::gesture(const Gesture& gesture) {
  if (!in_mode()) return take_handle_gesture(gesture);
  if (const auto* node = std::get_if<input::NodeClicked>(&gesture))
    click_node(node->at);
  else if (const auto* region = std::get_if<input::RegionClicked>(&gesture))
    click_node(region->at);
  else
    return take_handle_gesture(gesture);
  return true;
}

bool ShapingTool::take_handle_gesture(const Gesture& gesture) {
  if (take_ring_gesture(gesture)) return true;
  if (const auto* taken = std::get_if<input::HandleTaken>(&gesture)) {
    if (taken->handle == Under::cut_handle) return false;
    begin_pull(taken->handle, taken->at);
    return true;
  }
  const auto* moved = std::get_if<input::HandleMoved>(&gesture);
  const auto* released = std::get_if<input::HandleReleased>(&gesture);
  if (moved == nullptr && released == nullptr) return false;
  // While a number is typed the pull waits for it.
  if (!pull_ || pull_->typed || is_typing()) return true;
  pull_to(moved != nullptr ? moved->at : released->at);
  if (released == nullptr) return true;
  if (pull_->axis_known)
    context_.link.drag.commit();
  else
    pull_->released_early = true;
  return true;
}

// --- the handle ---

Under ShapingTool::under(const input::Pixel& pixel) const {
  const std::optional<render::Handle> shown = shown_handle();
  if (!shown || pull_ || context_.tools.in_mode()) return Under::picture;
  const stereo::Aim aim = toolkit::aim(context_.view);
  const Under part = part_of_handle(aim, *shown, pixel);
  // The line is thin, and the disk may lie all around it.
  const bool free = part == Under::picture || part == Under::slide_handle;
  return free && ring_at(aim, shown_ring(), pixel) ? Under::falloff_ring : part;
}

toolkit::HandlePart ShapingTool::part_at(const input::Pixel& pixel) const {
  const std::optional<render::Handle> shown = shown_handle();
  const Under part = under(pixel);
  if (!shown || part == Under::picture) return {};
  if (part == Under::falloff_ring)
    return {ring_in_picture(toolkit::aim(context_.view), shown_ring()), "drag: how far it reaches. " + ring_words(pixel)};
  return {outline_of_part(toolkit::aim(context_.view), *shown, part), drag_words(part)};
}

std::optional<render::Handle> ShapingTool::shown_handle() const {
  render::Handle handle;
  if (pull_) {
    const HandlePull& pull = pull_->pull;
    handle.at = pull.foot(pulled_);
    handle.direction = pull.direction();
    handle.use = use_of(pull.handle());
    if (pull.axis()) handle.turn = render::Handle::Turn{pull.axis()->point, pull.axis()->direction, pulled_.degrees};
    return handle;
  }
  const link::ModelLink& link = context_.link;
  if (!anchor_ || context_.shown.older || !link.connection.connected() || link.drag.running() != nullptr || context_.tools.in_mode(this))
    return std::nullopt;
  const stereo::Aim now = toolkit::aim(context_.view);
  handle.at = anchor_->at;
  handle.direction = arrow_direction(now, *anchor_);
  if (axis_) {
    handle.turn = render::Handle::Turn{axis_->point, axis_->direction, 0};
    handle.at = ball_place(now, *axis_, anchor_->at);
  }
  return handle;
}

void ShapingTool::model_changed() {
  const auto& shown = context_.shown.snapshot;
  const bool selected = shown && shown->info().selected_nodes > 0;
  anchor_ = selected ? anchor_of_selection(*context_.renderer.model(), context_.selection.last_clicked) : std::nullopt;
  context_.follow_soon = true;
}

/// Nothing that was picked, pulled or typed on the old document goes on.
void ShapingTool::document_changed() {
  axis_.reset();
  axis_pick_.cancel();
  pulled_ = {};
  handle_ = Under::lift_handle;
  options_ = for_another_deck(std::move(options_));
  followed_.ask(std::nullopt, 0);
  ring_drag_.reset();
  if (is_typing()) toolkit::close_dialog(context_);
}

// --- picture and panels ---

void ShapingTool::add_to_picture(render::Picture& picture) const {
  picture.handle = shown_handle();
  const auto& shown = context_.shown.snapshot;
  if (const ipc::FollowedEdges* edges = picture.handle && shown ? followed_.known(shown->info().generation) : nullptr)
    picture.followed_edges = lines_of(*edges, *shown, context_.link.drag.running());
  picture.halfway_line = shown_ring();
}

// --- the ring of the falloff ---

/// The line of the last answer, unless something is pulled.
HalfwayLine ShapingTool::shown_ring() const {
  const auto& shown = context_.shown.snapshot;
  if (pull_ || !shown || is_rigid(options_) || !shown_handle()) return {};
  const ipc::FollowedEdges* answer = followed_.known(shown->info().generation);
  return answer != nullptr ? halfway_line(*answer) : HalfwayLine();
}

bool ShapingTool::take_ring_gesture(const Gesture& gesture) {
  const stereo::Aim aim = toolkit::aim(context_.view);
  if (const auto* taken = std::get_if<input::HandleTaken>(&gesture); taken != nullptr && taken->handle == Under::falloff_ring) {
    const auto foot = anchor_ ? stereo::pixel_of(aim, anchor_->at) : std::nullopt;
    if (!foot) return true;
    flat_before_ = options_.flat;
    ring_drag_.emplace(mesh::shape::Falloff{options_.profile, options_.flat, {}}, *foot, taken->at);
    return true;
  }
  if (!ring_drag_) return false;
  const auto* moved = std::get_if<input::HandleMoved>(&gesture);
  const auto* released = std::get_if<input::HandleReleased>(&gesture);
  if (moved == nullptr && released == nullptr) return false;
  if (const double flat = ring_drag_->flat_at(moved != nullptr ? moved->at : released->at); flat != options_.flat) {
    options_.flat = flat;
    ++context_.changes;
    context_.follow_soon = true;
  }
  if (released == nullptr) return true;
  ring_drag_.reset();
  context_.trace.line(fmt::format("falloff flat {:.2f}", options_.flat));
  return true;
}

/// Where the line under the pointer, or the one that is dragged, lies.
std::string ShapingTool::ring_words(const input::Pixel& at) const {
  std::string words = fmt::format("flat top {:.0f} %", 100 * options_.flat);
  if (ring_drag_ || !anchor_ || !context_.shown.snapshot) return words;
  if (const auto point = ring_at(toolkit::aim(context_.view), shown_ring(), at))
    words = "half at " + panels::length_text((*point - anchor_->at).norm(), context_.shown.snapshot->info().length_unit) + ", " + words;
  return words;
}

/// What the pull comes to touch, as long as its preview is shown.
std::string ShapingTool::touching() const {
  const link::RunningDrag* drag = context_.link.drag.running();
  if (drag == nullptr || !drag->begun() || drag->frame().sequence == 0 || !context_.shown.snapshot) return {};
  return touch_words(drag->frame().touches, context_.shown.snapshot->info());
}

std::string ShapingTool::guidance() const {
  if (!axis_pick_.active()) return touching();
  return fmt::format("{}: click the {} node, Esc gives up", picks_ == TwoNodes::axis ? "Axis" : "Direction of the falloff",
                     axis_pick_.first() ? "second" : "first");
}

void ShapingTool::trace_picture() {
  const stereo::Aim now = toolkit::aim(context_.view);
  std::string text = "handle none";
  if (const auto shown = shown_handle()) {
    const auto foot = stereo::pixel_of(now, shown->at), tip = stereo::pixel_of(now, stereo::handle_tip(now, shown->at, shown->direction));
    if (foot && tip) text = fmt::format("handle {:.1f} {:.1f} {:.1f} {:.1f}", foot->x(), foot->y(), tip->x(), tip->y());
  }
  if (text != traced_) context_.trace.line(traced_ = text);
  std::string ring = "falloff ring none";
  if (const HalfwayLine line = shown_ring(); !line.empty()) {
    const auto at = stereo::pixel_of(now, (line.front()[0] + line.front()[1]) / 2);
    ring = at ? fmt::format("falloff ring {} at {:.1f} {:.1f}", line.size(), at->x(), at->y()) : "falloff ring behind the eye";
  }
  if (ring != traced_ring_) context_.trace.line(traced_ring_ = ring);
  const auto& shown = context_.shown.snapshot;
  const ipc::FollowedEdges* edges = shown ? followed_.known(shown->info().generation) : nullptr;
  const std::uint64_t followed = edges != nullptr ? edges->edge_count : 0;
  if (std::string words = touching(); words != traced_touch_) {
    traced_touch_ = std::move(words);
    context_.trace.line(traced_touch_.empty() ? "drag touches nothing" : "drag touches: " + traced_touch_);
  }
  if (followed != traced_followed_) context_.trace.line(fmt::format("followed edges {}", traced_followed_ = followed));
}

void ShapingTool::draw_panel(PanelLayout& layout) {
  const ShapingFacts facts{options_, context_.shown.snapshot->info().length_unit, handle_};
  if (const std::optional<ShapingOptions> wanted = shaping_panel(facts, layout))
    layout.ask([this, options = *wanted] {
      options_ = options;
      context_.follow_soon = true;
    });
}

std::vector<toolkit::RailEntry> ShapingTool::rail() const {
  const auto key = [](ShapingCommand command) { return &input::binding_of(kKeys, command_of(command)); };
  const bool in_hand = context_.open.in_hand == this;
  return {{toolkit::RailPlace::pull, "Pull", key(ShapingCommand::panel), in_hand},
          {toolkit::RailPlace::turn, "Turn", key(ShapingCommand::pick_axis),
           axis_.has_value() || (axis_pick_.active() && picks_ == TwoNodes::axis)}};
}

void ShapingTool::draw_options(panels::OptionRow& row) {
  const auto key = [](ShapingCommand command) -> const input::KeyBinding& { return input::binding_of(kKeys, command_of(command)); };
  const std::string& unit = context_.shown.snapshot->info().length_unit;
  const bool grab_alone =
      options_.profile != mesh::shape::Profile::constant && options_.flat == 0 && options_.origin == mesh::shape::Origin::grab;
  row.value("moves", is_rigid(options_) ? "rigid" : "falloff", key(ShapingCommand::rigid));
  row.value("profile", std::string(mesh::shape::name(options_.profile)) + (grab_alone ? " from the grab" : ""),
            key(ShapingCommand::falloff));
  row.value("mirror",
            options_.symmetry == DeckAxis::none ? "off" : std::string(kDeckAxisNames[static_cast<std::size_t>(options_.symmetry)]),
            key(ShapingCommand::symmetry));
  row.value("free edges", std::string(name_of(options_.free_ends)), key(ShapingCommand::free_ends));
  row.value("along", options_.along.what, key(ShapingCommand::along));
  row.value("at most", options_.max_move ? panels::length_text(*options_.max_move, unit) : "no limit", key(ShapingCommand::move_limit));
  row.toggle("keep apart", options_.keep_apart, key(ShapingCommand::keep_apart));
  row.command("by number", key(ShapingCommand::type_number));
}

std::string ShapingTool::setting_words() const {
  std::string words = "Pull \u00b7 " + std::string(mesh::shape::name(options_.profile)) + " \u00b7 mirror ";
  words += options_.symmetry == DeckAxis::none ? "off" : kDeckAxisNames[static_cast<std::size_t>(options_.symmetry)];
  return options_.keep_apart ? words + " \u00b7 parts kept apart" : words;
}

PullFacts ShapingTool::pull_facts() const {
  PullFacts facts;
  facts.what = std::string(name_of(pull_->pull.handle()));
  facts.length_unit = context_.shown.snapshot->info().length_unit;
  switch (pull_->pull.handle()) {
    case Under::lift_handle: facts.length = pull_->pull.along_arrow(pulled_); break;
    case Under::turn_handle: facts.degrees = pulled_.degrees; break;
    default: facts.length = pulled_.by.norm(); break;
  }
  if (const link::RunningDrag* drag = context_.link.drag.running(); drag != nullptr && drag->begun()) facts.nodes = drag->facts().nodes;
  return facts;
}

std::string ShapingTool::live_words() const { return pull_ && context_.shown.snapshot ? pull_words(pull_facts()) : std::string(); }

std::string ShapingTool::value_at_hand() const {
  if (ring_drag_)
    return context_.hand.at ? ring_words(*context_.hand.at) + (options_.flat == 0 ? "; another profile: D" : "") : std::string();
  return dragging() && !pull_->typed && !is_typing() && context_.shown.snapshot ? pull_value(pull_facts()) : std::string();
}

void ShapingTool::draw_dialog(int, bool opened, PanelLayout& layout) {
  const bool pull = typing_.what == Typing::For::pull;
  panels::NumberFacts facts;
  const std::string mirror = options_.symmetry == DeckAxis::none
                                 ? "The mirror stands at"
                                 : fmt::format("The mirror stands at {} =", kDeckAxisNames[static_cast<std::size_t>(options_.symmetry)]);
  facts.title = pull ? std::string(name_of(handle_)) : typing_.what == Typing::For::move_limit ? "No node moves farther than" : mirror;
  facts.hint = pull ? typed_hint(handle_, typed_direction()) : "a number; nothing takes it away";
  facts.begun = typing_.begun;
  facts.problem = typing_.problem;
  if (pull) facts.at = typing_.at;
  if (const std::optional<std::string> entered = panels::number_box(facts, layout.view(), opened, entry_))
    layout.ask([this, text = *entered] { enter_number(text); });
  else if (pull && wants_preview(entry_.text))
    layout.ask([this, text = entry_.text] { preview_number(text); });
}

}  // namespace prismesh::kiosk::tools::shaping
