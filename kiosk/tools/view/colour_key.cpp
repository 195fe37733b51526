#include "kiosk/tools/view/colour_key.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <imgui.h>

#include "kiosk/panels/layout.h"
#include "kiosk/panels/widgets.h"
#include "kiosk/render/part_looks.h"

namespace prismesh::kiosk::tools::view {

namespace {

using panels::kGrid;
using render::ColourMode;

struct KeyEntry {
  render::Colour from, to;  ///< even where they are the same
  const char* words;
};

std::array<KeyEntry, 3> entries_of(ColourMode colour) {
  const auto& grades = render::grade_colours();
  if (colour == ColourMode::quality)
    return {{{grades[0], grades[0], "passes"}, {grades[1], grades[1], "warns"}, {grades[2], grades[2], "fails"}}};
  // A part's colour is the stronger the more of its shells are wrong.
  return {{{grades[0], grades[0], "all pass"},
           {render::colour_of_state({1000, 1, 0}), render::colour_of_state({1, 1, 0}), "some warn .. 10 %"},
           {render::colour_of_state({1000, 0, 1}), render::colour_of_state({1, 0, 1}), "some fail .. 10 %"}}};
}

ImU32 drawn(const render::Colour& colour) { return ImGui::GetColorU32(ImVec4(colour.x(), colour.y(), colour.z(), 1)); }

}  // namespace

void colour_key(ColourMode colour, panels::PanelLayout& layout) {
  if (colour != ColourMode::quality && colour != ColourMode::part_states) return;
  const panels::Place view = layout.view();
  ImGui::SetNextWindowPos(
      ImVec2(std::floor(static_cast<float>(view.x + view.width / 2)), static_cast<float>(view.bottom()) - panels::kMargin), 0,
      ImVec2(0.5f, 1));
  ImGui::Begin("ColourKey", nullptr, panels::kPanelFlags | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs);
  const char* title = colour == ColourMode::quality ? "Shells" : "Parts by their shells";
  ImGui::TextUnformatted(title);
  const float height = ImGui::GetTextLineHeight(), width = 2 * height;
  bool first = true;
  for (const KeyEntry& entry : entries_of(colour)) {
    if (!first) ImGui::SameLine(0, 3 * kGrid);
    first = false;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddRectFilledMultiColor(at, ImVec2(at.x + width, at.y + height), drawn(entry.from), drawn(entry.to),
                                                        drawn(entry.to), drawn(entry.from));
    ImGui::Dummy(ImVec2(width, height));
    ImGui::SameLine(0, kGrid);
    ImGui::TextUnformatted(entry.words);
  }
  panels::note_item(layout, "colour key", title);
  layout.bottom = std::min(layout.bottom, static_cast<double>(ImGui::GetWindowPos().y) - static_cast<double>(kGrid));
  ImGui::End();
}

}  // namespace prismesh::kiosk::tools::view
