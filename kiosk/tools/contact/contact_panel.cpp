#include "kiosk/tools/contact/contact_panel.h"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>
#include <imgui.h>

#include "base/readable_number.h"
#include "kiosk/input/key_table.h"
#include "kiosk/panels/text.h"
#include "kiosk/panels/widgets.h"
#include "kiosk/tools/contact/contact_keys.h"
#include "kiosk/tools/contact/contact_words.h"

namespace prismesh::kiosk::tools::contact {

namespace {

using panels::draw_signal;
using panels::elided_text;
using panels::fact;
using panels::grouped;
using panels::kGrid;
using panels::PanelLayout;
using panels::section;
using panels::Signal;

constexpr std::size_t kRowsInSight = 12;

void chosen_section(const ipc::ContactRegion& region, const std::string& unit) {
  section("This place");
  fact("one side", part_words(region.a, region.name_a) + fmt::format(", {} shells", grouped(region.shells_a)));
  fact("other side", part_words(region.b, region.name_b) + fmt::format(", {} shells", grouped(region.shells_b)));
  fact("depth", depth_words(region, unit));
  if (region.max_depth) fact("mean depth", panels::length_text(region.mean_depth, unit));
  if (region.length > 0) fact("crossing curve", panels::length_text(region.length, unit));
  fact("worst shells", region.worst_a + ", " + region.worst_b);
  fact("joined there", region.joined ? "yes" : "no");
  fact("thickness from", region.thickness_from);
}

}  // namespace

std::optional<std::size_t> contact_panel(const ContactFacts& facts, PanelLayout& layout) {
  std::optional<std::size_t> clicked;
  panels::panel_title("Where parts touch", facts.asking ? "looking .." : "a row goes there");
  const auto button = [&](const char* text, ContactCommand command) {
    if (ImGui::SmallButton(text)) layout.ask(command_of(command));
    panels::hint(input::binding_of(kKeys, command_of(command)));
    ImGui::SameLine();
  };
  button("<", ContactCommand::previous);
  button(">", ContactCommand::next);
  button("look again", ContactCommand::search);
  ImGui::NewLine();
  if (!facts.problem.empty()) ImGui::TextWrapped("%s", panels::printable(facts.problem).c_str());
  if (facts.contacts == nullptr) return clicked;
  const ipc::Contacts& contacts = *facts.contacts;
  if (facts.stale && !facts.asking) ImGui::TextWrapped("of an older state; look again (Ctrl+Shift+K)");
  section("Places, worst first");
  ImGui::TextDisabled("%s", count_words(contacts).c_str());
  const std::uint64_t all = contacts.perforations + contacts.penetrations + contacts.clearances;
  if (contacts.regions.size() < all) ImGui::TextDisabled("listed: %s", grouped(contacts.regions.size()).c_str());
  if (!contacts.regions.empty()) {
    const float height = ImGui::GetTextLineHeightWithSpacing() * static_cast<float>(std::min(contacts.regions.size(), kRowsInSight));
    ImGui::BeginChild("places", ImVec2(0, height + kGrid / 2));
    for (std::size_t i = 0; i < contacts.regions.size(); ++i) {
      const ipc::ContactRegion& region = contacts.regions[i];
      const float left = ImGui::GetCursorPosX();
      const bool is_chosen = facts.chosen == i;
      ImGui::PushID(static_cast<int>(i));
      if (ImGui::Selectable("##place", is_chosen)) clicked = i;
      ImGui::PopID();
      const std::string words = row_words(region, facts.length_unit);
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", region_words(region, facts.length_unit).c_str());
      if (is_chosen && facts.chosen_anew) ImGui::SetScrollHereY();
      ImGui::SameLine();
      ImGui::SetCursorPosX(left);
      draw_signal(region.kind == "perforation" ? Signal::fail : Signal::warn, ImGui::GetFontSize() * 0.65f);
      ImGui::SameLine();
      elided_text(words, ImGui::GetWindowContentRegionMax().x - ImGui::GetCursorPosX());
    }
    ImGui::EndChild();
  }
  if (facts.chosen && *facts.chosen < contacts.regions.size()) chosen_section(contacts.regions[*facts.chosen], facts.length_unit);
  if (!contacts.without_thickness.empty()) {
    section("Not known");
    ImGui::TextWrapped("%s without a thickness: only crossing is found there",
                       contacts.without_thickness.size() == 1 ? fmt::format("part {} is", contacts.without_thickness.front()).c_str()
                                                              : fmt::format("{} parts are", contacts.without_thickness.size()).c_str());
  }
  return clicked;
}

}  // namespace prismesh::kiosk::tools::contact
