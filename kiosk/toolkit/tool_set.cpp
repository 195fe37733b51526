#include "kiosk/toolkit/tool_set.h"

#include <algorithm>

namespace prismesh::kiosk::toolkit {

using input::Under;

bool ToolSet::command(const input::Command& command, const Pointer& pointer) {
  const auto owner = std::find_if(all_.begin(), all_.end(), [&](const auto& tool) { return tool->name() == command.owner; });
  if (owner == all_.end()) return false;
  (*owner)->command(command.number, pointer);
  return true;
}

void ToolSet::gesture(const input::Gesture& gesture) {
  for (const bool mode : {true, false})
    for (const auto& tool : all_)
      if (tool->in_mode() == mode && tool->gesture(gesture)) return;
}

Under ToolSet::under(const input::Pixel& pixel) const {
  for (const auto& tool : all_)
    if (const Under under = tool->under(pixel); under != Under::picture) return under;
  return Under::picture;
}

Tool* ToolSet::asking() const {
  const auto asking = std::find_if(all_.begin(), all_.end(), [](const auto& tool) { return tool->question() != nullptr; });
  return asking == all_.end() ? nullptr : asking->get();
}

bool ToolSet::in_mode(const Tool* but) const {
  return std::any_of(all_.begin(), all_.end(), [&](const auto& tool) { return tool.get() != but && tool->in_mode(); });
}

bool ToolSet::leave_mode() {
  return std::any_of(all_.begin(), all_.end(), [](const auto& tool) { return tool->leave_mode(); });
}

bool ToolSet::take_back() {
  return std::any_of(all_.begin(), all_.end(), [](const auto& tool) { return tool->take_back(); });
}

void ToolSet::clear() {
  for (const auto& tool : all_) tool->clear();
}

bool ToolSet::dragging() const {
  return std::any_of(all_.begin(), all_.end(), [](const auto& tool) { return tool->dragging(); });
}

void ToolSet::cancel_gesture() {
  for (const auto& tool : all_) tool->cancel_gesture();
}

bool ToolSet::pulling() const {
  return std::any_of(all_.begin(), all_.end(), [](const auto& tool) { return tool->pulling(); });
}

void ToolSet::leave_previews() {
  for (const auto& tool : all_) tool->leave_preview();
}

bool ToolSet::allow_edit() {
  return std::all_of(all_.begin(), all_.end(), [](const auto& tool) { return tool->allow_edit(); });
}

void ToolSet::edit_begins() {
  for (const auto& tool : all_) tool->edit_begins();
}

void ToolSet::view_moved(const Pointer& pointer) {
  for (const auto& tool : all_) tool->view_moved(pointer);
}

void ToolSet::panel_changed() {
  for (const auto& tool : all_) tool->panel_changed();
}

std::string ToolSet::colours() const {
  for (const auto& tool : all_)
    if (std::string colours = tool->colours(); !colours.empty()) return colours;
  return {};
}

bool ToolSet::leave_colours() {
  return std::any_of(all_.begin(), all_.end(), [](const auto& tool) { return tool->leave_colours(); });
}

std::string ToolSet::glyphs_hidden() const {
  for (const auto& tool : all_)
    if (std::string hidden = tool->glyphs_hidden(); !hidden.empty()) return hidden;
  return {};
}

std::string ToolSet::guidance() const {
  for (const bool mode : {true, false})
    for (const auto& tool : all_)
      if (tool->in_mode() == mode)
        if (std::string guidance = tool->guidance(); !guidance.empty()) return guidance;
  return {};
}

}  // namespace prismesh::kiosk::toolkit
