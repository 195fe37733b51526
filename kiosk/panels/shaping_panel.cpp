#include <array>

#include <fmt/format.h>
#include <imgui.h>

#include "kiosk/panels/sections.h"
#include "kiosk/panels/text.h"
#include "mesh/shape/weights.h"

namespace prismesh::kiosk::panels {
namespace {

using mesh::shape::Profile;
using tools::Command;
using tools::ShapingOptions;

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
  list.PathStroke(kInk, 0, 2);
  ImGui::Dummy(ImVec2(width, height));
}

void falloff_section(const ShapingOptions& now, Actions& actions) {
  ShapingOptions wanted = now;
  section("Falloff");
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
  setting("falls off along",
          now.along == tools::DeckAxis::none ? "all ways" : std::string(tools::kDeckAxisNames[static_cast<std::size_t>(now.along)]),
          Command::along, actions);
  if (wanted != now) actions.emplace_back(SetShaping{wanted});
}

void check(const char* label, bool value, Command toggle, Actions& actions) {
  bool now = value;
  if (ImGui::Checkbox(label, &now)) actions.emplace_back(toggle);
}

}  // namespace

void shaping_panel(const PanelData& data, display::PixelSize picture, Actions& actions) {
  const ShapingOptions& now = data.shaping;
  const std::string& unit = data.document->length_unit;
  begin_left("Shaping", picture);
  ImGui::PushFont(title_font());
  ImGui::TextUnformatted("Shaping");
  ImGui::PopFont();
  ImGui::PushFont(small_font());
  ImGui::TextDisabled("T closes; every pull goes by this");
  ImGui::PopFont();
  falloff_section(now, actions);
  section("Ends and origin");
  check("free edges follow", now.free_ends, Command::free_ends, actions);
  check("the whole free edge is the grab", now.origin == mesh::shape::Origin::free_edge, Command::origin, actions);
  check("across welded sheets", now.across_welds, Command::weights_across_welds, actions);
  check("lift: each along its own normal", now.each_normal, Command::each_normal, actions);
  setting("moves at most", now.max_move ? length_text(*now.max_move, unit) : "no limit", Command::move_limit, actions);
  section("Mirror");
  setting("plane across",
          now.symmetry == tools::DeckAxis::none ? "off" : std::string(tools::kDeckAxisNames[static_cast<std::size_t>(now.symmetry)]),
          Command::symmetry, actions);
  if (now.symmetry != tools::DeckAxis::none)
    setting("stands at", now.symmetry_place ? length_text(*now.symmetry_place, unit) : "the selection's middle", Command::symmetry_place,
            actions);
  section("By number");
  setting("typed numbers", std::string(tools::name_of(data.tool)), Command::next_tool, actions);
  setting("how far", "type it", Command::type_number, actions);
  ImGui::End();
}

}  // namespace prismesh::kiosk::panels
