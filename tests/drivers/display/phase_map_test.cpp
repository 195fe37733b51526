// Compares the coarse phase map with the exact numbers, and with linear numbers.
#include "drivers/display/phase_map.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace prismesh::drivers::display {
namespace {

constexpr PanelArea kPanel{0, 0, 1920, 1080, 1920, 1080};

double worst_error(const MaskOptics& optics, const EyePair& eyes, double mask, const PanelArea& area) {
  const PhaseMap map = phase_map(optics, eyes, mask, area);
  double worst = 0;
  for (double y = 0.5; y < area.height; y += 7.3)
    for (double x = 0.5 - 1.0 / 3; x < area.width; x += 5.1) {
      const auto numbers = numbers_at(map, area.height, x, y);
      for (std::size_t eye = 0; eye < 2; ++eye) {
        const double exact = window_number(optics, eye == 0 ? eyes.left : eyes.right, mask, area.u_mm(x, optics.pixel_pitch_mm),
                                           area.v_mm(y, optics.pixel_pitch_mm));
        worst = std::max(worst, std::abs(numbers[eye] + map.first[eye] - exact));
        EXPECT_GE(numbers[eye], 0);
        EXPECT_LT(std::round(numbers[eye]), map.windows[eye]);
      }
    }
  return worst;
}

TEST(PhaseMap, is_accurate_to_a_thousandth_of_a_window) {
  MaskOptics optics;
  optics.panel_columns = 1920;
  EXPECT_LT(worst_error(optics, eyes_from({0, 0, 650}, 63), 0, kPanel), 2e-4);
  EXPECT_LT(worst_error(optics, eyes_from({180, -90, 450}, 63), 1.1, kPanel), 1e-3);
  EXPECT_LT(worst_error(optics, eyes_from({-300, 200, 900}, 63, {0.8, 0.6, 0}), -0.7, kPanel), 1e-3);
  EXPECT_LT(worst_error(optics, eyes_from({40, 0, 650}, 63), 0, {700, 300, 641, 359, 1920, 1080}), 2e-4) << "a window of the panel";
  optics.lean = 1.0 / 3;
  EXPECT_LT(worst_error(optics, eyes_from({60, 30, 700}, 63), 0, kPanel), 4e-4) << "leaning";
}

TEST(PhaseMap, counts_from_the_panels_centre) {
  MaskOptics optics;
  optics.panel_columns = 1920;
  const EyePair eyes = eyes_from({33, 12, 600}, 63);
  const PhaseMap whole = phase_map(optics, eyes, 0, kPanel);
  const PanelArea window{333, 222, 640, 480, 1920, 1080};
  const PhaseMap part = phase_map(optics, eyes, 0, window);
  for (const double x : {0.5, 100.5, 639.5})
    for (const double y : {0.5, 301.5}) {
      const auto there = numbers_at(whole, 1080, x + 333, y + 222), here = numbers_at(part, 480, x, y);
      for (std::size_t eye = 0; eye < 2; ++eye) EXPECT_NEAR(here[eye] + part.first[eye], there[eye] + whole.first[eye], 5e-4);
    }
}

TEST(PhaseMap, linear_numbers_are_exact) {
  const std::array<LinearNumbers, 2> numbers{{{0.5, 0, -0.25}, {0.5, 0, -0.75}}};
  const PhaseMap map = phase_map(numbers, 1366, 100);
  for (int column = 0; column < 1366; ++column) {
    const std::size_t own = column % 2;
    const auto at = numbers_at(map, 100, column + 0.5, 3.5);
    ASSERT_EQ(at[own] + map.first[own], column / 2);
    ASSERT_EQ(std::abs(at[1 - own] - std::round(at[1 - own])), 0.5);
  }
}

}  // namespace
}  // namespace prismesh::drivers::display
