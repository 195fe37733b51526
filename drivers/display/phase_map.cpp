#include "drivers/display/phase_map.h"

#include <algorithm>
#include <cmath>

namespace prismesh::drivers::display {

namespace {

/// Fills a map from `number(eye, x, y)`, with x and y in pixels from the upper left corner.
template <class Number>
PhaseMap fill(int width, int height, const Number& number) {
  PhaseMap map;
  map.columns = (width + PhaseMap::kStep - 1) / PhaseMap::kStep + 1;
  map.rows = (height + PhaseMap::kStep - 1) / PhaseMap::kStep + 1;
  const std::size_t nodes = static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows);
  std::vector<std::array<double, 2>> exact(nodes);
  std::array<double, 2> min_number{}, max_number{};
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto column = static_cast<int>(i) % map.columns, row = static_cast<int>(i) / map.columns;
    for (std::size_t eye = 0; eye < 2; ++eye) {
      const double value = exact[i][eye] = number(eye, column * PhaseMap::kStep, height - row * PhaseMap::kStep);
      min_number[eye] = i == 0 ? value : std::min(min_number[eye], value);
      max_number[eye] = i == 0 ? value : std::max(max_number[eye], value);
    }
  }
  // Keeps the numbers small, so that single precision preserves their fractions.
  for (std::size_t eye = 0; eye < 2; ++eye) {
    map.first[eye] = static_cast<int>(std::floor(min_number[eye]));
    map.windows[eye] = static_cast<int>(std::ceil(max_number[eye])) - map.first[eye] + 1;
  }
  map.numbers.resize(nodes);
  for (std::size_t i = 0; i < nodes; ++i)
    for (std::size_t eye = 0; eye < 2; ++eye) map.numbers[i][eye] = static_cast<float>(exact[i][eye] - map.first[eye]);
  return map;
}

}  // namespace

PhaseMap phase_map(const MaskOptics& optics, const EyePair& eyes_mm, double mask_mm, const PanelArea& area) {
  return fill(area.width, area.height, [&](std::size_t eye, double x, double y) {
    return window_number(optics, eye == 0 ? eyes_mm.left : eyes_mm.right, mask_mm, area.u_mm(x, optics.pixel_pitch_mm),
                         area.v_mm(y, optics.pixel_pitch_mm));
  });
}

PhaseMap phase_map(const std::array<LinearNumbers, 2>& numbers, int width, int height) {
  return fill(width, height, [&](std::size_t eye, double x, double y) { return numbers[eye].at(x, y); });
}

std::array<double, 2> numbers_at(const PhaseMap& map, int height, double x, double y) {
  const double across = x / PhaseMap::kStep, up = (height - y) / PhaseMap::kStep;
  const int column = std::clamp(static_cast<int>(std::floor(across)), 0, map.columns - 2);
  const int row = std::clamp(static_cast<int>(std::floor(up)), 0, map.rows - 2);
  const auto node = [&](int c, int r, std::size_t eye) -> double {
    return map.numbers[static_cast<std::size_t>(r) * static_cast<std::size_t>(map.columns) + static_cast<std::size_t>(c)][eye];
  };
  std::array<double, 2> numbers{};
  for (std::size_t eye = 0; eye < 2; ++eye) {
    const double low = std::lerp(node(column, row, eye), node(column + 1, row, eye), across - column);
    const double high = std::lerp(node(column, row + 1, eye), node(column + 1, row + 1, eye), across - column);
    numbers[eye] = std::lerp(low, high, up - row);
  }
  return numbers;
}

}  // namespace prismesh::drivers::display
