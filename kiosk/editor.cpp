#include "kiosk/editor.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "kiosk/render/palette.h"
#include "mesh/select/expression.h"

namespace prismesh::kiosk {
namespace {

using mesh::document::SelectMode;
using mesh::document::VisibilityAction;
using panels::Notice;
using tools::Command;
using tools::Pixel;
using tools::Under;

constexpr double kPickRadiusPixels = 16;
constexpr double kZoomPerStep = 1.15;
constexpr std::size_t kManyShells = 200'000;

render::PixelRect rectangle_of(const Pixel& a, const Pixel& b) {
  return {std::min(a.x(), b.x()), std::min(a.y(), b.y()), std::max(a.x(), b.x()), std::max(a.y(), b.y())};
}

std::vector<std::array<double, 2>> outline_of(const render::PixelRect& rect, const display::PixelSize& size) {
  const auto x = [&](double pixel) { return 2 * pixel / size.width - 1; };
  const auto y = [&](double pixel) { return 1 - 2 * pixel / size.height; };
  return {{x(rect.x0), y(rect.y0)}, {x(rect.x1), y(rect.y0)}, {x(rect.x1), y(rect.y1)}, {x(rect.x0), y(rect.y1)}};
}

unsigned packed(const render::Colour& colour) {
  const auto byte = [](float value) { return static_cast<unsigned>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255)); };
  return 0xff000000U | byte(colour.z()) << 16 | byte(colour.y()) << 8 | byte(colour.x());
}

}  // namespace

Editor::Editor(const EditorOptions& options, ModelLink& link, render::Renderer& renderer, Clock& clock, Trace trace)
    : link_(link), renderer_(renderer), clock_(clock), trace_(trace), profile_(options.profile) {
  view_.rotation = *stereo::named_rotation("iso");
}

void Editor::set_picture_size(display::PixelSize size) {
  if (size == size_) return;
  size_ = size;
  ++changes_;
}

void Editor::look_from(const stereo::SeenFrom& seen) {
  seen_ = seen;
  const stereo::View fitted = depth_.fitted(view_, seen.between_eyes_mm, clock_.now_ns());
  if (fitted == view_) return;
  view_ = fitted;
  ++changes_;
}

void Editor::set_eyes_facts(std::optional<panels::EyesFacts> facts) {
  if (facts == eyes_facts_) return;
  eyes_facts_ = std::move(facts);
  ++changes_;
}

void Editor::set_panel(const render::PanelPlace& panel) {
  if (panel == panel_) return;
  panel_ = panel;
  ++changes_;
}

stereo::Aim Editor::aim() const { return render::aim_for(plain_picture(), size_.width, size_.height); }

// --- following the model server ---

Result<void> Editor::follow() {
  if (link_.changes() == link_changes_) return {};
  link_changes_ = link_.changes();
  ++changes_;
  follow_notices();
  if (link_.snapshot() != shown_) {
    const auto& next = link_.snapshot();
    const bool other_document = next && (!shown_ || shown_->info().document != next->info().document);
    if (Result<void> set = renderer_.set_model(next ? render::snapshot_source(next) : nullptr); !set) return set;
    shown_ = next;
    // What stays within comfortable depth is what is shown now.
    if (const stereo::Box box = renderer_.bounds(); !box.empty()) view_.bounds = stereo::sphere_around(box);
    take_model();
    if (other_document) fit();
  }
  return follow_drag();
}

void Editor::take_model() {
  if (!shown_) {
    anchor_.reset();
    last_clicked_.reset();
    selection_centre_.reset();
    return;
  }
  const std::optional<mesh::Vec3> centre = shown_->info().selected_nodes > 0 ? tools::selection_centre(*renderer_.model()) : std::nullopt;
  const bool elsewhere = centre != selection_centre_;
  selection_centre_ = centre;
  if (elsewhere && depth_.keeps_selection()) bring_selection();
  anchor_ = shown_->info().selected_nodes > 0 ? tools::anchor_of_selection(*renderer_.model(), last_clicked_) : std::nullopt;
}

/// The selection's middle goes into the plane of the screen, where both eyes see it at the same place.
void Editor::bring_selection() {
  if (selection_centre_ && profile_.stereo()) depth_.bring(*selection_centre_, clock_.now_ns());
}

Result<void> Editor::follow_drag() {
  const RemoteDrag* drag = link_.drag();
  if (drag == nullptr) {
    if (preview_shown_) renderer_.end_preview();
    preview_shown_ = false;
    preview_sequence_ = 0;
    axis_taken_ = false;
    pull_.reset();
    return {};
  }
  if (!drag->begun()) return {};
  if (pull_ && !axis_taken_) {
    const ipc::DragBegun& facts = drag->facts();
    pull_->set_axis(aim(), mesh::Vec3(facts.grab_position[0], facts.grab_position[1], facts.grab_position[2]),
                    mesh::Vec3(facts.normal[0], facts.normal[1], facts.normal[2]));
    axis_taken_ = true;
    pull_to(pulled_to_);
    if (released_early_) link_.commit_drag();
  }
  if (drag->frame().sequence == preview_sequence_) return {};
  if (!preview_shown_) renderer_.begin_preview(drag->preview().nodes(), drag->preview().shells());
  preview_shown_ = true;
  preview_sequence_ = drag->frame().sequence;
  if (Result<void> updated = renderer_.update_preview(drag->frame()); !updated) return updated;
  trace_.line(fmt::format("drag shown {} warn {} fail {}", preview_sequence_, drag->frame().counts.warn, drag->frame().counts.fail));
  return {};
}

void Editor::follow_notices() {
  for (Notice& notice : link_.take_notices()) {
    // Information gives way to anything newer; errors and warnings stay until they are read.
    while (!notices_.empty() && notices_.back().kind == Notice::Kind::information) notices_.pop_back();
    notices_.push_back(std::move(notice));
  }
}

// --- gestures ---

Under Editor::under(const Pixel& pixel) const {
  const std::optional<render::Handle> shown = shown_handle();
  return shown && !pull_ ? tools::part_of_handle(aim(), shown->at, shown->direction, pixel) : Under::picture;
}

void Editor::gesture(const tools::Gesture& gesture) {
  ++changes_;
  std::visit([this](const auto& what) { handle(what); }, gesture);
}

std::optional<mesh::NodeIndex> Editor::node_at(const Pixel& pixel) { return renderer_.node_near(aim(), pixel, kPickRadiusPixels); }

void Editor::select_nodes(const mesh::NodeSet& nodes, SelectMode mode) {
  if (nodes.empty()) return mode == SelectMode::set ? clear_selection() : void();
  std::vector<std::int64_t> ids;
  ids.reserve(nodes.size());
  for (const mesh::NodeIndex node : nodes)
    if (node.value < shown_->node_count()) ids.push_back(shown_->node_id(node.value));
  mesh::document::Select edit;
  edit.expr = mesh::select::to_expression(std::move(ids));
  edit.mode = mode;
  link_.edit(std::move(edit));
}

void Editor::clear_selection() {
  last_clicked_.reset();
  if (!shown_ || shown_->info().selected_nodes == 0) return;
  mesh::document::Select edit;
  edit.expr = "all";
  edit.mode = SelectMode::subtract;
  link_.edit(std::move(edit));
}

void Editor::handle(const tools::NodeClicked& click) {
  if (!shown_) return;
  const std::optional<mesh::NodeIndex> node = node_at(click.at);
  if (!node) {
    if (click.mode == SelectMode::set) clear_selection();
    return;
  }
  if (click.mode != SelectMode::subtract) last_clicked_ = node;
  select_nodes({*node}, click.mode);
}

void Editor::handle(const tools::RegionClicked& click) {
  if (!shown_) return;
  const std::optional<mesh::NodeIndex> node = node_at(click.at);
  if (!node || node->value >= shown_->node_count()) return;
  if (click.mode != SelectMode::subtract) last_clicked_ = node;
  mesh::document::SelectRegion edit;
  edit.at = shown_->node_id(node->value);
  edit.mode = click.mode;
  link_.edit(edit);
}

void Editor::handle(const tools::TakeBackClicked&) {
  if (shown_ && shown_->info().can_undo && is_selecting(link_.made_by())) link_.edit(mesh::document::Undo{});
}

void Editor::handle(const tools::RectangleStretched& rectangle) { rubber_band_ = rectangle_of(rectangle.from, rectangle.to); }

void Editor::handle(const tools::RectangleDone& rectangle) {
  rubber_band_.reset();
  if (!shown_) return;
  const render::PixelRect rect = rectangle_of(rectangle.from, rectangle.to);
  if (rectangle.mode == SelectMode::set) last_clicked_.reset();
  if (!through_) return select_nodes(renderer_.nodes_in(aim(), rect, false), rectangle.mode);
  mesh::document::SelectLasso edit;
  edit.outline = outline_of(rect, size_);
  const Eigen::Matrix4d clip = aim().clip_from_deck();
  std::copy_n(clip.data(), 16, edit.view.begin());  // both are column-major
  edit.mode = rectangle.mode;
  link_.edit(std::move(edit));
}

void Editor::handle(const tools::Orbited& orbit) {
  if (!pivot_found_ || orbit.from != orbit_from_) {
    // The model turns about what was under the pointer when the drag began.
    pivot_found_ = true;
    orbit_from_ = orbit.from;
    const std::optional<mesh::NodeIndex> node = shown_ ? node_at(orbit.from) : std::nullopt;
    if (node && node->value < shown_->node_count()) view_ = stereo::with_pivot(view_, shown_->position(node->value));
  }
  const double radians_per_pixel = std::numbers::pi / std::max(size_.height, 1);
  view_ = stereo::orbit(view_, orbit.dx * radians_per_pixel, -orbit.dy * radians_per_pixel);
}

void Editor::handle(const tools::Panned& pan) { view_ = stereo::pan(view_, Eigen::Vector2d(pan.dx, -pan.dy) * aim().mm_per_pixel()); }

void Editor::handle(const tools::Zoomed& zoom) {
  view_ = stereo::zoom(view_, std::pow(kZoomPerStep, zoom.steps), stereo::mm_of_pixel(aim(), zoom.at));
}

void Editor::handle(const tools::HandleTaken& taken) {
  if (!anchor_ || link_.drag() != nullptr) return;
  const stereo::Aim now = aim();
  pull_.emplace(taken.handle, anchor_->at, tools::arrow_direction(now, *anchor_), now, taken.at);
  pulled_ = {};
  pulled_to_ = taken.at;
  axis_taken_ = released_early_ = false;
  mesh::document::Shaping shaping;
  shaping.grab = anchor_->id;
  if (taken.handle == Under::move_handle) {
    mesh::document::Translate edit;
    edit.shaping = shaping;
    link_.begin_drag(edit);
  } else {
    mesh::document::Lift edit;
    edit.shaping = shaping;
    link_.begin_drag(edit);
  }
  if (link_.drag() == nullptr) pull_.reset();
}

void Editor::handle(const tools::HandleMoved& moved) {
  if (pull_) pull_to(moved.at);
}

void Editor::handle(const tools::HandleReleased& released) {
  if (!pull_) return;
  pull_to(released.at);
  if (axis_taken_)
    link_.commit_drag();
  else
    released_early_ = true;
}

void Editor::pull_to(const Pixel& pixel) {
  pulled_to_ = pixel;
  pulled_ = pull_->at(aim(), pixel);
  if (axis_taken_) link_.pull(pulled_.by, pulled_.distance);
}

void Editor::cancel_gesture() {
  rubber_band_.reset();
  cancel_pull();
  ++changes_;
}

void Editor::cancel_pull() {
  if (!pull_) return;
  pull_.reset();
  link_.cancel_drag();
  ++changes_;
}

// --- commands ---

bool Editor::command(Command command, const std::optional<Pixel>& pointer) {
  ++changes_;
  switch (command) {
    case Command::open: dialog_ = panels::Dialog::open; return true;
    case Command::save: link_.save(std::nullopt); return true;
    case Command::save_as:
      if (shown_) dialog_ = panels::Dialog::save_as;
      return true;
    case Command::undo: link_.edit(mesh::document::Undo{}); return true;
    case Command::redo: link_.edit(mesh::document::Redo{}); return true;
    case Command::cancel: cancel(); return true;
    case Command::grow: link_.edit(mesh::document::Grow{}); return true;
    case Command::shrink: link_.edit(mesh::document::Shrink{}); return true;
    case Command::invert: link_.edit(mesh::document::Invert{}); return true;
    case Command::hide: set_parts(VisibilityAction::hide, pointer); return true;
    case Command::only: set_parts(VisibilityAction::only, pointer); return true;
    case Command::show_all: show_all(); return true;
    case Command::toggle_through: through_ = !through_; return true;
    case Command::fit: fit(); return true;
    case Command::view_front: look("front"); return true;
    case Command::view_back: look("back"); return true;
    case Command::view_left: look("left"); return true;
    case Command::view_right: look("right"); return true;
    case Command::view_top: look("top"); return true;
    case Command::view_bottom: look("bottom"); return true;
    case Command::view_oblique: look("iso"); return true;
    case Command::colour_mode:
      colour_ = colour_ == render::ColourMode::parts ? render::ColourMode::quality : render::ColourMode::parts;
      return true;
    case Command::next_profile: next_profile(); return true;
    case Command::selection_to_plane: bring_selection(); return true;
    case Command::keep_selection_in_plane:
      depth_.keep_selection(!depth_.keeps_selection());
      if (depth_.keeps_selection()) bring_selection();
      return true;
    case Command::more_depth: depth_.change_percent(1); return true;
    case Command::less_depth: depth_.change_percent(-1); return true;
    case Command::wider_comfort: depth_.change_degrees(1); return true;
    case Command::narrower_comfort: depth_.change_degrees(-1); return true;
    case Command::help: help_ = !help_; return true;
    case Command::fullscreen:
    case Command::rearm: return false;
  }
  return false;
}

/// What lies on top goes first.
void Editor::cancel() {
  if (pull_ || rubber_band_) return cancel_gesture();
  if (dialog_ != panels::Dialog::none)
    dialog_ = panels::Dialog::none;
  else if (help_)
    help_ = false;
  else if (!notices_.empty())
    notices_.pop_front();
  else
    clear_selection();
}

void Editor::set_parts(VisibilityAction action, const std::optional<Pixel>& pointer) {
  if (!shown_) return;
  mesh::document::SetParts edit;
  edit.action = action;
  if (const auto shell = pointer ? renderer_.shell_at(aim(), *pointer) : std::nullopt; shell && shell->value < shown_->shell_count()) {
    const mesh::PartIndex part = shown_->shell_part(shell->value);
    if (part.value < shown_->info().parts.size()) edit.on = std::to_string(shown_->info().parts[part.value].id);
  }
  link_.edit(std::move(edit));
}

void Editor::show_all() {
  if (!shown_) return;
  std::vector<std::int64_t> hidden;
  for (const ipc::SnapshotPart& part : shown_->info().parts)
    if (part.hidden) hidden.push_back(part.id);
  if (hidden.empty()) return;
  mesh::document::SetParts edit;
  edit.action = VisibilityAction::show;
  edit.on = mesh::select::to_expression(std::move(hidden));
  link_.edit(std::move(edit));
}

void Editor::look(std::string_view view_name) {
  if (const auto rotation = stereo::named_rotation(view_name)) view_.rotation = *rotation;
  fit();
}

void Editor::fit() {
  if (renderer_.bounds().empty()) return;
  Eigen::Vector2d free = stereo::screen_size_mm(profile_, size_.width, size_.height);
  free.x() *= std::max(0.2, 1 - covered_width_ / std::max(size_.width, 1));
  view_ = renderer_.fitted(view_, free, seen_.between_eyes_mm.z());
  if (depth_.keeps_selection()) bring_selection();
  ++changes_;
}

void Editor::next_profile() {
  const auto profiles = stereo::built_in_profiles();
  const auto current = std::find_if(profiles.begin(), profiles.end(), [&](const stereo::Profile& p) { return p.name == profile_.name; });
  profile_ = current == profiles.end() || current + 1 == profiles.end() ? profiles.front() : *(current + 1);
  trace_.line("profile " + profile_.name);
}

void Editor::panel_action(const panels::PanelAction& action) {
  ++changes_;
  if (const auto* ask = std::get_if<panels::AskPart>(&action)) {
    mesh::document::SetParts edit;
    edit.action = ask->action;
    edit.on = std::to_string(ask->part);
    link_.edit(std::move(edit));
  } else if (const auto* open = std::get_if<panels::AskOpen>(&action)) {
    link_.open(open->path);
  } else if (const auto* save = std::get_if<panels::AskSaveAs>(&action)) {
    link_.save(std::filesystem::path(save->path));
  } else if (std::holds_alternative<panels::NoticeRead>(action)) {
    if (!notices_.empty()) notices_.pop_front();
  } else if (std::holds_alternative<panels::DialogClosed>(action)) {
    dialog_ = panels::Dialog::none;
  } else if (const auto* asked = std::get_if<Command>(&action)) {
    command(*asked, std::nullopt);
  }
}

// --- what is shown ---

std::optional<render::Handle> Editor::shown_handle() const {
  if (pull_) {
    const bool ring = pull_->handle() == tools::Under::move_handle;
    return render::Handle{pull_->foot(pulled_), pull_->direction(), ring ? render::Handle::Use::ring : render::Handle::Use::arrow};
  }
  if (!anchor_ || !link_.connected() || link_.drag() != nullptr) return std::nullopt;
  return render::Handle{anchor_->at, tools::arrow_direction(aim(), *anchor_), render::Handle::Use::idle};
}

bool Editor::large_model() const { return shown_ && shown_->shell_count() > kManyShells; }

/// View, eyes and display, without what stands in the picture.
render::Picture Editor::plain_picture() const {
  render::Picture picture;
  picture.view = view_;
  picture.profile = profile_;
  picture.between_eyes_mm = seen_.between_eyes_mm;
  picture.toward_right = seen_.toward_right;
  picture.eye_separation_mm = seen_.eye_separation_mm;
  picture.depth_share = seen_.depth_share;
  picture.mask_mm = seen_.mask_mm;
  picture.panel = panel_;
  return picture;
}

render::Picture Editor::picture() const {
  render::Picture picture = plain_picture();
  picture.colour = colour_;
  picture.handle = shown_handle();
  picture.rubber_band = rubber_band_;
  return picture;
}

panels::PanelData Editor::panel_data() const {
  panels::PanelData data;
  data.connected = link_.connected();
  data.socket = link_.socket().string();
  data.through = through_;
  data.colour_by_quality = colour_ == render::ColourMode::quality;
  data.profile = profile_.name;
  data.eyes = eyes_facts_;
  if (profile_.stereo()) data.depth = panels::DepthFacts{depth_.percent(), depth_.degrees(), depth_.keeps_selection()};
  data.glyphs_left_out = report_.glyphs_left_out;
  data.busy = link_.busy();
  data.busy_fraction = link_.busy_fraction();
  data.help = help_;
  data.dialog = dialog_;
  if (!notices_.empty()) {
    data.notice = notices_.front();
    data.more_notices = notices_.size() - 1;
  }
  if (!shown_) return data;
  const ipc::SnapshotInfo& info = shown_->info();
  panels::DocumentFacts& facts = data.document.emplace();
  facts.path = info.document;
  facts.nodes = shown_->node_count();
  facts.shells = shown_->shell_count();
  facts.generation = info.generation;
  facts.length_unit = info.length_unit;
  facts.target_size = info.target_size;
  if (const auto& state = link_.state()) {
    facts.length_unit_guessed = state->length_unit_guessed;
    facts.target_size_guessed = state->target_size_guessed;
  }
  facts.changed = info.changed;
  facts.selected_nodes = info.selected_nodes;
  facts.selected_shells = info.selected_shells;
  facts.counts = info.counts;
  facts.parts.reserve(info.parts.size());
  for (std::size_t i = 0; i < info.parts.size(); ++i) {
    const ipc::SnapshotPart& part = info.parts[i];
    const render::Colour& colour = render::part_colours()[render::colour_of_part(i, info.parts.size())];
    facts.parts.push_back({part.id, part.name, part.shells, packed(colour), part.hidden, part.locked});
  }
  if (pull_) {
    panels::PullFacts& pull = data.pull.emplace();
    const bool moving = pull_->handle() == Under::move_handle;
    pull.what = moving ? "Move" : "Lift";
    pull.length = moving ? pulled_.by.norm() : pull_->along_arrow(pulled_);
    if (const RemoteDrag* drag = link_.drag(); drag != nullptr && drag->begun()) {
      pull.nodes = drag->facts().nodes;
      if (drag->frame().sequence > 0) pull.counts = drag->frame().counts;
    }
  }
  return data;
}

void Editor::trace_picture() {
  if (!trace_.on()) return;
  const stereo::Aim now = aim();
  const Eigen::Matrix4d clip = now.clip_from_deck();
  std::string text = fmt::format("aim {} {}", now.width, now.height);
  for (int i = 0; i < 16; ++i) text += fmt::format(" {}", clip.data()[i]);
  if (text != traced_aim_) trace_.line(traced_aim_ = text);
  text = "handle none";
  if (const auto shown = shown_handle()) {
    const auto foot = stereo::pixel_of(now, shown->at), tip = stereo::pixel_of(now, stereo::handle_tip(now, shown->at, shown->direction));
    if (foot && tip) text = fmt::format("handle {:.1f} {:.1f} {:.1f} {:.1f}", foot->x(), foot->y(), tip->x(), tip->y());
  }
  if (text != traced_handle_) trace_.line(traced_handle_ = text);
}

}  // namespace prismesh::kiosk
