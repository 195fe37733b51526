#include "kiosk/panels/layout.h"

#include <algorithm>

#include "kiosk/panels/text.h"

namespace prismesh::kiosk::panels {

void draw_signal(Signal signal, float size) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float line = ImGui::GetTextLineHeight(), half = size / 2;
  const ImVec2 middle(at.x + half, at.y + line / 2);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  switch (signal) {
    case Signal::ok: list.AddCircleFilled(middle, half * 0.9f, kFaintInk); break;
    case Signal::information: list.AddCircleFilled(middle, half * 0.9f, kInformationColour); break;
    case Signal::warn:
      list.AddTriangleFilled(ImVec2(middle.x, middle.y - half), ImVec2(middle.x + half, middle.y + half * 0.9f),
                             ImVec2(middle.x - half, middle.y + half * 0.9f), kWarnColour);
      break;
    case Signal::fail:
      list.AddRectFilled(ImVec2(middle.x - half * 0.9f, middle.y - half * 0.9f), ImVec2(middle.x + half * 0.9f, middle.y + half * 0.9f),
                         kFailColour);
      break;
  }
  ImGui::Dummy(ImVec2(size, line));
}

void elided_text(const std::string& text, float width) {
  const std::string shown = elide_middle(text, static_cast<double>(width), [](std::string_view piece) {
    return static_cast<double>(ImGui::CalcTextSize(piece.data(), piece.data() + piece.size()).x);
  });
  ImGui::TextUnformatted(shown.c_str());
  if (shown != text && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text.c_str());
}

void fact(const char* label, const std::string& value) {
  ImGui::TextDisabled("%s", label);
  const float width = ImGui::CalcTextSize(value.c_str()).x;
  ImGui::SameLine();
  const float left = ImGui::GetCursorPosX(), right = ImGui::GetWindowContentRegionMax().x - width;
  ImGui::SetCursorPosX(right > left ? right : left);
  ImGui::TextUnformatted(value.c_str());
}

void section(const char* title) {
  ImGui::Dummy(ImVec2(0, kGrid / 2));
  ImGui::Separator();
  ImGui::TextUnformatted(title);
}

void begin_docked(const char* name, const Place& place, ImGuiWindowFlags flags) {
  ImGui::SetNextWindowPos(ImVec2(place.x, place.y));
  ImGui::SetNextWindowSize(ImVec2(place.width, place.height));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
  ImGui::Begin(name, nullptr, kPanelFlags | ImGuiWindowFlags_NoBringToFrontOnFocus | flags);
  ImGui::PopStyleVar();
  // The border that panels side by side need to be told apart.
  ImGui::GetWindowDrawList()->AddRect(ImVec2(place.x, place.y), ImVec2(place.right(), place.bottom()), kBorderColour);
}

void begin_centred(const char* name, const Place& room, float width) {
  ImGui::SetNextWindowPos(ImVec2(std::floor(room.x + room.width / 2), std::floor(room.y + room.height / 2)), 0, ImVec2(0.5f, 0.5f));
  ImGui::SetNextWindowSize(ImVec2(std::min(width, room.width - 2 * kMargin), 0));
  ImGui::Begin(name, nullptr, (kPanelFlags & ~ImGuiWindowFlags_NoScrollbar) | ImGuiWindowFlags_AlwaysAutoResize);
}

}  // namespace prismesh::kiosk::panels
