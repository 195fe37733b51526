#include "kiosk/tools/selection/select_section.h"

#include <array>
#include <cmath>

#include <imgui.h>

#include "kiosk/input/key_table.h"
#include "kiosk/panels/text.h"
#include "kiosk/panels/widgets.h"
#include "kiosk/tools/selection/selection_keys.h"

namespace prismesh::kiosk::tools::selection {
namespace {

using panels::PanelLayout;

/// Two choices beside a label; a command changes between them.
void choice(const char* label, std::array<const char*, 2> names, bool first, SelectionCommand change, PanelLayout& layout) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", label);
  ImGui::SameLine();
  if (ImGui::RadioButton(names[0], first) && !first) layout.ask(command_of(change));
  ImGui::SameLine();
  if (ImGui::RadioButton(names[1], !first) && first) layout.ask(command_of(change));
}

}  // namespace

const char* bounds_words(mesh::document::RegionBy by) {
  constexpr std::array<const char*, kRegionBounds> kBounds{"features", "single creases", "part", "piece", "free edge"};
  return kBounds[static_cast<std::size_t>(by)];
}

std::optional<RegionSettings> select_section(const SelectFacts& facts, PanelLayout& layout) {
  panels::section("Selection");
  panels::fact("nodes", panels::grouped(facts.nodes));
  if (facts.shells > 0) panels::fact("shells", panels::grouped(facts.shells));
  choice("draw", {"lasso", "rectangle"}, facts.lasso, SelectionCommand::outline_kind, layout);
  choice("takes", {"visible", "through"}, !facts.through, SelectionCommand::toggle_through, layout);
  panels::setting("region", bounds_words(facts.region.by), input::binding_of(kKeys, command_of(SelectionCommand::region_by)), layout);
  std::optional<RegionSettings> wanted;
  if (has_angle(facts.region.by)) {
    auto angle = static_cast<float>(facts.region.angle);
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderFloat("##angle", &angle, 0, 180, "bends over %.0f\u00b0"))
      wanted = RegionSettings{facts.region.by, std::round(static_cast<double>(angle)), facts.region.across_welds};
  }
  panels::check("regions across welds", facts.region.across_welds, command_of(SelectionCommand::region_across_welds), layout);
  return wanted;
}

}  // namespace prismesh::kiosk::tools::selection
