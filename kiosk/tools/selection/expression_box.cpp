#include "kiosk/tools/selection/expression_box.h"

#include <algorithm>
#include <array>
#include <utility>

#include <imgui.h>

#include "kiosk/panels/text.h"

namespace prismesh::kiosk::tools::selection {
namespace {

using mesh::document::SelectMode;
using mesh::select::EntityKind;
using panels::grouped;
using panels::kGrid;
using panels::small_line;

/// How many the expression names so far, or what is wrong with it, and a mark under the place.
void count_lines(const ExpressionFacts& facts, const ExpressionEntry& entry, float field_x) {
  const std::string& typed = entry.field.text;
  if (typed.empty()) return small_line("1-100, part:3, !17, all   Up and Down bring earlier ones back", panels::kFaintInk);
  if (facts.counted_for != typed) return small_line("counting ..", panels::kFaintInk);
  if (!facts.problem.empty()) {
    if (facts.column > 0) {
      const std::string before = typed.substr(0, std::min(static_cast<std::size_t>(facts.column - 1), typed.size()));
      const ImVec2 at(field_x + ImGui::CalcTextSize(before.c_str()).x, ImGui::GetCursorScreenPos().y - kGrid);
      ImGui::GetWindowDrawList()->AddTriangleFilled(ImVec2(at.x, at.y), ImVec2(at.x + kGrid / 2, at.y + kGrid),
                                                    ImVec2(at.x - kGrid / 2, at.y + kGrid), panels::kFailColour);
    }
    return small_line(panels::printable(facts.problem), panels::kFailColour);
  }
  if (!facts.count) return;
  std::string text = grouped(facts.count->nodes) + " nodes";
  if (entry.kind != EntityKind::node) text += ", " + grouped(facts.count->shells) + " shells";
  if (entry.kind == EntityKind::part) text += ", " + grouped(facts.count->parts) + " parts";
  small_line(text, panels::kInk);
}

void choose_kind(EntityKind& now) {
  constexpr std::array<std::pair<EntityKind, const char*>, 3> kKinds{
      {{EntityKind::node, "nodes"}, {EntityKind::element, "shells"}, {EntityKind::part, "parts"}}};
  for (const auto& [kind, label] : kKinds) {
    if (kind != EntityKind::node) ImGui::SameLine();
    if (ImGui::RadioButton(label, now == kind)) now = kind;
  }
}

SelectMode mode_of_keys() {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.KeyCtrl) return io.KeyShift ? SelectMode::intersect : SelectMode::subtract;
  return io.KeyShift ? SelectMode::add : SelectMode::set;
}

}  // namespace

ExpressionAsked expression_box(const ExpressionFacts& facts, const panels::Place& room, bool opened, ExpressionEntry& entry) {
  panels::begin_low("Expression", room, ImGui::GetFontSize() * 44);
  if (opened) entry = ExpressionEntry{};
  const float field_x = ImGui::GetCursorScreenPos().x + ImGui::GetStyle().FramePadding.x;
  const bool entered = panels::entry_field("##expression", *facts.earlier, opened, entry.field);
  const std::string& text = entry.field.text;
  count_lines(facts, entry, field_x);
  const EntityKind kind_before = entry.kind;
  choose_kind(entry.kind);
  small_line("Enter selects, Shift adds, Ctrl takes away, both keep; Esc closes", panels::kFaintInk);
  ExpressionAsked asked;
  if (entry.told != text || entry.kind != kind_before || opened) {
    entry.told = text;
    asked.typed = ExpressionTyped{text, entry.kind};
  }
  if (entered && !text.empty()) asked.entered = ExpressionEntered{text, entry.kind, mode_of_keys()};
  ImGui::End();
  return asked;
}

}  // namespace prismesh::kiosk::tools::selection
