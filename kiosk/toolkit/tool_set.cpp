#include "kiosk/toolkit/tool_set.h"

#include <algorithm>

namespace prismesh::kiosk::toolkit {

using input::Under;

void ToolSet::add(std::unique_ptr<Tool> tool) {
  abilities_.add(*tool);
  moded_.push_back({tool.get(), dynamic_cast<TakesGestures*>(tool.get()), dynamic_cast<HasMode*>(tool.get())});
  all_.push_back(std::move(tool));
}

bool ToolSet::command(const input::Command& command, const Pointer& pointer) {
  const auto owner = std::find_if(all_.begin(), all_.end(), [&](const auto& tool) { return tool->name() == command.owner; });
  if (owner == all_.end()) return false;
  (*owner)->command(command.number, pointer);
  return true;
}

void ToolSet::gesture(const input::Gesture& gesture) {
  for (const bool mode : {true, false})
    for (const Moded& each : moded_)
      if (each.gestures != nullptr && each.in_mode() == mode && each.gestures->gesture(gesture)) return;
}

/// The last tool's first: where the arrow of a cut lies on the handle of a pull, the one that only looks is taken.
const HasHandle* ToolSet::handle_at(const input::Pixel& pixel) const {
  const auto& tools = with<HasHandle>();
  for (auto tool = tools.rbegin(); tool != tools.rend(); ++tool)
    if ((*tool)->under(pixel) != Under::picture) return *tool;
  return nullptr;
}

Under ToolSet::under(const input::Pixel& pixel) const {
  const HasHandle* tool = handle_at(pixel);
  return tool != nullptr ? tool->under(pixel) : Under::picture;
}

HandlePart ToolSet::part_at(const input::Pixel& pixel) const {
  const HasHandle* tool = handle_at(pixel);
  return tool != nullptr ? tool->part_at(pixel) : HandlePart{};
}

AsksQuestions* ToolSet::asking() const {
  const auto& able = with<AsksQuestions>();
  const auto asking = std::find_if(able.begin(), able.end(), [](const AsksQuestions* tool) { return tool->question() != nullptr; });
  return asking == able.end() ? nullptr : *asking;
}

bool ToolSet::in_mode(const HasMode* but) const {
  return std::ranges::any_of(with<HasMode>(), [&](const HasMode* tool) { return tool != but && tool->in_mode(); });
}

bool ToolSet::leave_mode() { return std::ranges::any_of(with<HasMode>(), &HasMode::leave_mode); }

bool ToolSet::take_back() { return std::ranges::any_of(with<TakesBack>(), &TakesBack::take_back); }

void ToolSet::clear() {
  for (Clears* tool : with<Clears>()) tool->clear();
}

bool ToolSet::dragging() const { return std::ranges::any_of(with<Drags>(), &Drags::dragging); }

void ToolSet::cancel_gesture() {
  for (Drags* tool : with<Drags>()) tool->cancel_gesture();
}

bool ToolSet::pulling() const { return std::ranges::any_of(with<HasHandle>(), &HasHandle::pulling); }

void ToolSet::leave_previews() {
  for (Previews* tool : with<Previews>()) tool->leave_preview();
}

bool ToolSet::carry_out_preview() { return std::ranges::any_of(with<Previews>(), &Previews::carry_out_preview); }

void ToolSet::watch(std::int64_t now_ns) {
  for (Watches* tool : with<Watches>()) tool->watch(now_ns);
}

mesh::document::Shaping ToolSet::shaping(std::int64_t grab, const mesh::Vec3& middle) const {
  const auto& tools = with<SetsShaping>();
  return tools.empty() ? mesh::document::Shaping{} : tools.front()->shaping(grab, middle);
}

mesh::document::SelectRegion ToolSet::region(std::int64_t node) const {
  const auto& tools = with<SetsRegion>();
  return tools.empty() ? mesh::document::SelectRegion{} : tools.front()->region(node);
}

bool ToolSet::allow_edit() { return std::ranges::all_of(with<GuardsEdits>(), &GuardsEdits::allow_edit); }

bool ToolSet::takes_input(bool fresh) {
  return std::ranges::any_of(with<GuardsInput>(), [&](GuardsInput* tool) { return tool->takes_input(fresh); });
}

bool ToolSet::allow_command(const input::Command& command) {
  return std::ranges::all_of(with<GuardsInput>(), [&](GuardsInput* tool) { return tool->allow_command(command); });
}

std::int64_t ToolSet::next_ns(std::int64_t now_ns) const {
  std::int64_t next = -1;
  for (const Watches* tool : with<Watches>())
    if (const std::int64_t wanted = tool->next_ns(now_ns); wanted >= 0 && (next < 0 || wanted < next)) next = wanted;
  return next;
}

bool ToolSet::hold(const mesh::document::Edit& edit, bool sends) {
  return std::ranges::any_of(with<HoldsEdits>(), [&](HoldsEdits* tool) { return tool->hold(edit, sends); });
}

bool ToolSet::would_hold(const mesh::document::Edit& edit) const {
  return std::ranges::any_of(with<HoldsEdits>(), [&](const HoldsEdits* tool) { return tool->would_hold(edit); });
}

void ToolSet::edit_begins() {
  for (GuardsEdits* tool : with<GuardsEdits>()) tool->edit_begins();
}

void ToolSet::view_moved(const Pointer& pointer) {
  for (FollowsView* tool : with<FollowsView>()) tool->view_moved(pointer);
}

void ToolSet::panel_changed() {
  for (const auto& tool : all_) tool->panel_changed();
}

std::string ToolSet::colours() const {
  for (const ColoursModel* tool : with<ColoursModel>())
    if (std::string colours = tool->colours(); !colours.empty()) return colours;
  return {};
}

bool ToolSet::leave_colours() { return std::ranges::any_of(with<ColoursModel>(), &ColoursModel::leave_colours); }

std::string ToolSet::glyphs_hidden() const {
  for (const HidesGlyphs* tool : with<HidesGlyphs>())
    if (std::string hidden = tool->glyphs_hidden(); !hidden.empty()) return hidden;
  return {};
}

std::string ToolSet::guidance() const {
  for (const bool mode : {true, false})
    for (const Moded& each : moded_)
      if (each.in_mode() == mode)
        if (std::string guidance = each.tool->guidance(); !guidance.empty()) return guidance;
  return {};
}

}  // namespace prismesh::kiosk::toolkit
