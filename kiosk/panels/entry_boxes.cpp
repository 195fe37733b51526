// Boxes that are typed into over the picture: an id expression, a number.
#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "kiosk/panels/sections.h"
#include "kiosk/panels/text.h"

namespace prismesh::kiosk::panels {
namespace {

using mesh::document::SelectMode;
using mesh::select::EntityKind;

struct Recall {
  EntryState& entry;
  const std::vector<std::string>& entered;
};

/// Up and down go through what was entered before, and back to what was being typed.
void recall(ImGuiInputTextCallbackData& data, Recall& with) {
  EntryState& entry = with.entry;
  const std::size_t count = with.entered.size();
  if (count == 0) return;
  const std::string now(data.Buf, static_cast<std::size_t>(data.BufTextLen));
  if (data.EventKey == ImGuiKey_UpArrow) {
    if (!entry.recalled) entry.own = now;
    const std::size_t from = std::min(entry.recalled.value_or(count), count);
    if (from == 0) return;
    entry.recalled = from - 1;
  } else {
    if (!entry.recalled) return;
    if (++*entry.recalled >= count) entry.recalled.reset();
  }
  const std::string& text = entry.recalled ? with.entered[*entry.recalled] : entry.own;
  data.DeleteChars(0, data.BufTextLen);
  data.InsertChars(0, text.c_str());
}

int edited(ImGuiInputTextCallbackData* data) {
  Recall& with = *static_cast<Recall*>(data->UserData);
  if (data->EventFlag == ImGuiInputTextFlags_CallbackHistory) {
    recall(*data, with);
  } else if (std::exchange(with.entry.caret_to_end, false)) {
    // A field that takes the keyboard by itself selects all of its text; what was begun is meant to be gone on with.
    data->CursorPos = data->BufTextLen;
    data->ClearSelection();
  }
  return 0;
}

/// The box is there to be typed into: whenever nothing else has the keyboard or the mouse, its field takes it.
void keep_keyboard(EntryState& entry, bool opened) {
  if (!opened && (ImGui::IsAnyItemActive() || ImGui::IsAnyMouseDown())) return;
  entry.caret_to_end = true;
  ImGui::SetKeyboardFocusHere();
}

/// Below the model, between the panels at the sides.
void begin_low(const char* name, display::PixelSize picture, float width) {
  const float free = static_cast<float>(picture.width) - 2 * side_width(picture) - 4 * kMargin;
  ImGui::SetNextWindowPos(ImVec2(std::floor(static_cast<float>(picture.width) / 2), static_cast<float>(picture.height) - 8 * kGrid), 0,
                          ImVec2(0.5f, 1));
  ImGui::SetNextWindowSize(ImVec2(on_grid(std::min(width, free)), 0));
  ImGui::Begin(name, nullptr, kPanelFlags | ImGuiWindowFlags_AlwaysAutoResize);
}

void small_line(const std::string& text, unsigned colour) {
  ImGui::PushFont(small_font());
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
  ImGui::PopFont();
}

/// How many the expression names so far, or what is wrong with it, and a mark under the place.
void count_lines(const ExpressionFacts& facts, const EntryState& entry, float field_x) {
  if (entry.text.empty()) return small_line("1-100, part:3, !17, all   Up and Down bring earlier ones back", kFaintInk);
  if (facts.counted_for != entry.text) return small_line("counting ..", kFaintInk);
  if (!facts.problem.empty()) {
    if (facts.column > 0) {
      const std::string before = entry.text.substr(0, std::min(static_cast<std::size_t>(facts.column - 1), entry.text.size()));
      const ImVec2 at(field_x + ImGui::CalcTextSize(before.c_str()).x, ImGui::GetCursorScreenPos().y - kGrid);
      ImGui::GetWindowDrawList()->AddTriangleFilled(ImVec2(at.x, at.y), ImVec2(at.x + kGrid / 2, at.y + kGrid),
                                                    ImVec2(at.x - kGrid / 2, at.y + kGrid), kFailColour);
    }
    return small_line(printable(facts.problem), kFailColour);
  }
  if (!facts.count) return;
  std::string text = grouped(facts.count->nodes) + " nodes";
  if (entry.kind != EntityKind::node) text += ", " + grouped(facts.count->shells) + " shells";
  if (entry.kind == EntityKind::part) text += ", " + grouped(facts.count->parts) + " parts";
  small_line(text, kInk);
}

}  // namespace

void expression_box(const PanelData& data, display::PixelSize picture, bool opened, EntryState& entry, Actions& actions) {
  if (!data.expression || data.expression->entered == nullptr) return;
  begin_low("Expression", picture, ImGui::GetFontSize() * 44);
  if (opened) entry = EntryState{};
  keep_keyboard(entry, opened);
  ImGui::SetNextItemWidth(-1);
  Recall with{entry, *data.expression->entered};
  const float field_x = ImGui::GetCursorScreenPos().x + ImGui::GetStyle().FramePadding.x;
  const bool entered = ImGui::InputText(
      "##expression", &entry.text,
      ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackHistory | ImGuiInputTextFlags_CallbackAlways, edited, &with);
  constexpr std::array<std::pair<EntityKind, const char*>, 3> kKinds{
      {{EntityKind::node, "nodes"}, {EntityKind::element, "shells"}, {EntityKind::part, "parts"}}};
  count_lines(*data.expression, entry, field_x);
  const EntityKind kind_before = entry.kind;
  for (const auto& [kind, label] : kKinds) {
    if (kind != EntityKind::node) ImGui::SameLine();
    if (ImGui::RadioButton(label, entry.kind == kind)) entry.kind = kind;
  }
  small_line("Enter selects, Shift adds, Ctrl takes away, both keep; Esc closes", kFaintInk);
  if (entry.told != entry.text || entry.kind != kind_before || opened) {
    entry.told = entry.text;
    actions.emplace_back(ExpressionTyped{entry.text, entry.kind});
  }
  if (entered && !entry.text.empty()) {
    const ImGuiIO& io = ImGui::GetIO();
    const SelectMode mode = io.KeyCtrl    ? (io.KeyShift ? SelectMode::intersect : SelectMode::subtract)
                            : io.KeyShift ? SelectMode::add
                                          : SelectMode::set;
    actions.emplace_back(ExpressionEntered{entry.text, entry.kind, mode});
    actions.emplace_back(DialogClosed{});
  }
  ImGui::End();
}

void number_box(const PanelData& data, display::PixelSize picture, bool opened, EntryState& entry, Actions& actions) {
  if (!data.number) return;
  begin_low("Number", picture, ImGui::GetFontSize() * 24);
  if (opened) {
    entry = EntryState{};
    entry.text = data.number->begun;
  }
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(data.number->title.c_str());
  ImGui::SameLine();
  keep_keyboard(entry, opened);
  ImGui::SetNextItemWidth(-1);
  const std::vector<std::string> none;
  Recall with{entry, none};
  const bool entered = ImGui::InputText(
      "##number", &entry.text,
      ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackHistory | ImGuiInputTextFlags_CallbackAlways, edited, &with);
  if (!data.number->problem.empty()) small_line(printable(data.number->problem), kFailColour);
  small_line(data.number->hint + "; Enter does it, Esc doesn't", kFaintInk);
  if (entered) actions.emplace_back(NumberEntered{entry.text});
  ImGui::End();
}

}  // namespace prismesh::kiosk::panels
