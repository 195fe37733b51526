#include "kiosk/panels/key_panels.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <imgui.h>

#include "kiosk/panels/layout.h"
#include "kiosk/panels/text.h"

namespace prismesh::kiosk::panels {
namespace {

using input::KeyBinding;

/// Two columns, `width` pixels wide from `x`: what to press, and what it does.
template <class Bindings, class Left>
void binding_list(const char* title, const Bindings& bindings, const Left& left, float x, float width) {
  ImGui::SetCursorPosX(x);
  ImGui::PushFont(title_font());
  ImGui::TextUnformatted(title);
  ImGui::PopFont();
  float label_width = 0;
  for (const auto& binding : bindings)
    label_width = std::max(label_width, ImGui::CalcTextSize(left(binding).data(), left(binding).data() + left(binding).size()).x);
  label_width = std::min(label_width, 0.45F * width);  // long ones go on in a line of their own
  for (const auto& binding : bindings) {
    ImGui::SetCursorPosX(x);
    const float top = ImGui::GetCursorPosY();
    ImGui::PushTextWrapPos(x + label_width + kGrid);
    ImGui::TextUnformatted(left(binding).data(), left(binding).data() + left(binding).size());
    ImGui::PopTextWrapPos();
    const float bottom = ImGui::GetCursorPosY();
    ImGui::SetCursorPos(ImVec2(x + label_width + 2 * kGrid, top));
    ImGui::PushTextWrapPos(x + width);
    ImGui::TextDisabled("%s", std::string(binding.meaning).c_str());
    ImGui::PopTextWrapPos();
    ImGui::SetCursorPosY(std::max(bottom, ImGui::GetCursorPosY()));
  }
}

}  // namespace

void help_panel(std::span<const KeyBinding> keys, std::span<const input::MouseBinding> mouse, const Place& room) {
  const float widest = room.width - 2 * kMargin, highest = room.height - 2 * kMargin;
  const float width = on_grid(std::min(ImGui::GetFontSize() * 76, widest)), half = (width - 6 * kGrid) / 2;
  ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, highest));
  begin_centred("Keys and mouse", room, width);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(kGrid, kGrid / 2));
  const float top = ImGui::GetCursorPosY();
  binding_list(
      "Keys", keys, [](const KeyBinding& binding) { return binding.label; }, 2 * kGrid, half);
  const float bottom = ImGui::GetCursorPosY();
  ImGui::SetCursorPosY(top);
  binding_list(
      "Mouse", mouse, [](const input::MouseBinding& binding) { return std::string_view(binding.gesture); }, half + 4 * kGrid, half);
  ImGui::SetCursorPosY(std::max(bottom, ImGui::GetCursorPosY()));
  ImGui::PopStyleVar();
  ImGui::End();
}

void menu_panel(std::span<const KeyBinding> all, PanelLayout& layout) {
  constexpr int kColumns = 3;
  const Place room = whole(layout.picture);
  const float widest = room.width - 2 * kMargin, highest = room.height - 2 * kMargin;
  const float width = on_grid(std::min(ImGui::GetFontSize() * 92, widest));
  ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, highest));
  begin_centred("Menu", room, width);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(kGrid, kGrid / 4));
  ImGui::Columns(kColumns, nullptr, false);
  const std::size_t lines = all.size() + 2 * input::kMenuNames.size();
  std::size_t line = 0, column = 0;
  for (std::size_t m = 0; m < input::kMenuNames.size(); ++m) {
    const auto entries = static_cast<std::size_t>(
        std::count_if(all.begin(), all.end(), [&](const KeyBinding& binding) { return static_cast<std::size_t>(binding.menu) == m; }));
    // A menu stays whole: where half of it or more would hang over, it goes into the next column.
    if (column + 1 < kColumns && (line + (entries + 1) / 2) * kColumns > lines * (column + 1)) {
      ImGui::NextColumn();
      ++column;
    }
    line += entries + 2;
    ImGui::PushFont(title_font());
    ImGui::TextUnformatted(input::kMenuNames[m].data());
    ImGui::PopFont();
    for (const KeyBinding& binding : all) {
      if (static_cast<std::size_t>(binding.menu) != m) continue;
      const float left = ImGui::GetCursorPosX(), free = ImGui::GetColumnWidth() - 2 * kGrid;
      const float key_width = ImGui::CalcTextSize(binding.label.data()).x;
      ImGui::PushID(static_cast<int>(&binding - all.data()));
      if (ImGui::Selectable("##entry", false, 0, ImVec2(free, 0))) layout.ask(binding.command);
      ImGui::PopID();
      ImGui::SameLine();
      ImGui::SetCursorPosX(left);
      elided_text(std::string(binding.meaning), free - key_width - 2 * kGrid);
      ImGui::SameLine();
      ImGui::SetCursorPosX(left + free - key_width);
      ImGui::TextDisabled("%s", binding.label.data());
    }
    ImGui::Dummy(ImVec2(0, kGrid));
  }
  ImGui::Columns(1);
  ImGui::PopStyleVar();
  ImGui::End();
}

}  // namespace prismesh::kiosk::panels
