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

void picture_section(const std::string& colours, const std::string& profile, PanelLayout& layout) {
  section("Picture");
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("colour by");
  ImGui::SameLine();
  if (ImGui::SmallButton(colours.c_str())) layout.ask(command_of(ViewCommand::colour_mode));
  panels::hint(input::binding_of(kKeys, command_of(ViewCommand::colour_mode)));
  ImGui::TextDisabled("display");
  ImGui::SameLine();
  if (ImGui::SmallButton(profile.c_str())) layout.ask(command_of(ViewCommand::next_profile));
}

void stereo_sections(const StereoFacts& facts, PanelLayout& layout) {
  if (facts.eyes) eyes_section(*facts.eyes);
  if (facts.depth) depth_section(*facts.depth, layout);
}

float stereo_height(const StereoFacts& facts, float width) {
  const float line = ImGui::GetTextLineHeightWithSpacing();
  float height = 0;
  if (facts.eyes) {
    height += line * (2.6f + (facts.eyes->mask.empty() ? 0 : 1) + (facts.eyes->simulated ? 1 : 0));
    ImGui::PushFont(small_font());
    if (!facts.eyes->advice.empty()) height += ImGui::CalcTextSize(facts.eyes->advice.c_str(), nullptr, false, width).y + kGrid / 2;
    ImGui::PopFont();
  }
  if (facts.depth) height += line * 1.6f + 3 * ImGui::GetFrameHeightWithSpacing();
  return height;
}

}  // namespace prismesh::kiosk::tools::view
