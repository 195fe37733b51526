#include "kiosk/panels/option_row.h"

#include <imgui.h>

#include "kiosk/panels/layout.h"
#include "kiosk/panels/widgets.h"

namespace prismesh::kiosk::panels {

bool OptionRow::next(float width) {
  if (full_) return false;
  if (!first_) ImGui::SameLine();
  // What has no room is named by a sign, for which some is kept.
  const float sign = ImGui::CalcTextSize("\u2026").x + kGrid;
  if (ImGui::GetCursorPosX() + width + sign > ImGui::GetWindowContentRegionMax().x) {
    full_ = true;
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("\u2026");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("the others are in the panel at the right");
    return false;
  }
  first_ = false;
  return true;
}

void OptionRow::button(const char* name, const std::string& label, bool lit, const std::string& state, const input::KeyBinding& binding) {
  if (!next(ImGui::CalcTextSize(label.c_str()).x + 2 * ImGui::GetStyle().FramePadding.x)) return;
  ImGui::PushID(name);
  if (lit) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
  if (ImGui::Button(label.c_str())) layout_.ask(binding.command);
  if (lit) ImGui::PopStyleColor();
  hint(binding);
  ImGui::PopID();
  note_item(layout_, std::string("option ") + name, state);
}

void OptionRow::value(const char* label, const std::string& value, const input::KeyBinding& next) {
  button(label, std::string(label) + ": " + value, false, value, next);
}

void OptionRow::toggle(const char* label, bool on, const input::KeyBinding& binding) {
  button(label, label, on, on ? "on" : "off", binding);
}

void OptionRow::command(const char* label, const input::KeyBinding& binding) { button(label, label, false, "", binding); }

void OptionRow::words(const std::string& text) {
  if (!next(ImGui::CalcTextSize(text.c_str()).x)) return;
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", text.c_str());
}

}  // namespace prismesh::kiosk::panels
