#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

#include "kiosk/panels/sections.h"
#include "kiosk/panels/text.h"
#include "kiosk/tools/file_expression.h"

namespace prismesh::kiosk::panels {
namespace {

using mesh::document::VisibilityAction;
using mesh::quality::Counts;
using tools::Command;

void quality_row(const char* label, Signal signal, std::size_t before, const std::optional<std::size_t>& now) {
  draw_signal(signal, ImGui::GetFontSize() * 0.75f);
  ImGui::SameLine();
  std::string value = grouped(before);
  if (now && *now != before) value += " \u2192 " + grouped(*now);
  fact(label, value);
}

void quality_section(const PanelData& data) {
  const Counts& before = data.document->counts;
  std::optional<std::size_t> ok, warn, failed;
  if (data.pull && data.pull->counts) {
    ok = data.pull->counts->ok;
    warn = data.pull->counts->warn;
    failed = data.pull->counts->fail;
  }
  ImGui::TextUnformatted("Shell quality");
  quality_row("ok", Signal::ok, before.ok, ok);
  quality_row("warn", Signal::warn, before.warn, warn);
  quality_row("fail", Signal::fail, before.fail, failed);
  ImGui::PushFont(small_font());
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  if (!data.signs.empty()) ImGui::TextWrapped("%s", data.signs.c_str());
  if (data.glyphs_left_out > 0) ImGui::TextWrapped("%s more marks than can be drawn", grouped(data.glyphs_left_out).c_str());
  ImGui::PopStyleColor();
  ImGui::PopFont();
}

/// A padlock, closed or (faint) open; true when clicked.
bool lock_button(bool locked) {
  const float size = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const bool clicked = ImGui::InvisibleButton("lock", ImVec2(size, size));
  const unsigned colour = locked ? kInk : (ImGui::IsItemHovered() ? kFaintInk : 0x60aaa6a2u);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float x = at.x + size * 0.25f, y = at.y + size * 0.5f, w = size * 0.5f;
  list.AddRectFilled(ImVec2(x, y), ImVec2(x + w, y + size * 0.38f), colour, 1);
  const float radius = w * 0.34f, cx = x + w / 2 + (locked ? 0 : w * 0.5f);
  list.PathArcTo(ImVec2(cx, y), radius, 3.14159f, 6.28318f, 12);
  list.PathStroke(colour, 0, size * 0.1f);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip(locked ? "locked: its nodes don't move" : "lock: its nodes shall not move");
  return clicked;
}

void part_row(const PartRow& part, Actions& actions) {
  ImGui::PushID(static_cast<int>(part.id & 0x7fffffff));
  const float line = ImGui::GetTextLineHeight(), right = ImGui::GetWindowContentRegionMax().x;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  if (ImGui::InvisibleButton("show", ImVec2(line, line)))
    actions.emplace_back(AskParts{std::to_string(part.id), part.hidden ? VisibilityAction::show : VisibilityAction::hide});
  if (ImGui::IsItemHovered()) ImGui::SetTooltip(part.hidden ? "hidden: show" : "shown: hide");
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 low(at.x + line * 0.15f, at.y + line * 0.15f), high(at.x + line * 0.85f, at.y + line * 0.85f);
  if (part.hidden)
    list.AddRect(low, high, part.colour, 2, 0, 1.5f);
  else
    list.AddRectFilled(low, high, part.colour, 2);
  ImGui::SameLine();

  const float only_width = ImGui::CalcTextSize("only").x, only_x = right - line - kGrid - only_width;
  const std::string label = part.name.empty() ? fmt::format("part {}", part.id) : fmt::format("{}  {}", part.id, printable(part.name));
  const std::string shells = grouped(part.shells);
  const float shells_width = ImGui::CalcTextSize(shells.c_str()).x;
  const float name_width = only_x - kGrid - shells_width - kGrid - ImGui::GetCursorPosX();
  if (part.hidden) ImGui::PushStyleColor(ImGuiCol_Text, kFaintInk);
  elided_text(label, name_width);
  if (part.hidden) ImGui::PopStyleColor();
  ImGui::SameLine();
  ImGui::SetCursorPosX(only_x - kGrid - shells_width);
  ImGui::TextDisabled("%s", shells.c_str());
  ImGui::SameLine();
  ImGui::SetCursorPosX(only_x);
  const ImVec2 only_at = ImGui::GetCursorScreenPos();
  if (ImGui::InvisibleButton("only", ImVec2(only_width, line)))
    actions.emplace_back(AskParts{std::to_string(part.id), VisibilityAction::only});
  list.AddText(only_at, ImGui::IsItemHovered() ? kInk : 0x80aaa6a2u, "only");
  ImGui::SameLine();
  ImGui::SetCursorPosX(right - line);
  if (lock_button(part.locked))
    actions.emplace_back(AskParts{std::to_string(part.id), part.locked ? VisibilityAction::unlock : VisibilityAction::lock});
  ImGui::PopID();
}

/// How tracked eyes and the mask are: a line when all is well, and what to do about it when it isn't.
void eyes_section(const EyesFacts& eyes) {
  section("Eyes");
  const bool good = eyes.state == EyesFacts::State::good, waiting = eyes.state == EyesFacts::State::waiting;
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

void depth_row(const char* label, const std::string& value, Command less, Command more, Actions& actions) {
  const float button = ImGui::GetFrameHeight(), right = ImGui::GetWindowContentRegionMax().x;
  ImGui::PushID(label);
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", label);
  ImGui::SameLine();
  ImGui::SetCursorPosX(right - 2 * button - 2 * kGrid - ImGui::CalcTextSize(value.c_str()).x);
  ImGui::TextUnformatted(value.c_str());
  ImGui::SameLine();
  ImGui::SetCursorPosX(right - 2 * button - kGrid / 2);
  if (ImGui::Button("-", ImVec2(button, 0))) actions.emplace_back(less);
  ImGui::SameLine();
  ImGui::SetCursorPosX(right - button);
  if (ImGui::Button("+", ImVec2(button, 0))) actions.emplace_back(more);
  ImGui::PopID();
}

void depth_section(const DepthFacts& depth, Actions& actions) {
  section("Depth");
  depth_row("strength", fmt::format("{} %", depth.strength_percent), Command::less_depth, Command::more_depth, actions);
  depth_row("parallax up to", fmt::format("{:.1f}\u00b0", depth.comfort_degrees), Command::narrower_comfort, Command::wider_comfort,
            actions);
  bool kept = depth.selection_in_plane;
  if (ImGui::Checkbox("selection at the screen", &kept)) actions.emplace_back(Command::keep_selection_in_plane);
}

/// How high the two sections above will be, so that the panel fits its content.
float stereo_height(const PanelData& data, float width) {
  const float line = ImGui::GetTextLineHeightWithSpacing();
  float height = 0;
  if (data.eyes) {
    height += line * (2.6f + (data.eyes->mask.empty() ? 0 : 1) + (data.eyes->simulated ? 1 : 0));
    ImGui::PushFont(small_font());
    if (!data.eyes->advice.empty()) height += ImGui::CalcTextSize(data.eyes->advice.c_str(), nullptr, false, width).y + kGrid / 2;
    ImGui::PopFont();
  }
  if (data.depth) height += line * 1.6f + 3 * ImGui::GetFrameHeightWithSpacing();
  return height;
}

/// What can be done with all parts of a file: small words behind its name.
void file_row(const FileRow& file, Actions& actions) {
  ImGui::PushID(file.name.c_str());
  const std::string on = tools::file_expression(file.name);
  const float line = ImGui::GetTextLineHeight(), right = ImGui::GetWindowContentRegionMax().x;
  const float only_width = ImGui::CalcTextSize("only").x, hide_width = ImGui::CalcTextSize("show").x;
  const float only_x = right - line - kGrid - only_width, hide_x = only_x - kGrid - hide_width;
  elided_text(printable(file.name), hide_x - kGrid - ImGui::GetCursorPosX());
  const auto word = [&](const char* text, float x, float width) {
    ImGui::SameLine();
    ImGui::SetCursorPosX(x);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool clicked = ImGui::InvisibleButton(text, ImVec2(width, line));
    ImGui::GetWindowDrawList()->AddText(at, ImGui::IsItemHovered() ? kInk : 0x80aaa6a2u, text);
    return clicked;
  };
  if (word(file.hidden ? "show" : "hide", hide_x, hide_width))
    actions.emplace_back(AskParts{on, file.hidden ? VisibilityAction::show : VisibilityAction::hide});
  if (word("only", only_x, only_width)) actions.emplace_back(AskParts{on, VisibilityAction::only});
  ImGui::SameLine();
  ImGui::SetCursorPosX(right - line);
  if (lock_button(file.locked)) actions.emplace_back(AskParts{on, file.locked ? VisibilityAction::unlock : VisibilityAction::lock});
  ImGui::PopID();
}

/// The rows of files and parts together, so that a deck of hundreds of either still scrolls lightly.
void rows(const DocumentFacts& document, Actions& actions) {
  // One file is the deck itself.
  const std::size_t files = document.files.size() > 1 ? document.files.size() : 0;
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(files + document.parts.size()));
  while (clipper.Step())
    for (auto i = static_cast<std::size_t>(clipper.DisplayStart); i < static_cast<std::size_t>(clipper.DisplayEnd); ++i)
      i < files ? file_row(document.files[i], actions) : part_row(document.parts[i - files], actions);
}

}  // namespace

void model_panel(const PanelData& data, display::PixelSize picture, Actions& actions) {
  const float width = side_width(picture), most = static_cast<float>(picture.height) - 2 * kMargin;
  ImGui::SetNextWindowPos(ImVec2(static_cast<float>(picture.width) - kMargin - width, kMargin));
  const std::size_t files = data.document->files.size() > 1 ? data.document->files.size() : 0;
  const auto row_count = static_cast<float>(data.document->parts.size() + files);
  const float line = ImGui::GetTextLineHeightWithSpacing();
  ImGui::SetNextWindowSize(
      ImVec2(width, std::min(most, on_grid(line * (row_count + 7.0f) + 4 * kGrid + stereo_height(data, width - 4 * kGrid)))));
  ImGui::Begin("Quality and parts", nullptr, kPanelFlags);
  quality_section(data);
  if (data.eyes) eyes_section(*data.eyes);
  if (data.depth) depth_section(*data.depth, actions);
  section(files > 0 ? "Files and parts" : "Parts");
  const auto hidden =
      std::count_if(data.document->parts.begin(), data.document->parts.end(), [](const PartRow& part) { return part.hidden; });
  if (hidden > 0) {
    const std::string label = fmt::format("show all ({} hidden)", hidden);
    ImGui::SameLine();
    ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(label.c_str()).x - 2 * kGrid);
    if (ImGui::SmallButton(label.c_str())) actions.emplace_back(Command::show_all);
  }
  ImGui::BeginChild("list");
  rows(*data.document, actions);
  ImGui::EndChild();
  ImGui::End();
}

}  // namespace prismesh::kiosk::panels
