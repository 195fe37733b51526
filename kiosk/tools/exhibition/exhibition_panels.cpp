#include "kiosk/tools/exhibition/exhibition_panels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/counted.h"
#include "kiosk/panels/layout.h"
#include "kiosk/panels/text.h"
#include "kiosk/panels/widgets.h"

namespace prismesh::kiosk::tools::exhibition {

namespace {

using panels::kGrid;
using panels::kMargin;
using panels::PanelLayout;
using panels::printable;

constexpr float kCardWidthInFonts = 26;
constexpr float kKeyInFonts = 3;  ///< side of a key of the pad
constexpr std::size_t kLongestPin = 64;
constexpr ImGuiWindowFlags kCardFlags = panels::kPanelFlags | ImGuiWindowFlags_AlwaysAutoResize;

/// Where a card stands: a corner, or the middle.
void begin_card(const char* name, const ImVec2& at, const ImVec2& pivot, float width, ImGuiWindowFlags flags) {
  ImGui::SetNextWindowPos(ImVec2(std::floor(at.x), std::floor(at.y)), 0, pivot);
  ImGui::SetNextWindowSize(ImVec2(width, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(kMargin, kMargin));
  ImGui::Begin(name, nullptr, flags);
  ImGui::PopStyleVar();
}

float card_width(const panels::Place& view) { return std::min(kCardWidthInFonts * ImGui::GetFontSize(), view.width - 2 * kMargin); }

void title(const std::string& words) {
  ImGui::PushFont(panels::title_font());
  ImGui::TextWrapped("%s", printable(words).c_str());
  ImGui::PopFont();
}

/// A button as large as a finger.
bool large_button(const char* label) {
  const float font = ImGui::GetFontSize();
  return ImGui::Button(label, ImVec2(ImGui::CalcTextSize(label).x + 3 * font, 2.5F * font));
}

}  // namespace

void show_card(const ShowCard& card, PanelLayout& layout) {
  const panels::Place view = layout.view();
  if (!card.title.empty() || !card.words.empty()) {
    begin_card("ShowCard", ImVec2(view.x + kMargin, static_cast<float>(layout.bottom)), ImVec2(0, 1), card_width(view),
               kCardFlags | ImGuiWindowFlags_NoInputs);
    if (!card.title.empty()) title(card.title);
    if (!card.words.empty()) ImGui::TextWrapped("%s", printable(card.words).c_str());
    ImGui::End();
  }
  begin_card("TryIt", ImVec2(view.x + view.width / 2, static_cast<float>(layout.top) + kMargin), ImVec2(0.5F, 0), 0,
             kCardFlags | ImGuiWindowFlags_NoInputs);
  ImGui::PushFont(panels::title_font());
  ImGui::TextUnformatted("Touch anything to try it yourself");
  ImGui::PopFont();
  panels::note_item(layout, "exhibition show", card.title);
  ImGui::End();
}

void warning_card(int seconds, PanelLayout& layout) {
  const panels::Place view = layout.view();
  begin_card("StillThere", ImVec2(view.x + view.width / 2, view.y + view.height / 2), ImVec2(0.5F, 0.5F), card_width(view), kCardFlags);
  title("Are you still there?");
  ImGui::TextWrapped("%s",
                     fmt::format("In {} the model goes back to how it was.", counted(static_cast<std::size_t>(seconds), "second")).c_str());
  ImGui::Dummy(ImVec2(0, kGrid));
  large_button("Stay");  // any touch keeps the visit: what is pressed does nothing more
  panels::note_item(layout, "exhibition stay", std::to_string(seconds));
  ImGui::End();
}

bool staff_button(PanelLayout& layout) {
  const panels::Place view = layout.view();
  ImGui::SetNextWindowPos(ImVec2(view.right() - kGrid, view.bottom() - kGrid), 0, ImVec2(1, 1));
  ImGui::Begin("Staff", nullptr, kCardFlags);
  ImGui::PushFont(panels::small_font());
  const bool pressed = ImGui::Button("staff");
  ImGui::PopFont();
  panels::note_item(layout, "exhibition staff", "");
  ImGui::End();
  return pressed;
}

UnlockedAsked unlocked_card(PanelLayout& layout) {
  const panels::Place view = layout.view();
  UnlockedAsked asked = UnlockedAsked::nothing;
  begin_card("Unlocked", ImVec2(view.right() - kGrid, view.y + kGrid), ImVec2(1, 0), 0, kCardFlags);
  ImGui::TextUnformatted("The exhibition is unlocked: files can be opened and saved.");
  if (large_button("Lock")) asked = UnlockedAsked::lock;
  panels::note_item(layout, "exhibition lock", "");
  ImGui::SameLine();
  if (large_button("End the program")) asked = UnlockedAsked::leave;
  panels::note_item(layout, "exhibition leave", "");
  ImGui::End();
  return asked;
}

PinAsked pin_pad(const PinFacts& facts, bool opened, PanelLayout& layout, PinEntry& entry) {
  const panels::Place view = layout.view();
  PinAsked asked = PinAsked::nothing;
  begin_card("Pin", ImVec2(view.x + view.width / 2, view.y + view.height / 2), ImVec2(0.5F, 0.5F), 0, kCardFlags);
  title("PIN");
  if (!facts.has_pin) ImGui::TextUnformatted("The settings have no PIN: the exhibition is ended from outside.");
  const std::string state = facts.wait_s > 0
                                ? fmt::format("Wrong too often: wait {}.", counted(static_cast<std::size_t>(facts.wait_s), "second"))
                            : entry.wrong ? std::string("That isn't the PIN.")
                                          : std::string("Type it, or press the keys.");
  ImGui::TextUnformatted(state.c_str());
  ImGui::BeginDisabled(!facts.has_pin || facts.wait_s > 0);
  const float key = kKeyInFonts * ImGui::GetFontSize();
  ImGui::SetNextItemWidth(3 * key + 2 * ImGui::GetStyle().ItemSpacing.x);
  if (opened) ImGui::SetKeyboardFocusHere();
  if (ImGui::InputText("##pin", &entry.typed, ImGuiInputTextFlags_Password | ImGuiInputTextFlags_EnterReturnsTrue)) asked = PinAsked::enter;
  if (entry.typed.size() > kLongestPin) entry.typed.resize(kLongestPin);
  constexpr std::array kKeys{"1", "2", "3", "4", "5", "6", "7", "8", "9", "<", "0", "OK"};
  for (std::size_t i = 0; i < kKeys.size(); ++i) {
    if (i % 3 != 0) ImGui::SameLine();
    const bool pressed = ImGui::Button(kKeys[i], ImVec2(key, key));
    panels::note_item(layout, std::string("pin ") + kKeys[i], "");
    if (!pressed) continue;
    if (i == 9 && !entry.typed.empty()) entry.typed.pop_back();
    if (i == 11) asked = PinAsked::enter;
    if (i != 9 && i != 11 && entry.typed.size() < kLongestPin) entry.typed += kKeys[i];
  }
  ImGui::EndDisabled();
  if (large_button("Back")) asked = PinAsked::cancel;
  panels::note_item(layout, "pin back", state);
  ImGui::End();
  return asked;
}

}  // namespace prismesh::kiosk::tools::exhibition
