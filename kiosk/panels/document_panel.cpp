#include <array>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <imgui.h>

#include "kiosk/panels/sections.h"
#include "kiosk/panels/text.h"

namespace prismesh::kiosk::panels {
namespace {

using tools::Command;

constexpr std::uint64_t kMegabyte = 1U << 20;

std::string guessed(const std::string& value, bool is_guess) { return is_guess ? value + " (guessed)" : value; }

void selecting_section(const SelectFacts& facts, Actions& actions) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("draw");
  ImGui::SameLine();
  if (ImGui::RadioButton("lasso", facts.lasso) && !facts.lasso) actions.emplace_back(Command::outline_kind);
  ImGui::SameLine();
  if (ImGui::RadioButton("rectangle", !facts.lasso) && facts.lasso) actions.emplace_back(Command::outline_kind);
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("takes");
  ImGui::SameLine();
  if (ImGui::RadioButton("visible", !facts.through) && facts.through) actions.emplace_back(Command::toggle_through);
  ImGui::SameLine();
  if (ImGui::RadioButton("through", facts.through) && !facts.through) actions.emplace_back(Command::toggle_through);
  constexpr std::array<const char*, 4> kBounds{"creases", "part", "piece", "free edge"};
  setting("region", kBounds[static_cast<std::size_t>(facts.by)], Command::region_by, actions);
  if (facts.by == mesh::document::RegionBy::features) {
    auto angle = static_cast<float>(facts.angle);
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderFloat("##angle", &angle, 0, 180, "creases over %.0f\u00b0"))
      actions.emplace_back(SetRegion{facts.by, std::round(static_cast<double>(angle)), facts.across_welds});
  }
  bool welds = facts.across_welds;
  if (ImGui::Checkbox("regions across welds", &welds)) actions.emplace_back(Command::region_across_welds);
}

/// What is being pulled, and how far.
void pull_section(const PanelData& data) {
  section(data.pull->what.c_str());
  if (data.pull->degrees)
    fact("angle", fmt::format("{:.2f}\u00b0", *data.pull->degrees));
  else
    fact("distance", length_text(data.pull->length, data.document->length_unit));
  fact("nodes that move", grouped(data.pull->nodes));
}

void picture_section(const PanelData& data, Actions& actions) {
  section("Picture");
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("colour by");
  ImGui::SameLine();
  const bool field = data.compare && !data.compare->wish.field.empty();
  const char* colour = field ? "values" : data.colour_by_quality ? "quality" : data.colour_by_state ? "parts' state" : "part";
  if (ImGui::SmallButton(colour)) actions.emplace_back(Command::colour_mode);
  hint(Command::colour_mode);
  ImGui::TextDisabled("display");
  ImGui::SameLine();
  if (ImGui::SmallButton(data.profile.c_str())) actions.emplace_back(Command::next_profile);

  if (data.history_cap > 0) {
    section("History");
    fact("kept for undo",
         fmt::format("{:.1f} of {} MB", static_cast<double>(data.history_bytes) / kMegabyte, data.history_cap / kMegabyte));
  }
}

}  // namespace

void document_panel(const PanelData& data, display::PixelSize picture, Actions& actions) {
  const DocumentFacts& document = *data.document;
  begin_left("Document", picture);
  const float width = ImGui::GetContentRegionAvail().x;
  const std::filesystem::path path(document.path);
  ImGui::PushFont(title_font());
  elided_text(printable(path.filename().string()), width);
  ImGui::PopFont();
  ImGui::PushFont(small_font());
  ImGui::PushStyleColor(ImGuiCol_Text, kFaintInk);
  elided_text(printable(path.parent_path().string()), width);
  ImGui::PopStyleColor();
  ImGui::TextUnformatted(document.changed ? "unsaved edits" : "no unsaved edits");
  ImGui::PopFont();

  section("Model");
  fact("shells", grouped(document.shells));
  fact("nodes", grouped(document.nodes));
  fact("parts", grouped(document.parts.size()));
  fact("length unit", guessed(document.length_unit, document.length_unit_guessed));
  fact("target size", guessed(length_text(document.target_size, document.length_unit), document.target_size_guessed));
  fact("generation", grouped(document.generation));

  section("Selection");
  fact("nodes", grouped(document.selected_nodes));
  if (document.selected_shells > 0) fact("shells", grouped(document.selected_shells));
  selecting_section(data.selecting, actions);

  // What is pulled needs the room.
  if (data.pull)
    pull_section(data);
  else
    picture_section(data, actions);
  ImGui::Dummy(ImVec2(0, kGrid / 2));
  ImGui::PushFont(small_font());
  ImGui::TextDisabled("F1 keys   F10 menu   J quality");
  ImGui::PopFont();
  ImGui::End();
}

}  // namespace prismesh::kiosk::panels
