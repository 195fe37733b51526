#include "kiosk/tools/view/view_sections.h"

#include <fmt/format.h>
#include <imgui.h>

#include "kiosk/input/key_table.h"
#include "kiosk/panels/text.h"
#include "kiosk/panels/widgets.h"
#include "kiosk/tools/view/view_keys.h"

namespace prismesh::kiosk::tools::view {
namespace {

using panels::PanelLayout;
using toolkit::EyesFacts;

using panels::draw_signal;
using panels::fact;
using panels::kGrid;
using panels::printable;
using panels::section;
using panels::Signal;
using panels::small_font;

/// How tracked eyes and the mask are: a line when all is well, and what to do about it when it isn't.
void eyes_section(const EyesFacts& eyes) {
  section("Eyes");
  const bool good = eyes.condition == EyesFacts::Condition::good, waiting = eyes.condition == EyesFacts::Condition::waiting;
  draw_signal(good ? Signal::ok : waiting ? Signal::information : Signal::warn, ImGui::GetFontSize() * 0.75f);
  ImGui::SameLine();
  fact(eyes.eyes.c_str(), eyes.in_depth ? "in depth" : "flat");
  if (!eyes.mask.empty()) fact("prism mask", eyes.mask);
  if (eyes.simulated) fact("devices", "simulated");
  if (eyes.advice.empty()) return;
  ImGui::PushFont(small_font());
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(printable(eyes.advice).c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopFont();
}

void depth_row(const char* label, const std::string& value, ViewCommand less, ViewCommand more, PanelLayout& layout) {
  const float button = ImGui::GetFrameHeight(), right = ImGui::GetWindowContentRegionMax().x;
  ImGui::PushID(label);
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", label);
  ImGui::SameLine();
  ImGui::SetCursorPosX(right - 2 * button - 2 * kGrid - ImGui::CalcTextSize(value.c_str()).x);
  ImGui::TextUnformatted(value.c_str());
  ImGui::SameLine();
  ImGui::SetCursorPosX(right - 2 * button - kGrid / 2);
  if (ImGui::Button("-", ImVec2(button, 0))) layout.ask(command_of(less));
  ImGui::SameLine();
  ImGui::SetCursorPosX(right - button);
  if (ImGui::Button("+", ImVec2(button, 0))) layout.ask(command_of(more));
  ImGui::PopID();
}

void depth_section(const DepthFacts& depth, PanelLayout& layout) {
  section("Depth");
  depth_row("strength", fmt::format("{} %", depth.strength_percent), ViewCommand::less_depth, ViewCommand::more_depth, layout);
  depth_row("parallax up to", fmt::format("{:.1f}\u00b0", depth.comfort_degrees), ViewCommand::narrower_comfort, ViewCommand::wider_comfort,
            layout);
  panels::check("selection at the screen", depth.selection_in_plane, command_of(ViewCommand::keep_selection_in_plane), layout);
}

}  // namespace

std::optional<std::string> picture_section(const std::string& colours, const std::string& profile, const std::vector<std::string>& profiles,
                                           PanelLayout& layout) {
  std::optional<std::string> chosen;
  panels::setting("colour by", colours, input::binding_of(kKeys, command_of(ViewCommand::colour_mode)), layout);
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("display");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##display", profile.c_str(), ImGuiComboFlags_HeightLargest)) {
    chosen = profile_entries(profile, profiles, layout);
    ImGui::EndCombo();
  }
  panels::note_item(layout, "display", profile);
  return chosen;
}

void thickness_section(bool thickness, const std::string& note, PanelLayout& layout) {
  panels::setting("shells as", thickness ? "plates" : "surfaces", input::binding_of(kKeys, command_of(ViewCommand::thickness)), layout);
  if (note.empty()) return;
  ImGui::PushFont(small_font());
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(printable(note).c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopFont();
  panels::note_item(layout, "thickness note", note);
}

std::optional<std::string> profile_entries(const std::string& now, const std::vector<std::string>& profiles, PanelLayout& layout) {
  std::optional<std::string> chosen;
  ImGui::Separator();
  for (const std::string& name : profiles) {
    if (ImGui::MenuItem(name.c_str(), nullptr, name == now)) chosen = name;
    panels::note_item(layout, "display " + name, name == now ? "on" : "off");
  }
  return chosen;
}

void stereo_sections(const StereoFacts& facts, PanelLayout& layout) {
  if (facts.eyes) eyes_section(*facts.eyes);
  if (facts.depth) depth_section(*facts.depth, layout);
}

}  // namespace prismesh::kiosk::tools::view
