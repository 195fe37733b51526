#include "kiosk/tools/shaping/shaping_panel.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "kiosk/input/key_table.h"
#include "kiosk/panels/text.h"
#include "kiosk/panels/widgets.h"
#include "kiosk/tools/shaping/falloff_direction.h"
#include "kiosk/tools/shaping/shaping_keys.h"
#include "mesh/shape/weights.h"

namespace prismesh::kiosk::tools::shaping {
namespace {

using panels::PanelLayout;

using mesh::shape::Profile;
using panels::check;
using panels::kGrid;
using panels::length_text;
using panels::section;

constexpr int kCurveSteps = 48;

/// The profile as it falls from the grab (left) to the border (right).
void draw_profile(const ShapingOptions& options) {
  const float width = ImGui::GetContentRegionAvail().x, height = 7 * kGrid;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, ImVec2(at.x + width, at.y + height), 0x14ffffffu, kGrid / 2);
  mesh::shape::Falloff falloff;
  falloff.profile = options.profile;
  falloff.flat = options.flat;
  for (int i = 0; i <= kCurveSteps; ++i) {
    const double share = static_cast<double>(i) / kCurveSteps;
    const auto weight = static_cast<float>(mesh::shape::evaluate(falloff, 1 - share));
    list.PathLineTo(ImVec2(at.x + static_cast<float>(share) * width, at.y + kGrid + (1 - weight) * (height - 2 * kGrid)));
  }
  list.PathStroke(panels::kInk, 0, 2);
  ImGui::Dummy(ImVec2(width, height));
}

void set_by(const char* label, const std::string& value, ShapingCommand command, PanelLayout& layout) {
  panels::setting(label, value, input::binding_of(kKeys, command_of(command)), layout);
}

std::string name_of_axis(DeckAxis axis, const char* none) {
  return axis == DeckAxis::none ? none : std::string(kDeckAxisNames[static_cast<std::size_t>(axis)]);
}

void direction_rows(const FalloffDirection& now, PanelLayout& layout) {
  set_by("falls off along", now.what, ShapingCommand::along, layout);
  if (!now.in_all()) panels::fact("direction", components_text(now.direction));
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("take it from");
  const std::pair<const char*, ShapingCommand> sources[] = {
      {"nodes", ShapingCommand::along_nodes}, {"edge", ShapingCommand::along_edge}, {"view", ShapingCommand::along_view}};
  for (const auto& [label, command] : sources) {
    ImGui::SameLine();
    if (ImGui::SmallButton(label)) layout.ask(command_of(command));
    panels::hint(input::binding_of(kKeys, command_of(command)));
  }
}

/// Returns the options as the user wants them.
ShapingOptions falloff_section(const ShapingOptions& now, PanelLayout& layout) {
  ShapingOptions wanted = now;
  section("Falloff");
  set_by("moves", is_rigid(now) ? "rigid" : "falloff", ShapingCommand::rigid, layout);
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##profile", std::string(name(now.profile)).c_str())) {
    for (int i = 0; i <= static_cast<int>(Profile::gaussian); ++i)
      if (const auto profile = static_cast<Profile>(i); ImGui::Selectable(std::string(name(profile)).c_str(), profile == now.profile))
        wanted.profile = profile;
    ImGui::EndCombo();
  }
  draw_profile(now);
  auto flat = static_cast<float>(now.flat * 100);
  ImGui::SetNextItemWidth(-1);
  if (ImGui::SliderFloat("##flat", &flat, 0, 100, "flat top %.0f %%")) wanted.flat = std::round(static_cast<double>(flat)) / 100;
  direction_rows(now.along, layout);
  return wanted;
}

}  // namespace

std::optional<ShapingOptions> shaping_panel(const ShapingFacts& facts, PanelLayout& layout) {
  const ShapingOptions& now = facts.options;
  panels::panel_title("Pull", "every pull goes by this");
  const ShapingOptions wanted = falloff_section(now, layout);
  section("Ends and origin");
  set_by("free edges", std::string(name_of(now.free_ends)), ShapingCommand::free_ends, layout);
  check("the whole free edge is the grab", now.origin == mesh::shape::Origin::free_edge, command_of(ShapingCommand::origin), layout);
  check("across welded sheets", now.across_welds, command_of(ShapingCommand::across_welds), layout);
  check("keep parts apart", now.keep_apart, command_of(ShapingCommand::keep_apart), layout);
  check("lift: each along its own normal", now.each_normal, command_of(ShapingCommand::each_normal), layout);
  set_by("moves at most", now.max_move ? length_text(*now.max_move, facts.length_unit) : "no limit", ShapingCommand::move_limit, layout);
  section("Mirror");
  set_by("plane across", name_of_axis(now.symmetry, "off"), ShapingCommand::symmetry, layout);
  if (now.symmetry != DeckAxis::none)
    set_by("stands at", now.symmetry_place ? length_text(*now.symmetry_place, facts.length_unit) : "the selection's middle",
           ShapingCommand::symmetry_place, layout);
  section("By number");
  set_by("typed numbers", std::string(name_of(facts.handle)), ShapingCommand::next_handle, layout);
  set_by("how far", "type it", ShapingCommand::type_number, layout);
  return wanted != now ? std::optional(wanted) : std::nullopt;
}

std::string pull_value(const PullFacts& facts) {
  return facts.degrees ? fmt::format("{:.2f}\u00b0", *facts.degrees) : length_text(facts.length, facts.length_unit);
}

std::string pull_words(const PullFacts& facts) {
  return fmt::format("{} {}   {} {}", facts.what, pull_value(facts), panels::grouped(facts.nodes),
                     facts.nodes == 1 ? "node moves" : "nodes move");
}

}  // namespace prismesh::kiosk::tools::shaping
