#include "kiosk/panels/warnings_panel.h"

#include <algorithm>
#include <filesystem>

#include <imgui.h>

#include "kiosk/panels/layout.h"
#include "kiosk/panels/text.h"

namespace prismesh::kiosk::panels {
namespace {

using notices::ToldWarning;

/// The text in lines that are not wider than `width`.
std::string lines_of(const std::string& text, float width) {
  return break_at_spaces(printable_lines(text), width,
                         [](std::string_view piece) { return ImGui::CalcTextSize(piece.data(), piece.data() + piece.size()).x; });
}

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
  ImGui::TextDisabled("%s. %sCtrl+I or Esc closes.", warnings.empty() ? "Nothing is wrong" : notices::counts_of(warnings).c_str(),
                      notices::error_count(warnings) > 0 ? "Errors first: because of them the model isn't all of the deck. " : "");
  ImGui::PopFont();
  Columns columns;
  columns.sign = ImGui::GetFontSize() * 0.75f + kGrid;
  columns.text = ImGui::GetContentRegionAvail().x - columns.sign - 2 * kGrid;
  float height = 0;
  for (const ToldWarning& warning : warnings) height += row_height(warning, columns);
  const float free = room.height - 2 * kMargin - ImGui::GetCursorPosY() - 3 * kGrid;
  if (height > 0) {
    ImGui::BeginChild("list", ImVec2(0, std::max(4 * kGrid, std::min(height, free))));
    for (const ToldWarning& warning : warnings) warning_row(warning, columns);
    ImGui::Dummy(ImVec2(0, 0));
    ImGui::EndChild();
  }
  ImGui::End();
}

}  // namespace prismesh::kiosk::panels
