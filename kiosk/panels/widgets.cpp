#include "kiosk/panels/widgets.h"

#include <algorithm>
#include <utility>

namespace prismesh::kiosk::panels {

void setting(const char* label, const std::string& value, const input::KeyBinding& next, PanelLayout& layout) {
  ImGui::PushID(label);
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", label);
  const float width = ImGui::CalcTextSize(value.c_str()).x + 2 * kGrid;
  ImGui::SameLine();
  ImGui::SetCursorPosX(std::max(ImGui::GetCursorPosX(), ImGui::GetWindowContentRegionMax().x - width));
  if (ImGui::Button(value.c_str())) layout.ask(next.command);
  hint(next);
  ImGui::PopID();
}

void hint(const input::KeyBinding& binding) {
  if (!ImGui::IsItemHovered()) return;
  ImGui::SetTooltip("%s (%s)", std::string(binding.meaning).c_str(), std::string(binding.label).c_str());
}

void note_item(PanelLayout& layout, std::string name, std::string state) {
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  layout.items.push_back({std::move(name), std::move(state), {low.x, low.y, high.x - low.x, high.y - low.y}});
}

void check(const char* label, bool value, const input::Command& toggle, PanelLayout& layout) {
  bool now = value;
  if (ImGui::Checkbox(label, &now)) layout.ask(toggle);
}

void panel_title(const char* title, const char* line) {
  ImGui::Dummy(ImVec2(0, kGrid / 2));
  ImGui::Separator();
  ImGui::PushFont(title_font());
  ImGui::TextUnformatted(title);
  ImGui::PopFont();
  ImGui::PushFont(small_font());
  ImGui::TextDisabled("%s", line);
  ImGui::PopFont();
}

}  // namespace prismesh::kiosk::panels
