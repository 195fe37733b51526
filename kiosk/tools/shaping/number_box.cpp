#include "kiosk/tools/shaping/number_box.h"

#include <imgui.h>

#include "kiosk/panels/text.h"

namespace prismesh::kiosk::tools::shaping {

std::optional<std::string> number_box(const NumberFacts& facts, display::PixelSize picture, bool opened, panels::EntryState& entry) {
  panels::begin_low("Number", picture, ImGui::GetFontSize() * 24);
  if (opened) {
    entry = panels::EntryState{};
    entry.text = facts.begun;
  }
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(facts.title.c_str());
  ImGui::SameLine();
  const bool entered = panels::entry_field("##number", {}, opened, entry);
  if (!facts.problem.empty()) panels::small_line(panels::printable(facts.problem), panels::kFailColour);
  panels::small_line(facts.hint + "; Enter does it, Esc doesn't", panels::kFaintInk);
  ImGui::End();
  return entered ? std::optional(entry.text) : std::nullopt;
}

}  // namespace prismesh::kiosk::tools::shaping
