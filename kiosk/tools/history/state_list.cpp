#include "kiosk/tools/history/state_list.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "kiosk/panels/layout.h"
#include "kiosk/panels/text.h"
#include "kiosk/panels/widgets.h"

namespace prismesh::kiosk::tools::history {

std::string words_of_maker(std::string_view made_by) {
  if (made_by == "open") return "As opened";
  std::string words = panels::printable(made_by);
  std::ranges::replace(words, '_', ' ');
  if (!words.empty() && words[0] >= 'a' && words[0] <= 'z') words[0] = static_cast<char>(words[0] - 'a' + 'A');
  return words;
}

namespace {

/// A line, and another that leaves it.
void draw_fork(ImDrawList& list, ImVec2 at, float size) {
  const float width = std::max(1.0F, size * 0.09F), x = at.x + size * 0.35F;
  list.AddLine(ImVec2(x, at.y), ImVec2(x, at.y + size), panels::kFaintInk, width);
  list.AddLine(ImVec2(x, at.y + size * 0.65F), ImVec2(at.x + size * 0.75F, at.y + size * 0.2F), panels::kFaintInk, width);
}

/// Returns the newest state of the branch that was clicked.
std::optional<std::uint64_t> branch_rows(const std::vector<BranchRow>& branches, float height, float width, panels::PanelLayout& layout) {
  std::optional<std::uint64_t> clicked;
  for (const BranchRow& row : branches) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::PushID(row.words.c_str());
    ImGui::PushID(static_cast<int>(row.number));
    if (ImGui::InvisibleButton("branch", ImVec2(width, height))) clicked = row.generation;
    ImGui::PopID();
    ImGui::PopID();
    panels::note_item(layout, fmt::format("branch {}", row.number), row.words + ": " + row.states);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (ImGui::IsItemHovered()) {
      list.AddRectFilled(at, ImVec2(at.x + width, at.y + height), 0x18ffffffU, 2);
      ImGui::SetTooltip("go there: %s", row.states.c_str());
    }
    const float line = ImGui::GetFontSize(), top = at.y + std::floor((height - line) / 2);
    draw_fork(list, ImVec2(at.x, top), line);
    const std::string words = panels::elide_middle(
        fmt::format("Branch {}: {}", row.number, row.words), static_cast<double>(width - line * 1.2F),
        [](std::string_view piece) { return static_cast<double>(ImGui::CalcTextSize(piece.data(), piece.data() + piece.size()).x); });
    list.AddText(ImVec2(at.x + line * 1.2F, top), panels::kInk, words.c_str());
  }
  return clicked;
}

}  // namespace

std::optional<std::uint64_t> state_list(const StateFacts& facts, bool follow, panels::PanelLayout& layout) {
  std::optional<std::uint64_t> clicked;
  ImGui::BeginChild("states");
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0, 0));
  const float height = std::round(1.45F * ImGui::GetFontSize()), width = ImGui::GetContentRegionAvail().x;
  if (follow && facts.current)
    ImGui::SetScrollY(height * (static_cast<float>(*facts.current) + 0.5F) - 0.5F * ImGui::GetContentRegionAvail().y);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(facts.states.size()), height);
  while (clipper.Step())
    for (auto i = static_cast<std::size_t>(clipper.DisplayStart); i < static_cast<std::size_t>(clipper.DisplayEnd); ++i) {
      const StateRow& row = facts.states[i];
      const bool current = i == facts.current, newer = facts.current && i > *facts.current;
      const ImVec2 at = ImGui::GetCursorScreenPos();
      ImGui::PushID(static_cast<int>(i));
      if (ImGui::InvisibleButton("state", ImVec2(width, height)) && !current) clicked = row.generation;
      ImGui::PopID();
      panels::note_item(layout, fmt::format("state {}", row.generation), row.words + (current ? ", current" : newer ? ", undone" : ""));
      ImDrawList& list = *ImGui::GetWindowDrawList();
      if (current || ImGui::IsItemHovered())
        list.AddRectFilled(at, ImVec2(at.x + width, at.y + height), current ? 0x50ecb468U : 0x18ffffffU, 2);
      if (ImGui::IsItemHovered() && !current) ImGui::SetTooltip("%s", newer ? "do again up to here" : "undo up to here");
      const float line = ImGui::GetFontSize(), top = at.y + std::floor((height - line) / 2);
      if (current) list.AddCircleFilled(ImVec2(at.x + line * 0.5F, at.y + height / 2), line * 0.22F, panels::kActiveColour);
      // What only selects steps back by place; what is undone, by colour.
      list.AddText(ImVec2(at.x + line * (row.selects ? 2 : 1.2F), top), newer ? panels::kFaintInk : panels::kInk, row.words.c_str());
    }
  if (const auto newest = branch_rows(facts.branches, height, width, layout)) clicked = newest;
  ImGui::PopStyleVar();
  ImGui::EndChild();
  return clicked;
}

}  // namespace prismesh::kiosk::tools::history
