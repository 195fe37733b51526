#include "kiosk/tools/find/find_box.h"

#include <algorithm>
#include <utility>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "kiosk/panels/text.h"
#include "kiosk/panels/widgets.h"

namespace prismesh::kiosk::tools::find {
namespace {

using panels::kGrid;

constexpr std::size_t kRowsInSight = 14;

struct Keys {
  FindEntry& entry;
  std::size_t rows;
};

int by_key(ImGuiInputTextCallbackData* data) {
  Keys& keys = *static_cast<Keys*>(data->UserData);
  FindEntry& entry = keys.entry;
  if (data->EventFlag == ImGuiInputTextFlags_CallbackHistory) {
    entry.chosen_by_key = true;
    if (keys.rows == 0) return 0;
    entry.chosen = (entry.chosen + (data->EventKey == ImGuiKey_UpArrow ? keys.rows - 1 : 1)) % keys.rows;
  } else if (data->EventFlag == ImGuiInputTextFlags_CallbackEdit) {
    entry.chosen = 0;
  } else if (std::exchange(entry.caret_to_end, false)) {
    data->CursorPos = data->BufTextLen;
    data->ClearSelection();
  }
  return 0;
}

bool row(const FindRow& facts, std::size_t number, bool chosen, panels::PanelLayout& layout) {
  const float left = ImGui::GetCursorPosX(), right = ImGui::GetWindowContentRegionMax().x;
  ImGui::PushID(static_cast<int>(number));
  const bool clicked = ImGui::Selectable("##row", chosen);
  ImGui::PopID();
  panels::note_item(layout, "found " + facts.words, chosen ? "chosen" : "");
  const float key = ImGui::CalcTextSize(facts.key.c_str()).x;
  ImGui::SameLine();
  ImGui::SetCursorPosX(left);
  panels::elided_text(facts.words, right - left - key - 2 * kGrid);
  ImGui::SameLine();
  ImGui::SetCursorPosX(right - key);
  ImGui::TextDisabled("%s", facts.key.c_str());
  return clicked;
}

}  // namespace

std::optional<std::size_t> find_box(const FindFacts& facts, bool opened, FindEntry& entry, panels::PanelLayout& layout) {
  const panels::Place room = layout.view();
  const float width = std::min(44 * ImGui::GetFontSize(), room.width - 2 * panels::kMargin);
  ImGui::SetNextWindowPos(ImVec2(room.x + (room.width - width) / 2, room.y + panels::kMargin));
  ImGui::SetNextWindowSize(ImVec2(width, 0));
  ImGui::Begin("Find", nullptr, panels::kPanelFlags | ImGuiWindowFlags_AlwaysAutoResize);
  // A click on a row is the row's; afterwards the field has the keyboard again.
  if (opened || (!ImGui::IsAnyItemActive() && !ImGui::IsAnyMouseDown())) {
    entry.caret_to_end = true;
    ImGui::SetKeyboardFocusHere();
  }
  ImGui::SetNextItemWidth(-1);
  Keys keys{entry, facts.rows.size()};
  const bool entered = ImGui::InputTextWithHint("##find", "a command, or an id to go to: 5000766, shell 12, part 3", &entry.typed,
                                                ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackHistory |
                                                    ImGuiInputTextFlags_CallbackAlways | ImGuiInputTextFlags_CallbackEdit,
                                                by_key, &keys);
  panels::note_item(layout, "find field", entry.typed);
  entry.chosen = std::min(entry.chosen, facts.rows.empty() ? 0 : facts.rows.size() - 1);
  std::optional<std::size_t> taken = entered && !facts.rows.empty() ? std::optional(entry.chosen) : std::nullopt;
  if (!facts.rows.empty()) {
    const float line = ImGui::GetTextLineHeightWithSpacing();
    const float most = std::max(2 * line, room.height - 12 * kGrid - line);
    ImGui::BeginChild("rows", ImVec2(0, std::min(most, line * static_cast<float>(std::min(facts.rows.size(), kRowsInSight)))));
    for (std::size_t i = 0; i < facts.rows.size(); ++i) {
      if (row(facts.rows[i], i, i == entry.chosen, layout)) taken = i;
      if (i == entry.chosen && entry.chosen_by_key) ImGui::SetScrollHereY();
    }
    entry.chosen_by_key = false;
    ImGui::EndChild();
  } else if (!facts.problem.empty()) {
    ImGui::TextWrapped("%s", panels::printable(facts.problem).c_str());
    panels::note_item(layout, "find problem", panels::printable(facts.problem));
  }
  ImGui::End();
  return taken;
}

}  // namespace prismesh::kiosk::tools::find
