#include "kiosk/tools/welding/welding_tool.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

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
#include "kiosk/toolkit/edits.h"
#include "kiosk/toolkit/open_panels.h"
#include "kiosk/toolkit/picking.h"
#include "kiosk/toolkit/tool_set.h"

namespace prismesh::kiosk::tools::welding {
namespace {

using display::Key;
using input::KeyBinding;
using input::Menu;
using input::Pixel;
using input::Under;
using mesh::Vec3;
using panels::PanelLayout;
using toolkit::Pointer;

constexpr std::string_view kName = "welding";
constexpr double kDefaultPitchInSides = 5;
constexpr double kGrabPixels = 9;    ///< how near the pointer must be to a weld to take it
constexpr double kPlacePixels = 90;  ///< a shell's side in the picture, when the view goes to a weld
constexpr std::size_t kMaxWeldsDrawn = 2000;
constexpr std::size_t kRowsOfFindings = 10;
constexpr int kDigits = 3;

enum class WeldingCommand : std::uint8_t { take_in_hand, pitch, diameter, next, previous, repair };

constexpr input::Command command_of(WeldingCommand command) { return {kName, static_cast<std::uint8_t>(command)}; }

constexpr std::array kKeys = {
    KeyBinding{Key::f7, false, false, command_of(WeldingCommand::take_in_hand), Menu::mesh, "F7",
               "weld along a flange; list what is wrong with welds"},
    KeyBinding{Key::f7, false, true, command_of(WeldingCommand::pitch), Menu::mesh, "Shift+F7", "type how far apart welds are (pitch)"},
    KeyBinding{Key::f7, true, false, command_of(WeldingCommand::diameter), Menu::mesh, "Ctrl+F7",
               "type the diameter of welds that are like no other"},
    KeyBinding{Key::f8, false, false, command_of(WeldingCommand::next), Menu::mesh, "F8", "go to the next weld with a fault",
               input::kRepeats},
    KeyBinding{Key::f8, false, true, command_of(WeldingCommand::previous), Menu::mesh, "Shift+F8", "back to the weld before",
               input::kRepeats},
    KeyBinding{Key::f8, true, false, command_of(WeldingCommand::repair), Menu::mesh, "Ctrl+F8", "put loose ends of welds back onto sheets",
               input::kAsksForEdit},
};

const KeyBinding& key_of(WeldingCommand command) { return input::binding_of(kKeys, command_of(command)); }

/// One with two digits, so that it reads well.
double rounded_pitch(double pitch) {
  const double step = std::pow(10, std::floor(std::log10(pitch)) - 1);
  return std::round(pitch / step) * step;
}

}  // namespace

std::span<const KeyBinding> keys() { return kKeys; }

std::string_view WeldingTool::name() const { return kName; }

void WeldingTool::command(std::uint8_t number, const Pointer&) {
  if (!context_.shown.snapshot || context_.tools.pulling() || drag_) return;
  const auto type = [this](Typed what) {
    if (context_.open.in_hand != this) toolkit::take_in_hand(context_, this);
    const std::optional<double> now = what == Typed::pitch ? std::optional(pitch()) : diameter_;
    begun_ = now ? readable(*now, 6) : std::string();
    problem_.clear();
    toolkit::open_dialog(context_, this, static_cast<int>(what));
  };
  switch (static_cast<WeldingCommand>(number)) {
    case WeldingCommand::take_in_hand: toolkit::toggle_in_hand(context_, this); break;
    case WeldingCommand::pitch: type(Typed::pitch); break;
    case WeldingCommand::diameter: type(Typed::diameter); break;
    case WeldingCommand::next: step(1); break;
    case WeldingCommand::previous: step(-1); break;
    case WeldingCommand::repair: repair(); break;
  }
}

// --- what would be made ---

double WeldingTool::pitch() const {
  if (pitch_) return *pitch_;
  const double side = context_.shown.snapshot ? context_.shown.snapshot->info().target_size : 1;
  return std::isfinite(side) && side > 0 ? rounded_pitch(kDefaultPitchInSides * side) : 1;
}

mesh::document::Weld WeldingTool::edit() const {
  mesh::document::Weld weld;
  weld.flange.emplace().at = wanted_->node;
  weld.pitch = pitch();
  if (diameter_)
    weld.diameter = diameter_;
  else
    weld.like = "nearest";
  return weld;
}

void WeldingTool::ask() {
  if (!wanted_) return;
  if (wanted_->asking) {
    wanted_->changed = true;
    return;
  }
  wanted_->asking = true;
  wanted_->changed = false;
  preview_.ask(edit());
}

void WeldingTool::set_pitch(double pitch) {
  if (!std::isfinite(pitch) || !(pitch > 0) || pitch_ == pitch) return;
  pitch_ = pitch;
  ++context_.changes;
  ask();
}

/// Shows what would be made along the flange there.
void WeldingTool::click(const Pixel& at) {
  const auto node = toolkit::shown_node_at(context_, at);
  if (!node || context_.shown.older) return;
  context_.tools.leave_previews();
  wanted_.emplace();
  wanted_->node = context_.shown.snapshot->node_id(node->value);
  wanted_->generation = context_.shown.snapshot->info().generation;
  ++context_.changes;
  ask();
}

bool WeldingTool::carry_out_preview() {
  if (!is_shown() || wanted_->asking) return false;
  const mesh::document::Weld weld = edit();
  forget();
  toolkit::send(context_, weld);
  return true;
}

void WeldingTool::forget() {
  drag_.reset();
  if (!wanted_) return;
  wanted_.reset();
  preview_.forget();
  ++context_.changes;
  context_.trace.line("weld none");
}

void WeldingTool::leave_preview() { forget(); }

void WeldingTool::take_answer() {
  const auto& previewed = preview_.previewed();
  if (!wanted_ || !wanted_->asking || !previewed || previewed->number == wanted_->answer) return;
  wanted_->answer = previewed->number;
  wanted_->asking = false;
  wanted_->would = previewed->would;
  wanted_->problem = previewed->problem;
  ++context_.changes;
  if (wanted_->would)
    context_.trace.line(fmt::format("weld previewed welds {} left {} pitch {} {}", wanted_->would->line_count,
                                    wanted_->would->left_out.size(), readable(pitch(), 6), like_words()));
  else
    context_.trace.line("weld refused " + wanted_->problem);
  if (wanted_->changed) ask();
}

Result<void> WeldingTool::follow() {
  if (!context_.shown.snapshot) {
    forget();
    list_.forget();
    return {};
  }
  const std::uint64_t generation = context_.shown.snapshot->info().generation;
  if (wanted_ && wanted_->generation != generation) {
    wanted_->generation = generation;  // the flange may still be there: its welds are worked out anew
    ask();
  }
  take_answer();
  if (context_.open.in_hand != this) return {};
  list_.want(generation);
  if (list_.checks() != nullptr && told_ != list_.answers()) {
    told_ = list_.answers();
    if (finding_ && *finding_ >= list_.checks()->findings.size()) finding_.reset();
    ++context_.changes;
    context_.trace.line(fmt::format("weld checks generation {} welds {} findings {}", list_.checks()->generation, list_.checks()->welds,
                                    list_.checks()->finding_count));
  }
  return {};
}

void WeldingTool::panel_changed() {
  const bool in_hand = context_.open.in_hand == this;
  if (in_hand == in_mode_) return;
  in_mode_ = in_hand;
  if (!in_hand) {
    forget();
    finding_.reset();
  }
  context_.follow_soon = true;
}

void WeldingTool::document_changed() {
  forget();
  list_.forget();
  finding_.reset();
  pitch_.reset();
}

bool WeldingTool::leave_mode() {
  if (!in_mode_) return false;
  if (wanted_) {  // the first Esc gives up the welds, the next one the tool
    forget();
    return true;
  }
  in_mode_ = false;  // take_in_hand ends modes
  finding_.reset();
  if (context_.open.in_hand == this) toolkit::take_in_hand(context_, nullptr);
  return true;
}

// --- the hand ---

std::optional<Pixel> WeldingTool::pixel_of(std::size_t line) const {
  const std::array<double, 6>& ends = wanted_->would->lines[line];
  const Vec3 middle = 0.5 * Vec3(ends[0] + ends[3], ends[1] + ends[4], ends[2] + ends[5]);
  return stereo::pixel_of(toolkit::aim(context_.view), middle);
}

std::optional<std::size_t> WeldingTool::weld_at(const Pixel& pixel) const {
  if (!in_mode_ || !is_shown() || drag_) return std::nullopt;
  for (std::size_t i = 0; i < std::min(wanted_->would->lines.size(), kMaxWeldsDrawn); ++i)
    if (const auto at = pixel_of(i); at && (*at - pixel).norm() <= kGrabPixels) return i;
  return std::nullopt;
}

Under WeldingTool::under(const Pixel& pixel) const { return weld_at(pixel) ? Under::weld : Under::picture; }

toolkit::HandlePart WeldingTool::part_at(const Pixel& pixel) const {
  const std::optional<std::size_t> weld = weld_at(pixel);
  const std::optional<Pixel> middle = weld ? pixel_of(*weld) : std::nullopt;
  if (!middle || wanted_->would->lines.size() < 2) return {};
  constexpr int kSteps = 32;
  std::vector<Pixel> rim;
  for (int step = 0; step <= kSteps; ++step) {
    const double angle = 2 * std::numbers::pi * step / kSteps;
    rim.emplace_back(*middle + kGrabPixels * Pixel(std::cos(angle), std::sin(angle)));
  }
  return {{std::move(rim)}, "drag: set the pitch"};
}

bool WeldingTool::gesture(const input::Gesture& gesture) {
  if (!in_mode_) return false;
  if (const auto* taken = std::get_if<input::HandleTaken>(&gesture)) {
    if (taken->handle != Under::weld || !is_shown()) return false;
    // The distance from the first one sets the pitch; of the first one, that from the last.
    const auto weld = weld_at(taken->at);
    const auto from = pixel_of(weld == 0 ? std::min(wanted_->would->lines.size(), kMaxWeldsDrawn) - 1 : 0);
    if (!weld || !from || (taken->at - *from).norm() < 1) return true;
    drag_ = DraggedWeld{*from, taken->at, pitch()};
    return true;
  }
  if (drag_) {
    const auto* moved = std::get_if<input::HandleMoved>(&gesture);
    const auto* released = std::get_if<input::HandleReleased>(&gesture);
    if (moved == nullptr && released == nullptr) return false;
    drag_to(moved != nullptr ? moved->at : released->at);
    if (released != nullptr) drag_.reset();
    return true;
  }
  const auto* node = std::get_if<input::NodeClicked>(&gesture);
  const auto* region = std::get_if<input::RegionClicked>(&gesture);
  if (node == nullptr && region == nullptr) return false;
  if (node != nullptr && node->takes_away) return false;
  click(node != nullptr ? node->at : region->at);
  return true;
}

/// The weld stays below the pointer: all distances grow with the one from the first weld.
void WeldingTool::drag_to(const Pixel& at) {
  const Pixel way = drag_->taken - drag_->from;
  const double share = (at - drag_->from).dot(way) / way.squaredNorm();
  const double least = 0.5 * pitch() / kDefaultPitchInSides;
  set_pitch(rounded_pitch(std::max(drag_->pitch * share, std::min(least, drag_->pitch))));
}

void WeldingTool::cancel_gesture() {
  if (!drag_) return;
  const double pitch = drag_->pitch;
  drag_.reset();
  set_pitch(pitch);
}

// --- what is wrong with welds ---

void WeldingTool::repair() {
  if (context_.open.in_hand != this) toolkit::take_in_hand(context_, this);
  const ipc::WeldChecks* checks = list_.checks();
  const bool known = checks != nullptr && context_.shown.snapshot && checks->generation == context_.shown.snapshot->info().generation &&
                     checks->finding_count == checks->findings.size();
  const auto hangs = [](const ipc::WeldFound& each) { return each.kind == "loose-end" || each.kind == "joins-nothing"; };
  if (known && std::none_of(checks->findings.begin(), checks->findings.end(), hangs))
    return context_.notices.say(notices::Notice::Kind::information, "No weld has a loose end or joins nothing.");
  toolkit::send(context_, mesh::document::RepairWelds{});
}

void WeldingTool::step(int by) {
  if (context_.open.in_hand != this) return toolkit::take_in_hand(context_, this);
  if (list_.checks() == nullptr || list_.checks()->findings.empty()) return;
  const auto count = static_cast<std::ptrdiff_t>(list_.checks()->findings.size());
  const std::ptrdiff_t from = finding_ ? static_cast<std::ptrdiff_t>(*finding_) : by > 0 ? -1 : count;
  go_to(static_cast<std::size_t>((from + by + count) % count));
}

void WeldingTool::go_to(std::size_t finding) {
  if (list_.checks() == nullptr || finding >= list_.checks()->findings.size()) return;
  const ipc::WeldFound& found = list_.checks()->findings[finding];
  const Vec3 at(found.at[0], found.at[1], found.at[2]);
  finding_ = finding;
  ++context_.changes;
  context_.trace.line(fmt::format("weld finding {} of {}: {}", finding + 1, list_.checks()->finding_count, found.words));
  if (!at.allFinite()) return;
  toolkit::PictureView& view = context_.view;
  const double scale = toolkit::scale_to_look_at(context_.shown.snapshot->info().target_size, view.view.mm_per_unit,
                                                 toolkit::aim(view).mm_per_pixel(), kPlacePixels);
  view.glide.begin(at, scale, context_.clock.now_ns());
}

// --- picture and panels ---

void WeldingTool::add_to_picture(render::Picture& picture) const {
  if (context_.shown.older) return;
  if (is_shown())
    for (std::size_t i = 0; i < std::min(wanted_->would->lines.size(), kMaxWeldsDrawn); ++i) {
      const std::array<double, 6>& ends = wanted_->would->lines[i];
      picture.measures.push_back({Vec3(ends[0], ends[1], ends[2]), Vec3(ends[3], ends[4], ends[5])});
    }
  if (finding_ && list_.checks() != nullptr && *finding_ < list_.checks()->findings.size() && context_.open.in_hand == this) {
    const std::array<double, 3>& at = list_.checks()->findings[*finding_].at;
    picture.marked_point = Vec3(at[0], at[1], at[2]);
  }
}

std::string WeldingTool::pitch_words() const {
  return context_.shown.snapshot ? panels::length_text(pitch(), context_.shown.snapshot->info().length_unit) : std::string();
}

/// What the welds are like, as the newest answer says.
std::string WeldingTool::like_words() const {
  if (diameter_ && context_.shown.snapshot)
    return "diameter " + panels::length_text(*diameter_, context_.shown.snapshot->info().length_unit);
  if (is_shown())
    for (const std::string& note : wanted_->would->report.notes)
      if (note.starts_with("like ")) return note;
  return "like the nearest weld";
}

std::string WeldingTool::guidance() const {
  if (!in_mode_) return {};
  if (!wanted_ && finding_ && list_.checks() != nullptr)
    return list_.checks()->findings[*finding_].words + "   (F8 the next one, Ctrl+F8 repairs)";
  if (!wanted_) return "Weld: click a node on a flange, Esc puts the tool down";
  if (wanted_->asking && !wanted_->would) return "Weld: looking for the flange ..";
  if (!wanted_->would) return wanted_->problem + "   (another click, or Esc)";
  return fmt::format(
      "{}, {} apart: Enter makes them, drag one to set the pitch, Esc not",
      counted(wanted_->would->report.welded ? wanted_->would->report.welded->welds_added : wanted_->would->line_count, "weld"),
      pitch_words());
}

std::string WeldingTool::live_words() const {
  if (!drag_ || !is_shown()) return {};
  return fmt::format("Pitch {}, {}", pitch_words(), counted(wanted_->would->line_count, "weld"));
}

std::string WeldingTool::value_at_hand() const { return drag_ && is_shown() ? pitch_words() : std::string(); }

std::vector<toolkit::RailEntry> WeldingTool::rail() const {
  return {{toolkit::RailPlace::weld, "Weld", &key_of(WeldingCommand::take_in_hand), context_.open.in_hand == this}};
}

void WeldingTool::draw_options(panels::OptionRow& row) {
  row.value("pitch", pitch_words(), key_of(WeldingCommand::pitch));
  row.value("new welds", like_words(), key_of(WeldingCommand::diameter));
  row.command("next fault", key_of(WeldingCommand::next));
  row.command("repair", key_of(WeldingCommand::repair));
}

std::string WeldingTool::setting_words() const { return "Weld \u00b7 pitch " + pitch_words(); }

void WeldingTool::draw_panel(PanelLayout& layout) {
  panels::panel_title("Weld", "along the flange that is clicked");
  panels::setting("pitch", pitch_words(), key_of(WeldingCommand::pitch), layout);
  panels::setting("new welds", like_words(), key_of(WeldingCommand::diameter), layout);
  if (is_shown()) {
    const ipc::EditPreviewed& would = *wanted_->would;
    panels::section("These welds");
    panels::fact("would be made", panels::grouped(would.line_count));
    panels::note_item(layout, "welds previewed", panels::grouped(would.line_count));
    if (!would.left_out.empty()) {
      panels::fact("left out", panels::grouped(would.left_out.size()));
      ImGui::TextWrapped("the first: %s", panels::printable(would.left_out.front().why).c_str());
    }
    for (const std::string& note : would.report.notes)
      if (note.find("isn't among the parts") != std::string::npos) ImGui::TextWrapped("%s", panels::printable(note).c_str());
  } else if (wanted_ && !wanted_->problem.empty()) {
    ImGui::TextWrapped("%s", panels::printable(wanted_->problem).c_str());
  }
  panels::section("Welds of the model");
  if (!list_.problem().empty()) ImGui::TextWrapped("%s", panels::printable(list_.problem()).c_str());
  const ipc::WeldChecks* checks = list_.checks();
  if (checks == nullptr) {
    ImGui::TextDisabled("%s", list_.asking() ? "looking .." : "not looked at");
    return;
  }
  const bool stale = checks->generation != context_.shown.snapshot->info().generation && !list_.asking();
  const std::string words =
      counted(checks->welds, "weld") + ", " + (checks->finding_count == 0 ? "no fault" : counted(checks->finding_count, "fault"));
  ImGui::TextDisabled("%s%s", words.c_str(), stale ? " (of an older state)" : "");
  panels::note_item(layout, "welds", words);
  if (stale && ImGui::SmallButton("look again")) layout.ask([this] { list_.want(context_.shown.snapshot->info().generation, true); });
  if (checks->findings.empty()) return;
  const float height = ImGui::GetTextLineHeightWithSpacing() * static_cast<float>(std::min(checks->findings.size(), kRowsOfFindings));
  ImGui::BeginChild("faults", ImVec2(0, height + panels::kGrid / 2));
  for (std::size_t i = 0; i < checks->findings.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    const float left = ImGui::GetCursorPosX();
    if (ImGui::Selectable("##fault", finding_ == i)) layout.ask([this, i] { go_to(i); });
    const std::string fault = panels::printable(checks->findings[i].words);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", fault.c_str());
    panels::note_item(layout, "weld fault " + std::to_string(i + 1), fault);
    ImGui::PopID();
    ImGui::SameLine();
    ImGui::SetCursorPosX(left);
    panels::elided_text(fault, ImGui::GetWindowContentRegionMax().x - ImGui::GetCursorPosX());
  }
  ImGui::EndChild();
}

void WeldingTool::draw_dialog(int kind, bool opened, PanelLayout& layout) {
  const auto what = static_cast<Typed>(kind);
  panels::NumberFacts facts;
  facts.title = what == Typed::pitch ? "Welds are apart by (pitch)" : "Diameter of welds that are like no other";
  facts.hint = what == Typed::pitch ? "a length in the deck's unit; nothing: five sides of a shell"
                                    : "a length in the deck's unit, in LS-DYNA decks; nothing: like the nearest weld";
  facts.begun = begun_;
  facts.problem = problem_;
  const std::optional<std::string> entered = panels::number_box(facts, layout.view(), opened, entry_);
  if (!entered) return;
  layout.ask([this, what, text = *entered] {
    std::optional<double> typed;
    if (!input::is_blank(text)) {
      const Result<std::vector<double>> numbers = input::parse_numbers(text);
      if (!numbers || numbers->size() != 1 || !(numbers->front() > 0)) {
        problem_ = numbers ? "type one length greater than 0, or nothing" : numbers.error().message;
        return;
      }
      typed = numbers->front();
    }
    (what == Typed::pitch ? pitch_ : diameter_) = typed;
    toolkit::close_dialog(context_);
    ++context_.changes;
    ask();
  });
}

}  // namespace prismesh::kiosk::tools::welding
