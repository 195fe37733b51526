#include "kiosk/tools/comparison/legend.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/counted.h"
#include "base/readable_number.h"
#include "kiosk/panels/layout.h"
#include "kiosk/panels/text.h"
#include "kiosk/panels/widgets.h"

namespace prismesh::kiosk::tools::comparison {

namespace {

using panels::kGrid;
using panels::kInk;
using panels::printable;

constexpr int kBarSteps = 96;
constexpr double kDragsAcross = 300;  ///< pixels of the pointer for all of the map

ImU32 packed(const render::Colour& colour) { return ImGui::GetColorU32(ImVec4(colour.x(), colour.y(), colour.z(), 1)); }

std::string short_number(double value) { return readable(value, 4); }

bool large_is_worse(const render::FieldLook& look) { return look.full >= look.clear; }

void draw_notch(ImDrawList& list, float x, float y, ImU32 colour) {
  list.AddTriangleFilled(ImVec2(x - 5, y + 7), ImVec2(x + 5, y + 7), ImVec2(x, y), colour);
}

/// The map from where it begins to the limit with its ticks; notches where the worst value is, and the one under the pointer.
void draw_bar(const LegendFacts& facts, float width) {
  const float height = 2 * kGrid;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const render::FieldLook& look = facts.look;
  for (int i = 0; i < kBarSteps; ++i) {
    const double value = look.clear + (look.full - look.clear) * (i + 0.5) / kBarSteps;
    const float from = at.x + width * static_cast<float>(i) / kBarSteps, to = at.x + width * static_cast<float>(i + 1) / kBarSteps;
    if (const auto colour = look.colour_of(value))
      list.AddRectFilled(ImVec2(from, at.y), ImVec2(to + 0.5f, at.y + height), packed(*colour));
  }
  const auto place = [&](double value) { return at.x + width * static_cast<float>((value - look.clear) / (look.full - look.clear)); };
  const auto on_bar = [&](float x) { return x >= at.x && x <= at.x + width; };
  ImGui::PushFont(panels::small_font());
  float free_from = at.x;
  for (const double tick : ticks(look)) {
    const float x = place(tick);
    list.AddLine(ImVec2(x, at.y + height - 5), ImVec2(x, at.y + height), kInk);
    const std::string label = short_number(tick);
    const float half = ImGui::CalcTextSize(label.c_str()).x / 2;
    if (x - half < free_from || x + half > at.x + width) continue;
    list.AddText(ImVec2(x - half, at.y + height + kGrid), ImGui::GetColorU32(ImGuiCol_TextDisabled), label.c_str());
    free_from = x + half + kGrid;
  }
  const float labels = ImGui::GetTextLineHeight();
  ImGui::PopFont();
  const double worst = large_is_worse(look) ? facts.max : facts.min;
  if (const float x = place(worst); x > at.x && on_bar(x)) draw_notch(list, x, at.y + height, kInk);
  if (facts.probed) {
    const float x = std::clamp(place(*facts.probed), at.x, at.x + width);
    list.AddRect(ImVec2(x - 2, at.y - 2), ImVec2(x + 2, at.y + height + 2), kInk);
  }
  ImGui::Dummy(ImVec2(width, height + kGrid + labels));
}

/// A limit that can be dragged, or typed after a double click.
bool edit_limit(const char* name, double& value, double span, float width) {
  ImGui::SetNextItemWidth(width);
  double wanted = value;
  const auto speed = static_cast<float>(std::abs(span) / kDragsAcross);
  const std::string shown = short_number(value);  // the format is the text itself: no format of C writes 0.00005
  if (!ImGui::DragScalar(name, ImGuiDataType_Double, &wanted, speed, nullptr, nullptr, shown.c_str()) || !std::isfinite(wanted))
    return false;
  value = wanted;
  return true;
}

}  // namespace

std::string worst_words(const LegendFacts& facts) {
  if (facts.min == facts.max) return short_number(facts.max) + " everywhere";
  const bool large = large_is_worse(facts.look);
  return fmt::format("{} {} at {}", large ? "most" : "least", short_number(large ? facts.max : facts.min),
                     large ? facts.max_at : facts.min_at);
}

std::string probe_words(const LegendFacts& facts) {
  if (facts.probed_at.empty()) return {};
  if (!facts.probed) return facts.probed_at + ": no value";
  return fmt::format("{}: {}{}{}", facts.probed_at, short_number(*facts.probed), facts.unit.empty() ? "" : " ", facts.unit);
}

std::optional<SetLimits> limits_of_values(const LegendFacts& facts) {
  if (!(facts.min < facts.max)) return std::nullopt;
  return large_is_worse(facts.look) ? SetLimits{facts.min, facts.max} : SetLimits{facts.max, facts.min};
}

std::vector<double> ticks(const render::FieldLook& look) {
  const double low = std::min(look.clear, look.full), high = std::max(look.clear, look.full);
  const double span = high - low;
  if (!(span > 0) || !std::isfinite(span)) return {};
  constexpr double kMostSteps = 6;
  const double decade = std::pow(10, std::floor(std::log10(span / kMostSteps)));
  double step = 10 * decade;
  for (const double round : {5.0, 2.0, 1.0})
    if (span / (round * decade) <= kMostSteps) step = round * decade;
  std::vector<double> all;
  constexpr double kRounding = 1e-9;  // a limit that is itself a round number has a tick
  for (double n = std::ceil(low / step - kRounding); n * step <= high + kRounding * step; ++n) all.push_back(n * step);
  if (look.full < look.clear) std::reverse(all.begin(), all.end());
  return all;
}

std::vector<std::string> legend_notes(const LegendFacts& facts) {
  std::vector<std::string> notes;
  if (facts.before_pull) notes.emplace_back("As before this pull: the colours follow when you let go.");
  if (facts.new_nodes > 0) notes.push_back(counted(facts.new_nodes, "new node") + " measured from between those it was made of");
  if (facts.shells_without > 0) notes.push_back(counted(facts.shells_without, "shell") + " without a value");
  return notes;
}

DrawnLegend legend(const LegendFacts& facts, panels::PanelLayout& layout) {
  const float font = ImGui::GetFontSize(), share = static_cast<float>(std::min(0.36, facts.widest));
  const float width = panels::on_grid(std::min(22 * font, share * static_cast<float>(layout.picture.width) - 3 * kGrid));
  const float limit_width = std::min(5.5f * font, 0.4f * width);
  ImGui::SetNextWindowPos(
      ImVec2(std::floor(static_cast<float>(facts.centre * layout.picture.width)), layout.view().bottom() - panels::kMargin), 0,
      ImVec2(0.5f, 1));
  ImGui::SetNextWindowSize(ImVec2(width + 2 * kGrid, 0));
  const std::string name = "Legend" + std::to_string(facts.pane.value_or(9));
  ImGui::Begin(name.c_str(), nullptr, panels::kPanelFlags | ImGuiWindowFlags_AlwaysAutoResize);
  const float inner = ImGui::GetContentRegionAvail().x;
  ImGui::TextUnformatted(printable(facts.unit.empty() ? facts.title : facts.title + ", " + facts.unit).c_str());
  if (!facts.of.empty()) {
    ImGui::PushFont(panels::small_font());
    ImGui::TextWrapped("%s", printable(facts.of).c_str());
    ImGui::PopFont();
  }
  draw_bar(facts, inner);
  DrawnLegend drawn;
  double clear = facts.look.clear, full = facts.look.full;
  if (facts.pane) {
    const bool clear_set = edit_limit("##clear", clear, full - clear, limit_width);
    ImGui::SameLine(inner - limit_width + ImGui::GetStyle().WindowPadding.x);
    const bool full_set = edit_limit("##full", full, full - clear, limit_width);
    if ((clear_set || full_set) && clear != full) drawn.wanted = SetLimits{clear, full};
    if (const auto all = limits_of_values(facts)) {
      const float button = ImGui::CalcTextSize("all values").x + 2 * ImGui::GetStyle().FramePadding.x;
      ImGui::SameLine((inner - button) / 2 + ImGui::GetStyle().WindowPadding.x);
      if (ImGui::Button("all values")) drawn.wanted = all;
      panels::note_item(layout, "legend all values", "");
    }
  } else {
    const std::string left = short_number(clear), right = short_number(full);
    ImGui::TextUnformatted(left.c_str());
    ImGui::SameLine(inner - ImGui::CalcTextSize(right.c_str()).x + ImGui::GetStyle().WindowPadding.x);
    ImGui::TextUnformatted(right.c_str());
  }
  ImGui::PushFont(panels::small_font());
  const std::string own = printable(fmt::format("{} {}: own colour", large_is_worse(facts.look) ? "up to" : "from", short_number(clear)));
  const std::string worst = printable(worst_words(facts));
  ImGui::TextDisabled("%s", own.c_str());
  if (ImGui::CalcTextSize((own + worst).c_str()).x + 2 * kGrid <= inner) ImGui::SameLine(0, 2 * kGrid);
  ImGui::PushTextWrapPos(0);
  ImGui::TextDisabled("%s", worst.c_str());
  ImGui::PopTextWrapPos();
  if (facts.pane) {
    const std::string probe = probe_words(facts);  // its line is kept, so that the legend doesn't jump as the pointer goes
    ImGui::TextUnformatted(probe.empty() ? "point at the model for its value" : printable(probe).c_str());
    panels::note_item(layout, "legend probe", probe);
  }
  for (const std::string& note : legend_notes(facts)) ImGui::TextWrapped("%s", note.c_str());
  ImGui::PopFont();
  drawn.top = ImGui::GetWindowPos().y;
  ImGui::End();
  return drawn;
}

}  // namespace prismesh::kiosk::tools::comparison
