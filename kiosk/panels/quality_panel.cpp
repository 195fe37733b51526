#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "base/readable_number.h"
#include "kiosk/panels/sections.h"
#include "kiosk/panels/text.h"

namespace prismesh::kiosk::panels {

std::string metric_words(const std::string& name) {
  std::string words = name;
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string value_words(double value, const std::string& unit) {
  const std::string number = std::abs(value) >= 1e6 ? fmt::format("{:.1e}", value) : readable(value, 4);
  return unit.empty() ? number : unit == "deg" ? number + "\u00b0" : number + " " + unit;
}

std::string error_words(const ipc::QualityError& error) {
  std::string words = fmt::format("shell {}: {}", error.shell, metric_words(error.metric));
  if (error.value) words += fmt::format(" {} {}", value_words(*error.value, error.unit), error.fail ? "fails" : "warns");
  return words;
}

namespace {

using mesh::document::SelectMode;
using tools::Command;

/// Error words for a line behind a sign, which says already whether it fails.
std::string error_row(const ipc::QualityError& error) {
  std::string words = fmt::format("{}  {}", error.shell, metric_words(error.metric));
  if (error.value) words += "  " + value_words(*error.value, error.unit);
  return words;
}

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

void metrics_section(const QualityFacts& facts, Actions& actions) {
  std::uint64_t wrong = 0;
  for (const ipc::QualityMetric& metric : facts.figures->metrics) {
    if (metric.warn + metric.fail == 0 && metric.name != facts.metric) continue;
    wrong += metric.warn + metric.fail;
    const bool is_metric = &metric - facts.figures->metrics.data() < mesh::quality::kMetricCount;
    if (count_row(metric_words(metric.name), metric.warn, metric.fail, metric.name == facts.metric) && is_metric)
      actions.emplace_back(ChooseMetric{metric.name == facts.metric ? std::string() : metric.name});
  }
  if (wrong == 0) ImGui::TextDisabled("%s", facts.damaged ? "nothing was made worse" : "no shell warns or fails");
}

/// Stacked from below: ok, warn, fail; logarithmic, so that one failing shell among thousands still shows.
void draw_bar(const ipc::QualityBar& bar, ImVec2 low, float width, float height, double most, bool hovered) {
  const std::uint64_t all = bar.ok + bar.warn + bar.fail;
  if (all == 0) return;
  const auto full = std::max(3.0f, height * static_cast<float>(std::log1p(static_cast<double>(all)) / std::log1p(most)));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  float from = low.y;
  const std::pair<std::uint64_t, unsigned> pieces[] = {{bar.ok, kOkBar}, {bar.warn, kWarnColour}, {bar.fail, kFailColour}};
  for (const auto& [count, colour] : pieces) {
    const float piece = full * static_cast<float>(count) / static_cast<float>(all);
    if (piece <= 0) continue;
    list.AddRectFilled(ImVec2(low.x, from - piece), ImVec2(low.x + width - 1, from), colour);
    from -= piece;
  }
  if (hovered) list.AddRect(ImVec2(low.x - 1, low.y - full - 1), ImVec2(low.x + width, low.y + 1), kInk);
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

void histogram(const ipc::Quality& figures, Actions& actions) {
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
    draw_bar(figures.bars[i], foot, step, kHistogramHeight - 1.5f * kGrid, most, hovered);
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

void errors_section(const QualityFacts& facts, Actions& actions) {
  section("Errors, worst first");
  const ipc::Quality& figures = *facts.figures;
  if (figures.errors.empty()) {
    ImGui::TextDisabled("none");
    return;
  }
  if (ImGui::SmallButton("<")) actions.emplace_back(Command::previous_error);
  ImGui::SameLine();
  if (ImGui::SmallButton(">")) actions.emplace_back(Command::next_error);
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
    elided_text(error_row(error), ImGui::GetWindowContentRegionMax().x - ImGui::GetCursorPosX());
  }
}

/// Those that are worst by their mean; all of them would be a list of hundreds.
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
      ImGui::SetTooltip("%s shells, %s warn, %s fail\n1 is ideal, 0 at the fail limit, below 0 it fails", grouped(parts[i].shells).c_str(),
                        grouped(parts[i].warn).c_str(), grouped(parts[i].fail).c_str());
  }
  if (parts.size() > shown) ImGui::TextDisabled("%s better ones", grouped(parts.size() - shown).c_str());
}

void commands_section(Actions& actions) {
  const auto row = [&](const char* label, std::initializer_list<std::pair<const char*, Command>> entries) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", label);
    for (const auto& [text, command] : entries) {
      ImGui::SameLine();
      ImGui::PushID(label);
      if (ImGui::SmallButton(text)) actions.emplace_back(command);
      ImGui::PopID();
      hint(command);
    }
  };
  section("Mend");
  row("relax", {{"selection", Command::relax_selection}, {"parts", Command::relax_part}, {"failed", Command::relax_failed}});
  row("repair", {{"damage", Command::repair_damaged}, {"selection", Command::repair_selection}, {"all", Command::repair_all}});
}

}  // namespace

void quality_panel(const PanelData& data, display::PixelSize picture, Actions& actions) {
  const QualityFacts& facts = *data.quality;
  begin_left("Quality", picture);
  ImGui::PushFont(title_font());
  ImGui::TextUnformatted("Quality");
  ImGui::PopFont();
  ImGui::PushFont(small_font());
  ImGui::TextDisabled(facts.figures == nullptr || facts.stale ? "J closes; counting .." : "J closes; a row shows its histogram");
  ImGui::PopFont();
  bool damaged = facts.damaged;
  if (ImGui::Checkbox("only what edits made worse", &damaged)) actions.emplace_back(Command::damaged_only);
  if (facts.figures != nullptr) {
    metrics_section(facts, actions);
    if (!facts.metric.empty()) histogram(*facts.figures, actions);
    errors_section(facts, actions);
    parts_section(facts);
  }
  commands_section(actions);
  ImGui::End();
}

}  // namespace prismesh::kiosk::panels
