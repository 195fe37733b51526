#include "kiosk/tools/measuring/measuring_tool.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "kiosk/input/key_table.h"
#include "kiosk/panels/layout.h"
#include "kiosk/panels/text.h"
#include "kiosk/panels/widgets.h"
#include "kiosk/toolkit/open_panels.h"
#include "kiosk/toolkit/picking.h"
#include "kiosk/toolkit/tool_set.h"

namespace prismesh::kiosk::tools::measuring {
namespace {

using display::Key;
using input::KeyBinding;
using input::Menu;
using panels::PanelLayout;

constexpr std::string_view kName = "measuring";
constexpr std::size_t kOfDistance = 2, kOfAngle = 3;

enum class MeasuringCommand : std::uint8_t { distance, angle, clear };

constexpr input::Command command_of(MeasuringCommand command) { return {kName, static_cast<std::uint8_t>(command)}; }

constexpr std::array kKeys = {
    KeyBinding{Key::f4, false, false, command_of(MeasuringCommand::distance), Menu::view, "F4", "measure the distance of two nodes"},
    KeyBinding{Key::f4, false, true, command_of(MeasuringCommand::angle), Menu::view, "Shift+F4",
               "measure the angle and the radius at three nodes"},
    KeyBinding{Key::f4, true, false, command_of(MeasuringCommand::clear), Menu::view, "Ctrl+F4", "remove all measures"},
};

const KeyBinding& key_of(MeasuringCommand command) { return input::binding_of(kKeys, command_of(command)); }

}  // namespace

std::span<const KeyBinding> keys() { return kKeys; }

std::string_view MeasuringTool::name() const { return kName; }

void MeasuringTool::command(std::uint8_t number, const toolkit::Pointer&) {
  switch (static_cast<MeasuringCommand>(number)) {
    case MeasuringCommand::distance: measure(kOfDistance); break;
    case MeasuringCommand::angle: measure(kOfAngle); break;
    case MeasuringCommand::clear: clear(); break;
  }
}

/// The key of what is being measured puts the tool down.
void MeasuringTool::measure(std::size_t nodes) {
  if (!context_.shown.snapshot || context_.tools.pulling()) return;
  const bool puts_down = context_.open.in_hand == this && nodes_wanted_ == nodes;
  toolkit::take_in_hand(context_, puts_down ? nullptr : this);
  if (!puts_down) nodes_wanted_ = nodes;
}

bool MeasuringTool::leave_mode() {
  if (!in_mode()) return false;
  if (list_.give_up()) {  // the first Esc gives up the measure, the next one the tool
    ++context_.changes;
    return true;
  }
  nodes_wanted_ = 0;  // take_in_hand ends modes
  if (context_.open.in_hand == this) toolkit::take_in_hand(context_, nullptr);
  return true;
}

/// Clicks are for the tool that is in hand.
void MeasuringTool::panel_changed() {
  if (context_.open.in_hand == this || !in_mode()) return;
  nodes_wanted_ = 0;
  list_.give_up();
}

bool MeasuringTool::gesture(const input::Gesture& gesture) {
  if (!in_mode()) return false;
  const auto* node = std::get_if<input::NodeClicked>(&gesture);
  const auto* region = std::get_if<input::RegionClicked>(&gesture);
  if (node == nullptr && region == nullptr) return false;
  const auto picked = toolkit::shown_node_at(context_, node != nullptr ? node->at : region->at);
  if (!picked) return true;
  if (list_.pick(context_.shown.snapshot->node_id(picked->value), *picked, nodes_wanted_)) compute();
  ++context_.changes;
  return true;
}

void MeasuringTool::document_changed() { clear(); }

void MeasuringTool::model_changed() {
  const auto& shown = context_.shown.snapshot;
  if (!shown || (list_.all().empty() && list_.begun().ids.empty())) return;
  list_.follow([&](std::int64_t id, std::optional<mesh::NodeIndex> last) -> std::optional<mesh::NodeIndex> {
    const bool stayed = last && last->value < shown->node_count() && shown->node_id(last->value) == id;
    const auto node = stayed ? last : toolkit::node_with_id(context_, id);
    return node && toolkit::is_used(context_, *node) ? node : std::nullopt;
  });
  compute();
}

void MeasuringTool::compute() {
  const render::ModelSource* shown = context_.renderer.model();
  if (list_.all().empty() || shown == nullptr || context_.shown.older) return;
  copy_.update(*shown);
  list_.compute(copy_.model(), copy_.hidden());
}

void MeasuringTool::remove(std::size_t index) {
  list_.remove(index);
  if (list_.all().empty()) copy_.clear();
  ++context_.changes;
}

void MeasuringTool::clear() {
  list_.clear();
  copy_.clear();
  ++context_.changes;
}

// --- picture ---

void MeasuringTool::add_to_picture(render::Picture& picture) const {
  const auto& shown = context_.shown.snapshot;
  if (!shown || context_.shown.older) return;
  const auto add = [&](const Measure& measure) {
    if (measure.nodes.empty() || is_cut_away(measure)) return;
    std::vector<mesh::Vec3>& way = picture.measures.emplace_back();
    for (const mesh::NodeIndex node : measure.nodes)
      if (node.value < shown->node_count()) way.push_back(shown->position(node.value));
  };
  for (const Measure& measure : list_.all()) add(measure);
  add(list_.begun());
}

/// Whether one of its nodes is: without what it measures a line would hang in the air.
bool MeasuringTool::is_cut_away(const Measure& measure) const {
  const auto& shown = context_.shown.snapshot;
  const std::optional<render::CutPicture>& cut = context_.renderer.cut();
  if (!shown || !cut || !render::Renderer::can_cut()) return false;
  return std::ranges::any_of(measure.nodes, [&](mesh::NodeIndex node) {
    return node.value < shown->node_count() && cut->takes_away(shown->position(node.value));
  });
}

std::optional<input::Pixel> MeasuringTool::label_at(const Measure& measure) const {
  const auto& shown = context_.shown.snapshot;
  if (!shown || context_.shown.older || measure.nodes.empty() || is_cut_away(measure)) return std::nullopt;
  for (const mesh::NodeIndex node : measure.nodes)
    if (node.value >= shown->node_count()) return std::nullopt;
  const mesh::Vec3 at = measure.nodes.size() == kOfAngle
                            ? shown->position(measure.nodes[1].value)
                            : mesh::Vec3(0.5 * (shown->position(measure.nodes[0].value) + shown->position(measure.nodes[1].value)));
  return stereo::pixel_of(toolkit::aim(context_.view), at);
}

void MeasuringTool::draw_over_picture(PanelLayout& layout) {
  if (!context_.shown.snapshot) return;
  const std::string& unit = context_.shown.snapshot->info().length_unit;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const panels::Place view = layout.view();
  const auto in_view = [&](const input::Pixel& at) {
    return at.x() >= view.x && at.x() < view.right() && at.y() >= view.y && at.y() < view.bottom();
  };
  for (std::size_t i = 0; i < list_.all().size(); ++i) {
    const std::optional<input::Pixel> found = label_at(list_.all()[i]);
    const std::string label = measure_label(list_.all()[i], unit);
    if (!found || label.empty()) continue;
    for (const input::Pixel& at : toolkit::in_each_view(context_.view, *found)) {
      if (!in_view(at)) continue;
      const ImVec2 size = ImGui::CalcTextSize(label.c_str());
      const ImVec2 from(std::round(static_cast<float>(at.x()) + panels::kGrid), std::round(static_cast<float>(at.y()) - size.y / 2));
      list.AddRectFilled(ImVec2(from.x - panels::kGrid / 2, from.y), ImVec2(from.x + size.x + panels::kGrid / 2, from.y + size.y),
                         panels::kPanelColour);
      list.AddText(from, panels::kInk, label.c_str());
    }
  }
}

void MeasuringTool::trace_picture() {
  std::vector<std::string> lines;
  const std::string unit = context_.shown.snapshot ? context_.shown.snapshot->info().length_unit : "";
  for (const Measure& measure : list_.all()) {
    std::string line = "measure " + measure_title(measure) + ": " + measure_label(measure, unit);
    for (const std::string& detail : measure_details(measure, unit)) line += "; " + detail;
    lines.push_back(std::move(line));
  }
  if (lines == traced_) return;
  for (const std::string& line : lines)
    if (std::find(traced_.begin(), traced_.end(), line) == traced_.end()) context_.trace.line(line);
  if (lines.empty()) context_.trace.line("measure none");
  traced_ = std::move(lines);
}

// --- panels ---

std::string MeasuringTool::guidance() const {
  if (!in_mode()) return {};
  const std::string what = nodes_wanted_ == kOfDistance ? "Distance" : "Angle and radius";
  constexpr std::array kWhich{"first", "second", "third"};
  return fmt::format("{}: click the {} node, Esc gives up", what, kWhich[std::min<std::size_t>(list_.begun().ids.size(), 2)]);
}

std::vector<toolkit::RailEntry> MeasuringTool::rail() const {
  return {{toolkit::RailPlace::measure, "Measure", &key_of(MeasuringCommand::distance), context_.open.in_hand == this}};
}

void MeasuringTool::draw_options(panels::OptionRow& row) {
  row.toggle("distance", nodes_wanted_ == kOfDistance, key_of(MeasuringCommand::distance));
  row.toggle("angle and radius", nodes_wanted_ == kOfAngle, key_of(MeasuringCommand::angle));
  row.command("remove all", key_of(MeasuringCommand::clear));
}

std::string MeasuringTool::setting_words() const {
  return nodes_wanted_ == kOfAngle ? "Measure \u00b7 angle and radius" : "Measure \u00b7 distance";
}

void MeasuringTool::draw_panel(PanelLayout& layout) {
  const std::string& unit = context_.shown.snapshot->info().length_unit;
  panels::panel_title("Measures", "they stay, and follow the edits");
  if (list_.all().empty()) ImGui::TextWrapped("Click two nodes: their distance stays in the picture and in this list.");
  for (std::size_t i = 0; i < list_.all().size(); ++i) {
    const Measure& measure = list_.all()[i];
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::SmallButton("x")) layout.ask([this, i] { remove(i); });
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("remove this measure");
    panels::note_item(layout, "measure " + std::to_string(i + 1), measure_label(measure, unit));
    ImGui::SameLine();
    panels::elided_text(measure_label(measure, unit), ImGui::GetWindowContentRegionMax().x - ImGui::GetCursorPosX());
    ImGui::PushTextWrapPos(0);  // three ids of eight digits don't fit in a line
    ImGui::TextDisabled("%s", measure_title(measure).c_str());
    panels::note_item(layout, "measure nodes " + std::to_string(i + 1), measure_title(measure));
    ImGui::PopTextWrapPos();
    if (is_cut_away(measure)) ImGui::TextDisabled("cut away: not in the picture");
    for (const std::string& detail : measure_details(measure, unit)) ImGui::TextDisabled("%s", detail.c_str());
    ImGui::PopID();
  }
}

}  // namespace prismesh::kiosk::tools::measuring
