#include "kiosk/panels/wizard_panel.h"

#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

#include "kiosk/panels/layout.h"

namespace prismesh::kiosk::panels {
namespace {

using WizardActions = std::vector<WizardAction>;

/// A button that a fingertip finds.
bool wide_button(const std::string& label, float width) { return ImGui::Button(label.c_str(), ImVec2(width, 1.7f * ImGui::GetFontSize())); }

void title_row(const WizardFacts& facts) {
  ImGui::PushFont(title_font());
  ImGui::TextUnformatted(facts.title.c_str());
  ImGui::PopFont();
  const std::string count = fmt::format("page {} of {}", facts.number, facts.count);
  ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(count.c_str()).x);
  ImGui::TextDisabled("%s", count.c_str());
}

void value_row(const WizardFacts& facts, WizardActions& actions) {
  if (facts.value.empty()) return;
  const float width = 2.6f * ImGui::GetFontSize();
  const struct {
    const char* label;
    WizardAction action;
  } before[] = {{"<<", WizardAction::much_less}, {"<", WizardAction::less}},
    after[] = {{">", WizardAction::more}, {">>", WizardAction::much_more}};
  ImGui::PushButtonRepeat(true);
  for (const auto& button : before) {
    if (wide_button(button.label, width)) actions.push_back(button.action);
    ImGui::SameLine();
  }
  ImGui::PushFont(title_font());
  const float room = 9 * ImGui::GetFontSize(), text = ImGui::CalcTextSize(facts.value.c_str()).x;
  const float start = ImGui::GetCursorPosX();
  ImGui::SetCursorPosX(start + std::max(0.0f, 0.5f * (room - text)));
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(facts.value.c_str());
  ImGui::PopFont();
  ImGui::SameLine(start + room);
  for (const auto& button : after) {
    if (wide_button(button.label, width)) actions.push_back(button.action);
    ImGui::SameLine();
  }
  ImGui::PopButtonRepeat();
  ImGui::NewLine();
}

void coloured(unsigned colour, Signal signal, const std::string& text) {
  draw_signal(signal, 0.7f * ImGui::GetFontSize());
  ImGui::SameLine();
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
}

void button_row(const WizardFacts& facts, WizardActions& actions) {
  const float width = on_grid(9 * ImGui::GetFontSize());
  if (wide_button("Leave", width)) actions.push_back(WizardAction::leave);
  ImGui::SameLine();
  ImGui::BeginDisabled(facts.first);
  if (wide_button("Back", width)) actions.push_back(WizardAction::back);
  ImGui::EndDisabled();
  ImGui::SameLine(ImGui::GetContentRegionMax().x - width);
  ImGui::PushStyleColor(ImGuiCol_Text, kActiveColour);
  if (wide_button(facts.next, width)) actions.push_back(WizardAction::next);
  ImGui::PopStyleColor();
}

}  // namespace

WizardActions wizard_panel(const WizardFacts& facts, display::PixelSize picture) {
  WizardActions actions;
  const auto w = static_cast<float>(picture.width), h = static_cast<float>(picture.height);
  const float width = on_grid(std::min(0.9f * w, 40 * ImGui::GetFontSize()));
  ImGui::SetNextWindowPos(ImVec2(on_grid(0.5f * (w - width)), h - kMargin), ImGuiCond_Always, ImVec2(0, 1));
  ImGui::SetNextWindowSize(ImVec2(width, 0));
  // The patterns behind it flicker with every pixel column: nothing of them may come through the text.
  ImGui::SetNextWindowBgAlpha(1);
  ImGui::Begin("Calibration", nullptr, kPanelFlags | ImGuiWindowFlags_AlwaysAutoResize);
  title_row(facts);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(facts.task.c_str());
  value_row(facts, actions);
  for (const std::string& remark : facts.remarks) coloured(kInformationColour, Signal::information, remark);
  if (!facts.trouble.empty()) coloured(kWarnColour, Signal::warn, facts.trouble);
  ImGui::PopTextWrapPos();
  button_row(facts, actions);
  ImGui::PushFont(small_font());
  ImGui::TextDisabled("Arrow keys turn, with Shift farther; Enter goes on, Backspace back, Esc leaves");
  ImGui::PopFont();
  ImGui::End();
  return actions;
}

}  // namespace prismesh::kiosk::panels
