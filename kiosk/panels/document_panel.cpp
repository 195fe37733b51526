#include "kiosk/panels/document_panel.h"

#include <filesystem>

#include <fmt/format.h>
#include <imgui.h>

#include "base/readable_number.h"
#include "kiosk/panels/layout.h"
#include "kiosk/panels/text.h"

namespace prismesh::kiosk::panels {
namespace {

constexpr std::uint64_t kMegabyte = 1U << 20;

std::string guessed(const std::string& value, bool is_guess) { return is_guess ? value + " (guessed)" : value; }

}  // namespace

void model_facts(const DocumentFacts& document) {
  ImGui::PushFont(small_font());
  ImGui::PushStyleColor(ImGuiCol_Text, kFaintInk);
  elided_text(printable(std::filesystem::path(document.path).parent_path().string()), ImGui::GetContentRegionAvail().x);
  ImGui::PopStyleColor();
  ImGui::PopFont();
  fact("shells", grouped(document.shells));
  fact("nodes", grouped(document.nodes));
  fact("parts", grouped(document.parts));
  fact("length unit", guessed(document.length_unit, document.length_unit_guessed));
  const std::string largest = length_text(document.largest_target_size, document.length_unit);
  fact("target size",
       guessed(document.target_size < document.largest_target_size ? readable(document.target_size, 3) + " to " + largest : largest,
               document.target_size_guessed));
}

void history_facts(const HistoryFacts& history) {
  if (history.cap == 0) return;
  fact("kept for undo", fmt::format("{:.1f} of {} MB", static_cast<double>(history.bytes) / kMegabyte, history.cap / kMegabyte));
}

void video_memory_facts(const VideoMemoryFacts& memory) {
  if (memory.megabytes.empty()) return;
  fact("video memory", memory.megabytes);
  if (memory.given_up.empty()) return;
  ImGui::PushFont(small_font());
  ImGui::TextWrapped("%s", memory.given_up.c_str());
  ImGui::PopFont();
}

}  // namespace prismesh::kiosk::panels
