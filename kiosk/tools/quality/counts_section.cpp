#include "kiosk/tools/quality/counts_section.h"

#include <imgui.h>

#include "kiosk/panels/layout.h"
#include "kiosk/panels/text.h"

namespace prismesh::kiosk::tools::quality {
namespace {

using panels::grouped;
using panels::Signal;

void count_line(const char* label, Signal signal, std::size_t before, const std::optional<std::size_t>& now) {
  panels::draw_signal(signal, ImGui::GetFontSize() * 0.75f);
  ImGui::SameLine();
  std::string value = grouped(before);
  if (now && *now != before) value += " \u2192 " + grouped(*now);
  panels::fact(label, value);
}

}  // namespace

void counts_section(const CountsFacts& facts) {
  std::optional<std::size_t> ok, warn, failed;
  if (facts.pulled) {
    ok = facts.pulled->ok;
    warn = facts.pulled->warn;
    failed = facts.pulled->fail;
  }
  ImGui::TextUnformatted("Shell quality");
  count_line("ok", Signal::ok, facts.counts.ok, ok);
  count_line("warn", Signal::warn, facts.counts.warn, warn);
  count_line("fail", Signal::fail, facts.counts.fail, failed);
  if (facts.clusters > 0) count_line("nodes of many triangles", Signal::warn, facts.clusters, std::nullopt);
  ImGui::PushFont(panels::small_font());
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  if (!facts.hidden_glyphs.empty()) ImGui::TextWrapped("%s", facts.hidden_glyphs.c_str());
  if (facts.glyphs_left_out > 0) ImGui::TextWrapped("%s more marks than can be drawn", grouped(facts.glyphs_left_out).c_str());
  ImGui::PopStyleColor();
  ImGui::PopFont();
}

}  // namespace prismesh::kiosk::tools::quality
