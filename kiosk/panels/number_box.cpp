#include "kiosk/panels/number_box.h"

#include <imgui.h>

#include "kiosk/panels/text.h"

namespace prismesh::kiosk::panels {

std::optional<std::string> number_box(const NumberFacts& facts, const Place& room, bool opened, EntryState& entry) {
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
