#include "kiosk/tools/quality/criteria_section.h"

#include <algorithm>

#include <imgui.h>

#include "kiosk/panels/layout.h"
#include "kiosk/panels/text.h"
#include "mesh/document/edit.h"
#include "mesh/quality/criteria.h"

namespace prismesh::kiosk::tools::quality {

namespace {

using panels::printable;

constexpr std::size_t kMaxOwnRows = 4;

/// A tooltip with the whole path over the item before, if it is of a file.
void whole_path_hint(const std::string& criteria) {
  if (ImGui::IsItemHovered() && !mesh::quality::is_built_in_criteria(criteria)) ImGui::SetTooltip("%s", printable(criteria).c_str());
}

void choice_row(const CriteriaFacts& facts, QualityActions& actions) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", facts.of_selection ? "selection's parts" : "all parts");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##criteria", "choose ..")) {
    if (ImGui::IsWindowAppearing()) actions.emplace_back(CriteriaListed{});
    if (!facts.own.empty() && ImGui::Selectable("the deck's"))
      actions.emplace_back(CriteriaChosen{std::string(mesh::document::kDeckCriteria)});
    for (const std::string& criteria : facts.known) {
      ImGui::PushID(criteria.c_str());
      if (ImGui::Selectable(printable(short_criteria(criteria)).c_str())) actions.emplace_back(CriteriaChosen{criteria});
      ImGui::PopID();
      whole_path_hint(criteria);
    }
    ImGui::EndCombo();
  }
}

/// The parts with criteria of their own.
void own_rows(const CriteriaFacts& facts) {
  for (std::size_t i = 0; i < std::min(facts.own.size(), kMaxOwnRows); ++i) {
    const auto& [criteria, parts] = facts.own[i];
    panels::fact(("part " + parts).c_str(), printable(short_criteria(criteria)));
    whole_path_hint(criteria);
  }
  if (facts.own.size() > kMaxOwnRows) ImGui::TextDisabled("and %zu more", facts.own.size() - kMaxOwnRows);
}

}  // namespace

void criteria_section(const CriteriaFacts& facts, QualityActions& actions) {
  panels::section("Criteria");
  panels::fact(facts.own.empty() ? "of all parts" : "the deck's", printable(short_criteria(facts.of_deck)));
  whole_path_hint(facts.of_deck);
  if (!facts.own.empty()) own_rows(facts);
  choice_row(facts, actions);
}

}  // namespace prismesh::kiosk::tools::quality
