#include "kiosk/tools/quality/quality_panel.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "base/readable_number.h"
#include "kiosk/input/key_table.h"
#include "kiosk/panels/text.h"
#include "kiosk/panels/widgets.h"
#include "kiosk/tools/quality/criteria_section.h"
#include "kiosk/tools/quality/quality_keys.h"
#include "kiosk/tools/quality/quality_words.h"

namespace prismesh::kiosk::tools::quality {

namespace {

using panels::PanelLayout;

using mesh::document::SelectMode;
using panels::draw_signal;
using panels::elided_text;
using panels::fact;
using panels::grouped;
using panels::kGrid;
using panels::section;
using panels::Signal;
using panels::small_font;

constexpr unsigned kOkBar = 0xffb4b0acu;
constexpr std::size_t kMaxPartRows = 6;
constexpr float kHistogramHeight = 11 * kGrid;

/// A count behind its signal, right-aligned at `right`; nothing where it is zero.
void signal_count(Signal signal, std::uint64_t count, float right) {
  if (count == 0) return;
  const std::string text = grouped(count);
  const float size = ImGui::GetFontSize() * 0.65f;
  ImGui::SameLine();
  ImGui::SetCursorPosX(right - ImGui::CalcTextSize(text.c_str()).x - size - kGrid / 2);
  draw_signal(signal, size);
  ImGui::SameLine(0, kGrid / 2);
  ImGui::TextUnformatted(text.c_str());
}

/// A row of counts that can be clicked; true when it was.
bool count_row(const std::string& label, std::uint64_t warn, std::uint64_t fail, bool chosen) {
  const float right = ImGui::GetWindowContentRegionMax().x, column = ImGui::GetFontSize() * 3.4f;
  const float left = ImGui::GetCursorPosX();
  const bool clicked = ImGui::Selectable(("##" + label).c_str(), chosen);
  ImGui::SameLine();
  ImGui::SetCursorPosX(left);
  elided_text(label, right - 2 * column - left);
  signal_count(Signal::warn, warn, right - column);
  signal_count(Signal::fail, fail, right);
  return clicked;
}

void metrics_section(const QualityFacts& facts, QualityActions& actions) {
  std::uint64_t wrong = 0;
  for (const ipc::QualityMetric& metric : facts.figures->metrics) {
    if (metric.warn + metric.fail == 0 && metric.name != facts.metric) continue;
    wrong += metric.warn + metric.fail;
    const bool is_metric = &metric - facts.figures->metrics.data() < mesh::quality::kMetricCount;
    if (count_row(kind_words(metric.name), metric.warn, metric.fail, metric.name == facts.metric) && is_metric)
      actions.emplace_back(ChooseMetric{metric.name == facts.metric ? std::string() : metric.name});
  }
  if (wrong == 0) ImGui::TextDisabled("%s", facts.damaged ? "nothing was made worse" : "no shell warns or fails");
}

/// Where a bar of the histogram stands.
struct BarPlace {
  ImVec2 foot;  ///< lower left corner
  float width = 0;
  float height = 0;  ///< of a bar with as many shells as the largest
};

/// Stacked from below: ok, warn, fail; logarithmic, so that one failing shell among thousands still shows. `max`: shells of the largest
/// bar.
void draw_bar(const ipc::QualityBar& bar, const BarPlace& place, double max, bool hovered) {
  const std::uint64_t all = bar.ok + bar.warn + bar.fail;
  if (all == 0) return;
  const auto full = std::max(3.0f, place.height * static_cast<float>(std::log1p(static_cast<double>(all)) / std::log1p(max)));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 foot = place.foot;
  float from = foot.y;
  const std::pair<std::uint64_t, unsigned> pieces[] = {{bar.ok, kOkBar}, {bar.warn, panels::kWarnColour}, {bar.fail, panels::kFailColour}};
  for (const auto& [count, colour] : pieces) {
    const float piece = full * static_cast<float>(count) / static_cast<float>(all);
    if (piece <= 0) continue;
    list.AddRectFilled(ImVec2(foot.x, from - piece), ImVec2(foot.x + place.width - 1, from), colour);
    from -= piece;
  }
  if (hovered) list.AddRect(ImVec2(foot.x - 1, foot.y - full - 1), ImVec2(foot.x + place.width, foot.y + 1), panels::kInk);
}

std::string range_words(const ipc::QualityBar& bar, const std::string& unit) {
  if (bar.open_below) return "below " + value_words(bar.to, unit);
  if (bar.open_above) return "from " + value_words(bar.from, unit);
  return value_words(bar.from, unit) + " to " + value_words(bar.to, unit);
}

std::string bar_words(const ipc::QualityBar& bar, const std::string& unit) {
  return fmt::format("{}: {} shells, {} warn, {} fail\na click selects them, with Shift adds them", range_words(bar, unit),
                     grouped(bar.ok + bar.warn + bar.fail), grouped(bar.warn), grouped(bar.fail));
}

void histogram(const ipc::Quality& figures, QualityActions& actions) {
  if (figures.bars.empty()) return;
  const auto named = std::find_if(figures.metrics.begin(), figures.metrics.end(),
                                  [&](const ipc::QualityMetric& metric) { return metric.name == figures.metric; });
  const std::string unit = named == figures.metrics.end() ? std::string() : named->unit;
  double most = 1;
  for (const ipc::QualityBar& bar : figures.bars) most = std::max(most, static_cast<double>(bar.ok + bar.warn + bar.fail));
  const float width = ImGui::GetContentRegionAvail().x;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::GetWindowDrawList()->AddRectFilled(at, ImVec2(at.x + width, at.y + kHistogramHeight), 0x14ffffffu, kGrid / 2);
  const float step = (width - kGrid) / static_cast<float>(figures.bars.size());
  for (std::size_t i = 0; i < figures.bars.size(); ++i) {
    const ImVec2 foot(at.x + kGrid / 2 + step * static_cast<float>(i), at.y + kHistogramHeight - kGrid / 2);
    ImGui::SetCursorScreenPos(ImVec2(foot.x, at.y));
    ImGui::PushID(static_cast<int>(i));
    const bool clicked = ImGui::InvisibleButton("bar", ImVec2(step, kHistogramHeight));
    const bool hovered = ImGui::IsItemHovered();
    ImGui::PopID();
    draw_bar(figures.bars[i], {foot, step, kHistogramHeight - 1.5f * kGrid}, most, hovered);
    if (hovered) ImGui::SetTooltip("%s", bar_words(figures.bars[i], unit).c_str());
    if (clicked) actions.emplace_back(BarClicked{figures.bars[i], ImGui::GetIO().KeyShift ? SelectMode::add : SelectMode::set});
  }
  ImGui::SetCursorScreenPos(ImVec2(at.x, at.y + kHistogramHeight));
  ImGui::PushFont(small_font());
  const ipc::QualityBar &first = figures.bars.front(), &last = figures.bars.back();
  ImGui::TextDisabled("%s", first.open_below ? range_words(first, unit).c_str() : value_words(first.from, unit).c_str());
  const std::string high = last.open_above ? range_words(last, unit) : value_words(last.to, unit);
  ImGui::SameLine();
  ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(high.c_str()).x);
  ImGui::TextDisabled("%s", high.c_str());
  ImGui::PopFont();
}

void errors_section(const QualityFacts& facts, PanelLayout& layout, QualityActions& actions) {
  section("Errors, worst first");
  const ipc::Quality& figures = *facts.figures;
  if (figures.errors.empty()) {
    ImGui::TextDisabled("none");
    return;
  }
  if (ImGui::SmallButton("<")) layout.ask(command_of(QualityCommand::previous_error));
  ImGui::SameLine();
  if (ImGui::SmallButton(">")) layout.ask(command_of(QualityCommand::next_error));
  ImGui::SameLine();
  const bool shown = facts.error && *facts.error < figures.errors.size();
  ImGui::TextDisabled(
      "%s", shown ? fmt::format("{} of {}", *facts.error + 1, grouped(figures.error_count)).c_str() : grouped(figures.error_count).c_str());
  if (figures.errors.size() < figures.error_count) {
    ImGui::SameLine();
    ImGui::TextDisabled("listed: %s", grouped(figures.errors.size()).c_str());
  }
  const std::size_t first = shown ? *facts.error : 0;
  const std::size_t end = std::min(first + 3, figures.errors.size());
  for (std::size_t i = first; i < end; ++i) {
    const ipc::QualityError& error = figures.errors[i];
    const float left = ImGui::GetCursorPosX();
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::Selectable("##error", shown && i == *facts.error)) actions.emplace_back(ErrorClicked{i});
    ImGui::PopID();
    ImGui::SameLine();
    ImGui::SetCursorPosX(left);
    draw_signal(error.fail ? Signal::fail : Signal::warn, ImGui::GetFontSize() * 0.65f);
    ImGui::SameLine();
    elided_text(error_row_words(error), ImGui::GetWindowContentRegionMax().x - ImGui::GetCursorPosX());
  }
}

const char* size_source_words(mesh::quality::SizeFrom from) {
  switch (from) {
    case mesh::quality::SizeFrom::part: return ", its median edge";
    case mesh::quality::SizeFrom::deck: return ", the deck's median edge";
    case mesh::quality::SizeFrom::given: break;
  }
  return ", as set";
}

/// The parts with the worst mean; the list of all may have hundreds.
void parts_section(const QualityFacts& facts) {
  std::vector<ipc::QualityPart> parts = facts.figures->parts;
  if (parts.empty()) return;
  section("Parts by composite");
  const std::size_t shown = std::min(parts.size(), kMaxPartRows);
  std::partial_sort(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(shown), parts.end(),
                    [](const ipc::QualityPart& a, const ipc::QualityPart& b) {
                      return a.composite != b.composite ? a.composite < b.composite : a.part < b.part;
                    });
  for (std::size_t i = 0; i < shown; ++i) {
    fact(fmt::format("part {}", parts[i].part).c_str(), fmt::format("{:.2f}, least {:.2f}", parts[i].composite, parts[i].least_composite));
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("%s shells, %s warn, %s fail\n1 is ideal, 0 at the fail limit, below 0 it fails\ntarget size %s%s\ncriteria %s",
                        grouped(parts[i].shells).c_str(), grouped(parts[i].warn).c_str(), grouped(parts[i].fail).c_str(),
                        readable(parts[i].target_size, 4).c_str(), size_source_words(parts[i].size_from),
                        panels::printable(parts[i].criteria).c_str());
  }
  if (parts.size() > shown) ImGui::TextDisabled("and %s better", grouped(parts.size() - shown).c_str());
}

void limits_rows(const QualityFacts& facts, PanelLayout& layout) {
  const auto row = [&](const char* label, const std::optional<double>& limit, const std::string& without, QualityCommand command) {
    panels::setting(label, limit ? panels::length_text(*limit, facts.length_unit) : without, input::binding_of(kKeys, command_of(command)),
                    layout);
  };
  row("nodes move at most", facts.limits.max_move.free, "no limit", QualityCommand::sheet_limit);
  row("on feature lines", facts.limits.max_move.line, "no limit", QualityCommand::line_limit);
  row("neighbours join beyond", facts.limits.threshold, "default", QualityCommand::relax_threshold);
}

std::string sizes_words(const SizeFacts& sizes) {
  if (sizes.min == sizes.max) return panels::length_text(sizes.min, sizes.unit);
  return readable(sizes.min, 4) + " to " + panels::length_text(sizes.max, sizes.unit);
}

/// What lengths are judged by, and a way to set it for the selection's parts or all.
void sizes_section(const SizeFacts& sizes, QualityActions& actions) {
  section("Target size");
  fact(sizes.min == sizes.max ? "of all parts" : "by part", sizes_words(sizes));
  double wanted = sizes.min;
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", sizes.of_selection ? "selection's parts" : "all parts");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 4);
  if (ImGui::InputDouble("##target size", &wanted, 0, 0, "%.4g", ImGuiInputTextFlags_EnterReturnsTrue) && wanted > 0 &&
      std::isfinite(wanted))
    actions.emplace_back(SizeChosen{wanted});
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("type a length and press Enter");
  ImGui::TextDisabled("guess by");
  ImGui::SameLine();
  if (ImGui::SmallButton("own edges")) actions.emplace_back(SizeChosen{mesh::document::SizeGuess::part});
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("each part's median edge");
  ImGui::SameLine();
  if (ImGui::SmallButton("deck's")) actions.emplace_back(SizeChosen{mesh::document::SizeGuess::deck});
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("the deck's median edge, one for all");
}

void commands_section(const QualityFacts& facts, PanelLayout& layout) {
  const auto row = [&](const char* label, std::initializer_list<std::pair<const char*, QualityCommand>> entries) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", label);
    for (const auto& [text, command] : entries) {
      ImGui::SameLine();
      ImGui::PushID(label);
      if (ImGui::SmallButton(text)) layout.ask(command_of(command));
      ImGui::PopID();
      panels::hint(input::binding_of(kKeys, command_of(command)));
    }
  };
  section("Mend");
  row("relax",
      {{"selection", QualityCommand::relax_selection}, {"parts", QualityCommand::relax_part}, {"failed", QualityCommand::relax_failed}});
  row("repair",
      {{"damage", QualityCommand::repair_damaged}, {"selection", QualityCommand::repair_selection}, {"all", QualityCommand::repair_all}});
  limits_rows(facts, layout);
}

}  // namespace

QualityActions quality_panel(const QualityFacts& facts, PanelLayout& layout) {
  QualityActions actions;
  panels::panel_title("Quality", facts.figures == nullptr || facts.stale ? "counting .." : "a row shows its histogram");
  panels::setting("glyphs", facts.glyphs, input::binding_of(kKeys, command_of(QualityCommand::damaged_only)), layout);
  if (facts.figures != nullptr) {
    metrics_section(facts, actions);
    if (!facts.metric.empty()) histogram(*facts.figures, actions);
    errors_section(facts, layout, actions);
    parts_section(facts);
  }
  if (facts.sizes) sizes_section(*facts.sizes, actions);
  if (facts.criteria) criteria_section(*facts.criteria, actions);
  commands_section(facts, layout);
  return actions;
}

}  // namespace prismesh::kiosk::tools::quality
