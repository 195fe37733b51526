#include "kiosk/tools/cutting/cutting_tool.h"

#include <array>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

#include "base/counted.h"
#include "base/readable_number.h"
#include "kiosk/input/key_table.h"
#include "kiosk/input/typed_numbers.h"
#include "kiosk/panels/layout.h"
#include "kiosk/panels/number_box.h"
#include "kiosk/panels/text.h"
#include "kiosk/panels/widgets.h"
#include "kiosk/toolkit/open_panels.h"
#include "kiosk/toolkit/picking.h"
#include "kiosk/toolkit/tool_set.h"
#include "mesh/measure/cross_section.h"

namespace prismesh::kiosk::tools::cutting {
namespace {

using display::Key;
using input::KeyBinding;
using input::Menu;
using input::Under;
using mesh::Vec3;
using panels::PanelLayout;
using toolkit::Pointer;

constexpr std::string_view kName = "cutting";

enum class CuttingCommand : std::uint8_t { next_axis, flip, across_view };

constexpr input::Command command_of(CuttingCommand command) { return {kName, static_cast<std::uint8_t>(command)}; }

constexpr std::array kKeys = {
    KeyBinding{Key::f6, false, false, command_of(CuttingCommand::next_axis), Menu::view, "F6",
               "cut the model open across x, y or z (section); once more: whole"},
    KeyBinding{Key::f6, false, true, command_of(CuttingCommand::flip), Menu::view, "Shift+F6", "show the other side of the cut"},
    KeyBinding{Key::f6, true, false, command_of(CuttingCommand::across_view), Menu::view, "Ctrl+F6", "cut the model open across the view"},
};

const KeyBinding& key_of(CuttingCommand command) { return input::binding_of(kKeys, command_of(command)); }

constexpr std::array kNames{"x", "y", "z", "the view"};

}  // namespace

std::span<const KeyBinding> keys() { return kKeys; }

std::string_view CuttingTool::name() const { return kName; }

void CuttingTool::command(std::uint8_t number, const Pointer&) {
  if (!context_.shown.snapshot || context_.tools.pulling() || drag_) return;
  switch (static_cast<CuttingCommand>(number)) {
    case CuttingCommand::next_axis: next_axis(); break;
    case CuttingCommand::flip: flip(); break;
    case CuttingCommand::across_view: across_view(); break;
  }
}

// --- the plane ---

void CuttingTool::next_axis() {
  if (plane_ && plane_->across >= Across::z) {
    set_plane(std::nullopt);
    if (context_.open.in_hand == this) toolkit::take_in_hand(context_, nullptr);
    return;
  }
  CutPlane plane;
  plane.across = plane_ ? static_cast<Across>(static_cast<int>(plane_->across) + 1) : Across::x;
  plane.axis = Vec3::Unit(static_cast<int>(plane.across));
  const stereo::Box bounds = context_.renderer.bounds();
  if (plane_)
    plane.point = plane_->point;
  else
    plane.point = context_.selection.centre.value_or(bounds.empty() ? Vec3(Vec3::Zero()) : Vec3(0.5 * (bounds.low + bounds.high)));
  // What is between the eye and the plane goes away, so that the cut is seen.
  const stereo::Aim aim = toolkit::aim(context_.view);
  plane.flipped = (stereo::to_deck(aim.view, aim.eye_mm) - plane.point).dot(plane.axis) < 0;
  if (context_.open.in_hand != this) toolkit::take_in_hand(context_, this);
  set_plane(plane);
}

void CuttingTool::across_view() {
  CutPlane plane;
  plane.across = Across::view;
  const stereo::Box bounds = context_.renderer.bounds();
  plane.point = plane_ ? plane_->point
                       : context_.selection.centre.value_or(bounds.empty() ? Vec3(Vec3::Zero()) : Vec3(0.5 * (bounds.low + bounds.high)));
  plane.axis = (context_.view.view.rotation.inverse() * Vec3::UnitZ()).normalized();
  if (context_.open.in_hand != this) toolkit::take_in_hand(context_, this);
  set_plane(plane);
}

void CuttingTool::flip() {
  if (!plane_) return context_.notices.say(notices::Notice::Kind::information, "Nothing is cut: F6 cuts the model open.");
  CutPlane plane = *plane_;
  plane.flipped = !plane.flipped;
  set_plane(plane);
}

void CuttingTool::set_plane(const std::optional<CutPlane>& plane) {
  if (!plane && !plane_) return;
  plane_ = plane;
  drag_.reset();
  cut();
}

void CuttingTool::move_to(const Vec3& point) {
  if (!point.allFinite()) return;
  plane_->point = point;
  cut();
}

void CuttingTool::model_changed() {
  if (plane_) cut();
}

namespace {

/// Differ if another model, or another state of it, is shown. Empty: none is.
std::vector<std::uint64_t> versions_of(const render::ModelSource* model) {
  using ipc::SnapshotArray;
  if (model == nullptr) return {};
  std::vector<std::uint64_t> versions{model->document_key()};
  for (const SnapshotArray array : {SnapshotArray::positions, SnapshotArray::shell_nodes, SnapshotArray::shell_parts})
    for (std::size_t c = 0; c < model->chunk_count(array); ++c) versions.push_back(model->chunk_version(array, c));
  for (std::size_t p = 0; p < model->part_count(); ++p) versions.push_back(model->part_hidden(p) ? 1 : 0);
  return versions;
}

std::vector<std::array<Vec3, 2>> segments_of(const mesh::measure::CrossSection& section) {
  std::vector<std::array<Vec3, 2>> segments;
  for (const mesh::measure::SectionCurve& curve : section.curves) {
    const std::vector<Vec3>& points = curve.points;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) segments.push_back({points[i], points[i + 1]});
    if (curve.closed) segments.push_back({points.back(), points.front()});
  }
  return segments;
}

}  // namespace

void CuttingTool::look(std::int64_t) {
  if (plane_ && versions_of(context_.renderer.other()) != beside_versions_) cut();
}

void CuttingTool::cut() {
  ++context_.changes;
  length_ = 0;
  shells_ = 0;
  std::optional<render::CutPicture> picture;
  const render::ModelSource* shown = context_.renderer.model();
  if (plane_ && shown != nullptr) {
    copy_.update(*shown);
    picture = render::CutPicture{plane_->point, plane_->normal(), {}};
    const Result<mesh::measure::CrossSection> section =
        mesh::measure::cross_section(copy_.model(), {plane_->point, plane_->normal()}, copy_.hidden());
    if (section) {
      length_ = section->length;
      shells_ = section->shells;
      picture->segments = segments_of(*section);
    }
  } else {
    copy_.clear();
  }
  const render::ModelSource* other = picture ? context_.renderer.other() : nullptr;
  beside_versions_ = versions_of(other);
  if (other != nullptr) {
    beside_.update(*other);
    const auto section = mesh::measure::cross_section(beside_.model(), {plane_->point, plane_->normal()}, beside_.hidden());
    if (section) picture->beside = segments_of(*section);
  } else {
    beside_.clear();
  }
  if (const Result<void> done = context_.renderer.set_cut(std::move(picture)); !done)
    context_.notices.say(notices::Notice::Kind::error, done.error().text());
}

// --- the hand ---

Under CuttingTool::under(const input::Pixel& pixel) const {
  if (!plane_ || drag_ || context_.shown.older || context_.tools.in_mode() || context_.tools.pulling()) return Under::picture;
  return stereo::on_handle(toolkit::aim(context_.view), plane_->point, plane_->normal(), pixel) ? Under::cut_handle : Under::picture;
}

toolkit::HandlePart CuttingTool::part_at(const input::Pixel& pixel) const {
  if (under(pixel) != Under::cut_handle) return {};
  return {toolkit::arrow_line(toolkit::aim(context_.view), plane_->point, plane_->normal()), "drag: move the cut"};
}

bool CuttingTool::gesture(const input::Gesture& gesture) {
  const stereo::Aim aim = toolkit::aim(context_.view);
  if (const auto* taken = std::get_if<input::HandleTaken>(&gesture)) {
    if (taken->handle != Under::cut_handle || !plane_) return false;
    drag_ = Dragged{{aim, plane_->point, plane_->normal(), taken->at}, plane_->point};
    return true;
  }
  if (!drag_) return false;
  const auto* moved = std::get_if<input::HandleMoved>(&gesture);
  const auto* released = std::get_if<input::HandleReleased>(&gesture);
  if (moved == nullptr && released == nullptr) return false;
  drag_->distance = drag_->pull.distance(aim, moved != nullptr ? moved->at : released->at);
  move_to(drag_->pull.foot(drag_->distance));
  if (released != nullptr) drag_.reset();
  return true;
}

void CuttingTool::view_moved(const Pointer& pointer) {
  if (drag_ && pointer) drag_->pull.hold(toolkit::aim(context_.view), *pointer, drag_->distance);
}

void CuttingTool::cancel_gesture() {
  if (!drag_) return;
  const Vec3 from = drag_->from;
  drag_.reset();
  move_to(from);
}

bool CuttingTool::leave_mode() {
  if (!drag_) return false;
  cancel_gesture();
  return true;
}

bool CuttingTool::take_back() {
  if (!plane_) return false;
  set_plane(std::nullopt);
  if (context_.open.in_hand == this) toolkit::take_in_hand(context_, nullptr);
  return true;
}

// --- numbers ---

bool CuttingTool::takes_numbers(const Pointer& pointer) const { return drag_ || (pointer && under(*pointer) == Under::cut_handle); }

bool CuttingTool::begin_number(const std::string& text, const Pointer&) {
  if (!plane_) return false;
  if (drag_) cancel_gesture();
  begun_ = text;
  problem_.clear();
  toolkit::open_dialog(context_, this);
  return true;
}

void CuttingTool::draw_dialog(int, bool opened, PanelLayout& layout) {
  if (!plane_) return layout.ask([this] { toolkit::close_dialog(context_); });
  panels::NumberFacts facts;
  facts.title = fmt::format("The cut stands at {} =",
                            plane_->across == Across::view ? "the distance" : kNames[static_cast<std::size_t>(plane_->across)]);
  facts.hint = plane_->across == Across::view ? "across the view, from the deck's origin" : "one number, in the deck's length unit";
  facts.begun = begun_;
  facts.problem = problem_;
  const std::optional<std::string> entered = panels::number_box(facts, layout.view(), opened, entry_);
  if (!entered) return;
  layout.ask([this, text = *entered] {
    const Result<std::vector<double>> numbers = input::parse_numbers(text);
    if (!numbers || numbers->size() != 1) {
      problem_ = numbers ? "type one number: the place of the plane" : numbers.error().message;
      return;
    }
    toolkit::close_dialog(context_);
    move_to(plane_->point + plane_->axis * ((*numbers)[0] - plane_->place()));
  });
}

// --- picture and panels ---

void CuttingTool::add_to_picture(render::Picture& picture) const {
  if (!plane_) return;
  render::Handle arrow;
  arrow.at = plane_->point;
  arrow.direction = plane_->normal();
  arrow.use = drag_ ? render::Handle::Use::arrow : render::Handle::Use::idle;
  picture.cut_handle = arrow;
}

std::string CuttingTool::words() const {
  if (!plane_) return "nothing is cut";
  const std::string& unit = context_.shown.snapshot->info().length_unit;
  const std::string place = readable(plane_->place(), 6) + " " + unit;
  return plane_->across == Across::view ? "across the view"
                                        : fmt::format("{} = {}", kNames[static_cast<std::size_t>(plane_->across)], place);
}

std::string CuttingTool::live_words() const { return drag_ && context_.shown.snapshot ? "Cut at " + words() : std::string(); }

std::string CuttingTool::value_at_hand() const { return drag_ && context_.shown.snapshot ? words() : std::string(); }

std::string CuttingTool::setting_words() const { return "Cut \u00b7 " + words(); }

std::vector<toolkit::RailEntry> CuttingTool::rail() const {
  return {{toolkit::RailPlace::cut, "Cut", &key_of(CuttingCommand::next_axis), plane_.has_value()}};
}

void CuttingTool::draw_options(panels::OptionRow& row) {
  row.value("across", plane_ ? kNames[static_cast<std::size_t>(plane_->across)] : "nothing", key_of(CuttingCommand::next_axis));
  row.command("other side", key_of(CuttingCommand::flip));
  row.command("across the view", key_of(CuttingCommand::across_view));
  if (plane_) row.words("drag the arrow, or type a number over it");
}

void CuttingTool::draw_panel(PanelLayout& layout) {
  panels::panel_title("Cut", "what is above the plane is hidden");
  const std::string& unit = context_.shown.snapshot->info().length_unit;
  panels::setting("across", plane_ ? kNames[static_cast<std::size_t>(plane_->across)] : "nothing", key_of(CuttingCommand::next_axis),
                  layout);
  if (!plane_) return;
  panels::fact("plane", words());
  panels::fact("shells that are cut", panels::grouped(shells_));
  panels::fact("length of the curves", panels::length_text(length_, unit));
  if (shells_ == 0) ImGui::TextWrapped("The plane goes through no visible shell.");
  if (!render::Renderer::can_cut())
    ImGui::TextWrapped("This graphics driver can't cut the picture (GL_EXT_clip_cull_distance): only the curves are drawn.");
}

void CuttingTool::trace_picture() {
  std::string text = "cut none";
  if (plane_ && context_.shown.snapshot) {
    const stereo::Aim now = toolkit::aim(context_.view);
    text = fmt::format("cut {} shells {} length {:.6g}", words(), shells_, length_);
    const auto foot = stereo::pixel_of(now, plane_->point);
    const auto tip = stereo::pixel_of(now, stereo::handle_tip(now, plane_->point, plane_->normal()));
    if (foot && tip) text += fmt::format(" at {:.1f} {:.1f} {:.1f} {:.1f}", foot->x(), foot->y(), tip->x(), tip->y());
  }
  if (text != traced_ && !(traced_.empty() && text == "cut none")) context_.trace.line(text);
  traced_ = std::move(text);
}

}  // namespace prismesh::kiosk::tools::cutting
