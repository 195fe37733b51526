#include "kiosk/panels/number_box.h"

#include <algorithm>
#include <cmath>

#include <imgui.h>

#include "kiosk/panels/text.h"

namespace prismesh::kiosk::panels {

namespace {

constexpr float kEmsBeside = 20;

/// A box below the pointer, or above it where it would leave the room.
void begin_beside(const char* name, const Place& room, float width, const Eigen::Vector2d& pointer) {
  const float wide = std::min(width, room.width - 2 * kMargin);
  const auto x = static_cast<float>(pointer.x()), y = static_cast<float>(pointer.y());
  const bool above = y > room.y + room.height * 2 / 3;
  const float left = std::clamp(x + kMargin, room.x + kMargin, room.right() - kMargin - wide);
  ImGui::SetNextWindowPos(ImVec2(std::round(left), std::round(above ? y - kMargin : y + kMargin)), 0, ImVec2(0, above ? 1 : 0));
  ImGui::SetNextWindowSize(ImVec2(wide, 0));
  ImGui::Begin(name, nullptr, kPanelFlags | ImGuiWindowFlags_AlwaysAutoResize);
}

}  // namespace

std::optional<std::string> number_box(const NumberFacts& facts, const Place& room, bool opened, EntryState& entry) {
  if (facts.at)
    begin_beside("Number", room, ImGui::GetFontSize() * kEmsBeside, *facts.at);
  else
    begin_low("Number", room, ImGui::GetFontSize() * 24);
  if (opened) {
    entry = EntryState{};
    entry.text = facts.begun;
  }
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(facts.title.c_str());
  ImGui::SameLine();
  const bool entered = entry_field("##number", {}, opened, entry);
  if (!facts.problem.empty()) small_line(printable(facts.problem), kFailColour);
  small_line(facts.hint + "; Enter does it, Esc doesn't", kFaintInk);
  ImGui::End();
  return entered ? std::optional(entry.text) : std::nullopt;
}

}  // namespace prismesh::kiosk::panels
