#include "kiosk/setup/setup_panel.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <imgui.h>

#include "kiosk/panels/layout.h"
#include "kiosk/panels/text.h"
#include "kiosk/panels/widgets.h"

namespace prismesh::kiosk::setup {
namespace {

using panels::begin_docked;
using panels::draw_signal;
using panels::kActiveColour;
using panels::kBorderColour;
using panels::kFaintInk;
using panels::kInformationColour;
using panels::kInk;
using panels::kMargin;
using panels::kWarnColour;
using panels::note_item;
using panels::on_grid;
using panels::PanelLayout;
using panels::printable;
using panels::Signal;
using panels::small_font;
using panels::title_font;
using panels::whole;

using SetupActions = std::vector<SetupAction>;
using Kind = SetupAction::Kind;

constexpr float kColumnInFonts = 44;
constexpr float kTargetInFonts = 2.5F;  ///< of a finger: 15 mm, see for_fingers
constexpr float kGap = 4;
constexpr std::size_t kColumns = 2;  ///< of choices

constexpr std::string_view kLetterRows[] = {"1234567890", "qwertyuiop", "asdfghjkl-", "zxcvbnm_/"};
constexpr std::string_view kAddressRows[] = {"1234567890", "abcdef.:/ "};
constexpr std::string_view kDigitRows[] = {"1234567890", "-:"};

float target() { return kTargetInFonts * ImGui::GetFontSize(); }

std::span<const std::string_view> rows_of(Pad pad) {
  if (pad == Pad::letters) return kLetterRows;
  if (pad == Pad::addresses) return kAddressRows;
  return kDigitRows;
}

void setup_title(const View& view) {
  ImGui::PushFont(title_font());
  ImGui::TextUnformatted(view.title.c_str());
  ImGui::PopFont();
  const std::string count = fmt::format("page {} of {}", view.number, view.count);
  ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(count.c_str()).x);
  ImGui::TextDisabled("%s", count.c_str());
  ImGui::TextWrapped("%s", view.task.c_str());
}

void line_with_signal(unsigned colour, Signal signal, std::string text) {
  // Errors are worded to stand behind a field's name.
  if (!text.empty() && text.front() >= 'a' && text.front() <= 'z') text.front() = static_cast<char>(text.front() - 'a' + 'A');
  draw_signal(signal, 0.7F * ImGui::GetFontSize());
  ImGui::SameLine(0, 0.5F * ImGui::GetFontSize());
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::TextWrapped("%s", printable(text).c_str());
  ImGui::PopStyleColor();
}

/// As many rows of choices as there is room for, about the chosen one.
void choice_rows(const View& view, float room, PanelLayout& layout, SetupActions& actions) {
  if (view.choices.empty()) return;
  const auto fit = static_cast<std::size_t>(std::max(1.0F, room / (target() + kGap)));
  const std::size_t rows = (view.choices.size() + kColumns - 1) / kColumns, chosen_row = view.chosen / kColumns;
  const std::size_t shown = std::min(fit, rows);
  const std::size_t first = std::min(chosen_row > shown / 2 ? chosen_row - shown / 2 : 0, rows - shown);
  const float width = (ImGui::GetContentRegionAvail().x - kGap) / static_cast<float>(kColumns);
  for (std::size_t i = first * kColumns; i < std::min((first + shown) * kColumns, view.choices.size()); ++i) {
    const Choice& choice = view.choices[i];
    if (i % kColumns != 0) ImGui::SameLine(0, kGap);
    const bool chosen = i == view.chosen;
    ImGui::PushStyleColor(ImGuiCol_Button, chosen ? ImVec4(0.41F, 0.71F, 0.93F, 0.35F) : ImVec4(1, 1, 1, 0.10F));
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const bool pressed = ImGui::Button(("##choice" + choice.label).c_str(), ImVec2(width, target()));
    ImGui::PopStyleColor();
    note_item(layout, "setup choice " + choice.label, chosen ? "on" : "off");
    if (pressed) actions.push_back({Kind::choose, i});
    // A chosen one is told by a mark too, not by colour alone.
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float font = ImGui::GetFontSize();
    const float top = corner.y + (choice.words.empty() ? 0.75F : 0.3F) * font;
    const ImVec2 middle(corner.x + 0.9F * font, corner.y + 0.5F * target());
    list.AddCircle(middle, 0.35F * font, kInk, 0, 2);
    if (chosen) list.AddCircleFilled(middle, 0.2F * font, kInk);
    const ImVec2 start(corner.x + 1.7F * font, top);
    list.PushClipRect(corner, ImVec2(corner.x + width, corner.y + target()), true);
    list.AddText(start, kInk, printable(choice.label).c_str());
    if (!choice.words.empty()) {
      ImFont* small = small_font();
      list.AddText(small, small->FontSize, ImVec2(start.x, top + 1.15F * font), kFaintInk, printable(choice.words).c_str());
    }
    list.PopClipRect();
  }
}

void field_rows(const View& view, PanelLayout& layout, SetupActions& actions) {
  float labels = 0;
  for (const Field& field : view.fields) labels = std::max(labels, ImGui::CalcTextSize(field.label.c_str()).x);
  for (std::size_t i = 0; i < view.fields.size(); ++i) {
    const Field& field = view.fields[i];
    const float start = ImGui::GetCursorPosX(), font = ImGui::GetFontSize();
    const ImVec2 label = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddText(ImVec2(label.x, label.y + 0.75F * font), kInk, field.label.c_str());
    ImGui::SetCursorPosX(start + labels + font);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size(ImGui::GetContentRegionAvail().x, target());
    if (ImGui::InvisibleButton(("##field" + field.name).c_str(), size)) actions.push_back({Kind::focus, i});
    const bool focused = i == view.focus;
    note_item(layout, "setup field " + field.name, printable(field.text));
    list.AddRectFilled(corner, ImVec2(corner.x + size.x, corner.y + size.y), 0x14ffffff);
    list.AddRect(corner, ImVec2(corner.x + size.x, corner.y + size.y),
                 !field.trouble.empty() ? kWarnColour
                 : focused              ? kInformationColour
                                        : kBorderColour,
                 0, 0, focused ? 2.0F : 1.0F);
    const std::string text = printable(field.text);
    const ImVec2 at(corner.x + 0.6F * font, corner.y + 0.75F * font);
    list.AddText(at, kInk, text.c_str());
    if (focused) {
      const float caret = at.x + ImGui::CalcTextSize(text.c_str()).x + 1;
      list.AddLine(ImVec2(caret, at.y), ImVec2(caret, at.y + font), kInk, 2);
    }
    if (!field.trouble.empty()) {
      line_with_signal(kWarnColour, Signal::warn, field.trouble);
      note_item(layout, "setup trouble " + field.name, field.trouble);
    }
  }
}

void pad_rows(const View& view, PanelLayout& layout, SetupActions& actions) {
  if (view.focus >= view.fields.size()) return;
  const std::span<const std::string_view> rows = rows_of(view.fields[view.focus].pad);
  const float key = target();
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (std::size_t i = 0; i < rows[row].size(); ++i) {
      const std::string letter(1, rows[row][i]);
      if (i > 0) ImGui::SameLine(0, kGap);
      if (ImGui::Button(((letter == " " ? std::string("blank") : letter) + "##key").c_str(), ImVec2(letter == " " ? 1.6F * key : key, key)))
        actions.push_back({Kind::type, 0, letter});
      note_item(layout, "setup key " + (letter == " " ? std::string("blank") : letter), "");
    }
    if (row + 1 < rows.size()) continue;
    ImGui::SameLine(0, kGap);
    if (ImGui::Button("<##erase", ImVec2(1.6F * key, key))) actions.push_back({Kind::erase});
    note_item(layout, "setup erase", "");
  }
}

bool row_button(const char* label, const char* name, PanelLayout& layout) {
  const bool pressed = ImGui::Button(label, ImVec2(on_grid(7 * ImGui::GetFontSize()), target()));
  note_item(layout, name, label);
  return pressed;
}

void setup_buttons(const View& view, PanelLayout& layout, SetupActions& actions) {
  if (row_button("Leave", "setup leave", layout)) actions.push_back({Kind::leave});
  if (!view.first) {
    ImGui::SameLine(0, kGap);
    if (row_button("Back", "setup back", layout)) actions.push_back({Kind::back});
  }
  if (view.can_calibrate) {
    ImGui::SameLine(0, kGap);
    if (row_button("Calibrate", "setup calibrate", layout)) actions.push_back({Kind::calibrate});
  }
  const float width = on_grid(7 * ImGui::GetFontSize());
  if (view.can_skip) {
    ImGui::SameLine(ImGui::GetContentRegionMax().x - 2 * width - kGap);
    if (row_button("Skip", "setup skip", layout)) actions.push_back({Kind::skip});
  }
  ImGui::SameLine(ImGui::GetContentRegionMax().x - width);
  ImGui::PushStyleColor(ImGuiCol_Text, kActiveColour);
  if (row_button(view.next.c_str(), "setup next", layout)) actions.push_back({Kind::next});
  ImGui::PopStyleColor();
}

}  // namespace

SetupActions setup_panel(const View& view, bool works, PanelLayout& layout) {
  SetupActions actions;
  const auto w = static_cast<float>(layout.picture.width), h = static_cast<float>(layout.picture.height);
  const float font = ImGui::GetFontSize();
  begin_docked("Set-up", whole(layout.picture));
  const float column = std::min(w - 2 * kMargin, kColumnInFonts * font);
  ImGui::SetCursorPos(ImVec2(std::floor(0.5F * (w - column)), kMargin));
  const float lines = ImGui::GetTextLineHeightWithSpacing();
  const float foot = target() + lines + kMargin;
  ImGui::BeginChild("page", ImVec2(column, h - 2 * kMargin));
  setup_title(view);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(kGap, kGap));
  ImGui::BeginDisabled(works);
  // The keys stand at the foot: they don't move under a finger when choices come and go above.
  const float pad =
      view.focus < view.fields.size() ? static_cast<float>(rows_of(view.fields[view.focus].pad).size()) * (target() + kGap) : 0;
  float rest = foot + pad + static_cast<float>(view.remarks.size() + 1) * lines;
  if (!view.finds) rest += static_cast<float>(view.fields.size()) * (target() + kGap);
  for (const Field& field : view.fields) rest += field.trouble.empty() ? 0 : 2 * lines;
  const auto choices = [&] { choice_rows(view, h - 2 * kMargin - ImGui::GetCursorPosY() - rest, layout, actions); };
  if (!view.finds) choices();
  field_rows(view, layout, actions);
  if (view.finds) choices();
  for (const std::string& remark : view.remarks) line_with_signal(kInformationColour, Signal::information, remark);
  if (!view.trouble.empty()) line_with_signal(kWarnColour, Signal::warn, view.trouble);
  if (!view.trouble.empty()) note_item(layout, "setup trouble", view.trouble);
  ImGui::SetCursorPosY(h - 2 * kMargin - foot - pad);
  pad_rows(view, layout, actions);
  ImGui::SetCursorPosY(h - 2 * kMargin - foot);
  setup_buttons(view, layout, actions);
  ImGui::EndDisabled();
  ImGui::PopStyleVar();
  ImGui::PushFont(small_font());
  ImGui::TextDisabled("%s", works ? "Writing .." : "Enter next, Page Up back, Page Down skip, arrows choose, Tab field, Esc leave");
  ImGui::PopFont();
  ImGui::EndChild();
  ImGui::End();
  return works ? SetupActions() : actions;
}

}  // namespace prismesh::kiosk::setup
