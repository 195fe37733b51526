#include "kiosk/panels/warnings_panel.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include <imgui.h>

#include "kiosk/panels/layout.h"
#include "kiosk/panels/text.h"

namespace prismesh::kiosk::panels {
namespace {

using notices::ToldWarning;

/// The text in lines that are not wider than `width`.
std::string lines_of(const std::string& text, float width) {
  std::string told = printable_lines(text);
  if (ImGui::CalcTextSize(told.c_str()).x <= width) return told;
  return break_at_spaces(told, width,
                         [](std::string_view piece) { return ImGui::CalcTextSize(piece.data(), piece.data() + piece.size()).x; });
}

constexpr std::size_t kMaxRows = 1000;  ///< what is laid out at once: the rows are of different heights

struct Columns {
  float sign = 0, text = 0;  ///< widths
};

/// The space between the list's own rows is in it.
float row_height(const ToldWarning& warning, const Columns& columns) {
  const float place = small_font()->FontSize;
  return place + ImGui::CalcTextSize(lines_of(warning.text, columns.text).c_str(), nullptr, false, columns.text).y + 2.5f * kGrid;
}

void warning_row(const ToldWarning& warning, const Columns& columns) {
  const float top = ImGui::GetCursorPosY();
  draw_signal(warning.is_error ? Signal::fail : Signal::warn, ImGui::GetFontSize() * 0.75f);
  ImGui::SetCursorPos(ImVec2(columns.sign, top));
  ImGui::BeginGroup();
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(kGrid, kGrid / 4));
  ImGui::PushTextWrapPos(columns.sign + columns.text);
  ImGui::TextUnformatted(lines_of(warning.text, columns.text).c_str());
  ImGui::PopTextWrapPos();
  ImGui::PushFont(small_font());
  ImGui::PushStyleColor(ImGuiCol_Text, kFaintInk);
  elided_text(printable(warning.place), columns.text);
  ImGui::PopStyleColor();
  ImGui::PopFont();
  ImGui::PopStyleVar();
  ImGui::EndGroup();
  ImGui::SetCursorPosY(top + row_height(warning, columns));
}

}  // namespace

void warnings_panel(std::span<const ToldWarning> warnings, const std::string& deck, const Place& room) {
  begin_centred("Warnings", room, ImGui::GetFontSize() * 56);
  ImGui::PushFont(title_font());
  elided_text("Warnings of " + printable(std::filesystem::path(deck).filename().string()), ImGui::GetContentRegionAvail().x);
  ImGui::PopFont();
  ImGui::PushFont(small_font());
  ImGui::TextDisabled("%s. %sCtrl+I or Esc closes.",
                      warnings.empty() ? "The deck was read without warnings" : notices::counts_of(warnings).c_str(),
                      notices::error_count(warnings) > 0 ? "Errors first: because of them the model isn't all of the deck. " : "");
  ImGui::PopFont();
  Columns columns;
  columns.sign = ImGui::GetFontSize() * 0.75f + kGrid;
  columns.text = ImGui::GetContentRegionAvail().x - columns.sign - 2 * kGrid;
  const std::span<const ToldWarning> listed = warnings.first(std::min(warnings.size(), kMaxRows));
  std::vector<float> heights;
  float height = 0;
  for (const ToldWarning& warning : listed) height += heights.emplace_back(row_height(warning, columns));
  const float free = room.height - 2 * kMargin - ImGui::GetCursorPosY() - 3 * kGrid;
  if (height > 0) {
    ImGui::BeginChild("list", ImVec2(0, std::max(4 * kGrid, std::min(height, free))));
    const float top = ImGui::GetScrollY(), bottom = top + ImGui::GetWindowHeight();
    float y = ImGui::GetCursorPosY();
    for (std::size_t i = 0; i < listed.size(); y += heights[i++]) {
      if (y + heights[i] < top || y > bottom) continue;
      ImGui::SetCursorPosY(y);
      warning_row(listed[i], columns);
    }
    ImGui::SetCursorPosY(y);
    if (warnings.size() > listed.size())
      ImGui::TextDisabled("and %s more, which `prismesh info` prints", grouped(warnings.size() - listed.size()).c_str());
    ImGui::Dummy(ImVec2(0, 0));
    ImGui::EndChild();
  }
  ImGui::End();
}

}  // namespace prismesh::kiosk::panels
