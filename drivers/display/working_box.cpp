#include "drivers/display/working_box.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace prismesh::drivers::display {

namespace {

/// The window that a unit (a pixel, or a third of one) shows: its eye and number.
struct Owner {
  int eye = 0;
  int window = 0;
  bool operator==(const Owner&) const = default;
};

/// One line of units across the panel, at one height.
struct PanelLine {
  double per_pixel = 1;                        ///< number of units
  std::vector<std::array<double, 2>> numbers;  ///< each eye's number in the middle of a unit
  std::vector<Owner> owners;
};

Owner nearest_owner(const std::array<double, 2>& numbers) {
  const double left = std::abs(numbers[0] - std::round(numbers[0])), right = std::abs(numbers[1] - std::round(numbers[1]));
  const int eye = left <= right ? 0 : 1;
  return {eye, static_cast<int>(std::lround(numbers[static_cast<std::size_t>(eye)]))};
}

/// Returns the window that a column always shows: even columns left, odd columns right, numbered as at the design position.
Owner fixed_owner(int column, int panel_columns) {
  const int from_reference = column - 2 * ((panel_columns + 1) / 4);
  return column % 2 == 0 ? Owner{0, from_reference / 2} : Owner{1, (from_reference + 1) / 2};
}

PanelLine read_line(const PhaseMap& map, const PanelArea& panel, double y, Composing composing) {
  PanelLine line;
  line.per_pixel = composing == Composing::subpixels ? 3 : 1;
  const auto units = static_cast<std::size_t>(panel.width * line.per_pixel);
  line.numbers.resize(units);
  line.owners.resize(units);
  for (std::size_t i = 0; i < units; ++i) {
    line.numbers[i] = numbers_at(map, panel.height, (static_cast<double>(i) + 0.5) / line.per_pixel, y);
    for (std::size_t eye = 0; eye < 2; ++eye) line.numbers[i][eye] += map.first[eye];
    line.owners[i] = composing == Composing::fixed_columns ? fixed_owner(panel.x + static_cast<int>(i), panel.panel_columns)
                                                           : nearest_owner(line.numbers[i]);
  }
  return line;
}

/// Returns the distance, in units, from the window's middle (where its number is `window`, between units i and i + 1) to the nearest light
/// that isn't its own. Negative: the middle itself shows other light, and this is the distance to the window's own light.
double clearance(const PanelLine& line, std::size_t i, double between, const Owner& own) {
  const double middle = static_cast<double>(i) + 0.5 + between;  // in units from the left edge
  const auto units = static_cast<std::int64_t>(line.owners.size());
  const auto is_own = [&](std::int64_t unit) { return unit >= 0 && unit < units && line.owners[static_cast<std::size_t>(unit)] == own; };
  const auto at = static_cast<std::int64_t>(std::floor(middle));
  const auto reach = static_cast<std::int64_t>(3 * line.per_pixel);
  if (is_own(at)) {
    std::int64_t left = at, right = at;
    while (is_own(left - 1)) --left;
    while (is_own(right + 1)) ++right;
    return std::min(middle - static_cast<double>(left), static_cast<double>(right + 1) - middle);
  }
  double away = 0.5 * line.per_pixel;  // value if the window has no light at all
  bool found = false;
  for (std::int64_t unit = at - reach; unit <= at + reach; ++unit)
    if (is_own(unit)) {
      const double distance = unit < at ? middle - static_cast<double>(unit + 1) : static_cast<double>(unit) - middle;
      away = found ? std::min(away, distance) : distance;
      found = true;
    }
  return -away;
}

double worst_on(const PanelLine& line) {
  double worst = 0;
  const auto margin = static_cast<std::size_t>(2 * line.per_pixel);  // skips the windows that the panel's edge cuts off
  for (std::size_t eye = 0; eye < 2; ++eye)
    for (std::size_t i = margin; i + 1 + margin < line.numbers.size(); ++i) {
      const double here = line.numbers[i][eye], next = line.numbers[i + 1][eye];
      const double window = std::floor(next);
      if (!(here < window)) continue;
      const double clear = clearance(line, i, (window - here) / (next - here), {static_cast<int>(eye), static_cast<int>(window)});
      worst = std::max(worst, 0.5 - clear / line.per_pixel);
    }
  return worst;
}

}  // namespace

double worst_phase_error(const MaskDisplay& display, const Eigen::Vector3d& head_mm) {
  const PanelArea& panel = display.panel;
  MaskOptics optics = display.optics;
  optics.panel_columns = panel.panel_columns;
  const PhaseMap map = phase_map(optics, eyes_from(head_mm, display.eye_separation_mm), mask_position_mm(optics, head_mm), panel);
  double worst = 0;
  for (const double y : {0.0, 0.5 * panel.height, 1.0 * panel.height})
    worst = std::max(worst, worst_on(read_line(map, panel, y, display.composing)));
  return worst;
}

std::optional<DepthSpan> working_depths(const MaskDisplay& display, double head_x_mm, double limit_px) {
  constexpr double kStepMm = 1, kMinHeadMm = 200, kMaxHeadMm = 2000;
  const auto good = [&](double distance) { return worst_phase_error(display, {head_x_mm, 0, distance}) <= limit_px; };
  DepthSpan span{display.optics.design_distance_mm, display.optics.design_distance_mm};
  if (!good(span.min_mm)) return std::nullopt;
  while (span.min_mm - kStepMm >= kMinHeadMm && good(span.min_mm - kStepMm)) span.min_mm -= kStepMm;
  while (span.max_mm + kStepMm <= kMaxHeadMm && good(span.max_mm + kStepMm)) span.max_mm += kStepMm;
  return span;
}

}  // namespace prismesh::drivers::display
