#include "kiosk/tools/parts/part_list.h"

#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

#include "kiosk/panels/layout.h"
#include "kiosk/panels/text.h"
#include "kiosk/tools/parts/file_expression.h"
#include "kiosk/tools/parts/parts_keys.h"

namespace prismesh::kiosk::tools::parts {
namespace {

using mesh::document::VisibilityAction;
using panels::elided_text;
using panels::grouped;
using panels::kFaintInk;
using panels::kGrid;
using panels::kInk;
using panels::printable;
using Wanted = std::vector<SetVisibility>;

/// A padlock, closed or (faint) open; true when clicked.
bool lock_button(bool locked) {
  const float size = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const bool clicked = ImGui::InvisibleButton("lock", ImVec2(size, size));
  const unsigned colour = locked || ImGui::IsItemHovered() ? kInk : kFaintInk;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float x = at.x + size * 0.25f, y = at.y + size * 0.5f, w = size * 0.5f;
  list.AddRectFilled(ImVec2(x, y), ImVec2(x + w, y + size * 0.38f), colour, 1);
  const float radius = w * 0.34f, cx = x + w / 2 + (locked ? 0 : w * 0.5f);
  list.PathArcTo(ImVec2(cx, y), radius, 3.14159f, 6.28318f, 12);
  list.PathStroke(colour, 0, size * 0.1f);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip(locked ? "locked: its nodes don't move" : "lock: its nodes shall not move");
  return clicked;
}

void part_row(const PartRow& part, Wanted& wanted) {
  ImGui::PushID(static_cast<int>(part.id & 0x7fffffff));
  const float line = ImGui::GetTextLineHeight(), right = ImGui::GetWindowContentRegionMax().x;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  if (ImGui::InvisibleButton("show", ImVec2(line, line)))
    wanted.push_back({std::to_string(part.id), part.hidden ? VisibilityAction::show : VisibilityAction::hide});
  if (ImGui::IsItemHovered()) ImGui::SetTooltip(part.hidden ? "hidden: show" : "shown: hide");
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 low(at.x + line * 0.15f, at.y + line * 0.15f), high(at.x + line * 0.85f, at.y + line * 0.85f);
  if (part.hidden)
    list.AddRect(low, high, part.colour, 2, 0, 1.5f);
  else
    list.AddRectFilled(low, high, part.colour, 2);
  ImGui::SameLine();

  const float only_width = ImGui::CalcTextSize("only").x, only_x = right - line - kGrid - only_width;
  const std::string label = part.name.empty() ? fmt::format("part {}", part.id) : fmt::format("{}  {}", part.id, printable(part.name));
  const std::string shells = grouped(part.shells);
  const float shells_width = ImGui::CalcTextSize(shells.c_str()).x;
  const float name_width = only_x - kGrid - shells_width - kGrid - ImGui::GetCursorPosX();
  if (part.hidden) ImGui::PushStyleColor(ImGuiCol_Text, kFaintInk);
  elided_text(label, name_width);
  if (part.hidden) ImGui::PopStyleColor();
  ImGui::SameLine();
  ImGui::SetCursorPosX(only_x - kGrid - shells_width);
  ImGui::TextDisabled("%s", shells.c_str());
  ImGui::SameLine();
  ImGui::SetCursorPosX(only_x);
  const ImVec2 only_at = ImGui::GetCursorScreenPos();
  if (ImGui::InvisibleButton("only", ImVec2(only_width, line))) wanted.push_back({std::to_string(part.id), VisibilityAction::only});
  list.AddText(only_at, ImGui::IsItemHovered() ? kInk : kFaintInk, "only");
  ImGui::SameLine();
  ImGui::SetCursorPosX(right - line);
  if (lock_button(part.locked))
    wanted.push_back({std::to_string(part.id), part.locked ? VisibilityAction::unlock : VisibilityAction::lock});
  ImGui::PopID();
}

/// What can be done with all parts of a file: small words behind its name.
void file_row(const FileRow& file, Wanted& wanted) {
  ImGui::PushID(file.name.c_str());
  const std::string on = file_expression(file.name);
  const float line = ImGui::GetTextLineHeight(), right = ImGui::GetWindowContentRegionMax().x;
  const float only_width = ImGui::CalcTextSize("only").x, hide_width = ImGui::CalcTextSize("show").x;
  const float only_x = right - line - kGrid - only_width, hide_x = only_x - kGrid - hide_width;
  elided_text(printable(file.name), hide_x - kGrid - ImGui::GetCursorPosX());
  const auto word = [&](const char* text, float x, float width) {
    ImGui::SameLine();
    ImGui::SetCursorPosX(x);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool clicked = ImGui::InvisibleButton(text, ImVec2(width, line));
    ImGui::GetWindowDrawList()->AddText(at, ImGui::IsItemHovered() ? kInk : kFaintInk, text);
    return clicked;
  };
  if (word(file.hidden ? "show" : "hide", hide_x, hide_width))
    wanted.push_back({on, file.hidden ? VisibilityAction::show : VisibilityAction::hide});
  if (word("only", only_x, only_width)) wanted.push_back({on, VisibilityAction::only});
  ImGui::SameLine();
  ImGui::SetCursorPosX(right - line);
  if (lock_button(file.locked)) wanted.push_back({on, file.locked ? VisibilityAction::unlock : VisibilityAction::lock});
  ImGui::PopID();
}

/// The rows of files and parts together, so that a deck of hundreds of either still scrolls lightly.
void rows(const PartFacts& facts, Wanted& wanted) {
  const std::size_t files = facts.files.size();
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(files + facts.parts.size()));
  while (clipper.Step())
    for (auto i = static_cast<std::size_t>(clipper.DisplayStart); i < static_cast<std::size_t>(clipper.DisplayEnd); ++i)
      i < files ? file_row(facts.files[i], wanted) : part_row(facts.parts[i - files], wanted);
}

}  // namespace

std::vector<SetVisibility> part_list(const PartFacts& facts, panels::PanelLayout& layout) {
  Wanted wanted;
  const auto hidden = std::count_if(facts.parts.begin(), facts.parts.end(), [](const PartRow& part) { return part.hidden; });
  if (hidden > 0) {
    const std::string label = fmt::format("show all ({} hidden)", hidden);
    if (ImGui::SmallButton(label.c_str())) layout.ask(command_of(PartsCommand::show_all));
  }
  ImGui::BeginChild("list");
  rows(facts, wanted);
  ImGui::EndChild();
  return wanted;
}

}  // namespace prismesh::kiosk::tools::parts
