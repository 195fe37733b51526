// The working volume: the head positions with a phase error of max. a quarter of a pixel, with a phase map and with moving the mask alone,
// as the viewer measures it over the whole width of a 359 mm panel.
#include <array>
#include <cmath>
#include <iostream>

#include "drivers/display/working_box.h"
#include "tests/optics/optics_fixture.h"

namespace prismesh::optics {
namespace {

constexpr double kPhaseLimit = 0.25;  ///< pixels

class WorkingVolume : public OpticsTest {
 protected:
  viewer::MaskDisplay display_ = OpticsTest::display(1280, 3);

  viewer::PhaseSummary with_phase_map(const Vec3& head) {
    const Picture picture = at_head("prism-mask", head);
    return viewer::phase_summary(display_, owners(picture, display_.panel), eyes_of(picture), display_.ideal_mask_mm(point(head)), {1});
  }
  viewer::PhaseSummary with_shift_alone(const viewer::Owners& columns, const Vec3& head) const {
    return viewer::phase_summary(display_, columns, viewer::eyes_around(point(head)), display_.ideal_mask_mm(point(head)), {1});
  }
  viewer::Owners fixed_columns() { return owners(at_head("prism-mask-columns", {0, 0, 650}), display_.panel); }
};

/// Min. and max. distance, from 650 mm on, without larger errors.
template <class Worst>
std::array<double, 2> depths(const Worst& worst) {
  std::array<double, 2> ends{650, 650};
  for (; ends[0] > 300 && worst(ends[0] - 2) <= kPhaseLimit; ends[0] -= 2) {
  }
  for (; ends[1] < 1500 && worst(ends[1] + 2) <= kPhaseLimit; ends[1] += 2) {
  }
  return ends;
}

TEST_F(WorkingVolume, moving_the_mask_alone_gives_a_thin_slice) {
  const viewer::Owners columns = fixed_columns();
  const auto ends = depths([&](double distance) { return with_shift_alone(columns, {0, 0, distance}).worst_pixels; });
  std::cout << "mask's shift alone, head in the middle: " << ends[0] << " to " << ends[1] << " mm\n";
  // A single eye in the middle would have 582 to 699 mm; each of two is 31 mm to the side.
  EXPECT_NEAR(ends[0], 584, 3);
  EXPECT_NEAR(ends[1], 684, 3);
}

TEST_F(WorkingVolume, a_phase_map_doubles_the_depth_and_the_width) {
  const auto ends = depths([&](double distance) { return with_phase_map({0, 0, distance}).worst_pixels; });
  std::cout << "with a phase map, head in the middle: " << ends[0] << " to " << ends[1] << " mm\n";
  EXPECT_LE(ends[0], 560);
  EXPECT_GE(ends[1], 750);
  const viewer::Owners columns = fixed_columns();
  int both = 0, shift_alone = 0;
  for (double distance = 520; distance <= 800; distance += 20)
    for (double x = -200; x <= 200; x += 40) {
      const double found = with_phase_map({x, 0, distance}).worst_pixels;
      if (std::abs(x) <= 130 && distance >= 570 && distance <= 700) {
        EXPECT_LE(found, kPhaseLimit) << x << ", " << distance;
      }
      EXPECT_LT(found, 0.5) << x << ", " << distance << ": no eye looks at the other's columns";
      both += found <= kPhaseLimit;
      shift_alone += with_shift_alone(columns, {x, 0, distance}).worst_pixels <= kPhaseLimit;
    }
  std::cout << "places of the head that are served: " << shift_alone << " by the shift alone, " << both << " with a phase map\n";
  EXPECT_GT(both, 3 * shift_alone);
}

TEST_F(WorkingVolume, agrees_with_the_drivers_figures) {
  using drivers::display::Composing;
  const drivers::display::PanelArea area{0, 0, display_.panel.columns, display_.panel.rows, display_.panel.columns, display_.panel.rows};
  const auto worst = [&](Composing composing, const Vec3& head) {
    return drivers::display::worst_phase_error({.panel = area, .composing = composing, .eye_separation_mm = 63}, head);
  };
  const viewer::Owners columns = fixed_columns();
  for (const Vec3& head : {Vec3(0, 0, 650), Vec3(0, 0, 580), Vec3(0, 0, 730), Vec3(110, 0, 640), Vec3(-60, 0, 700)}) {
    EXPECT_NEAR(worst(Composing::subpixels, head), with_phase_map(head).worst_pixels, 0.03) << head.transpose();
    EXPECT_NEAR(worst(Composing::fixed_columns, head), with_shift_alone(columns, head).worst_pixels, 0.03) << head.transpose();
  }
}

TEST_F(WorkingVolume, an_unknown_mask_error_appears_as_phase_error) {
  const Vec3 head(0, 0, 650);
  const Picture picture = at_head("prism-mask", head);
  const viewer::Owners found = owners(picture, display_.panel);
  for (const double offset : {-0.1, 0.06, 0.12}) {
    viewer::MaskDisplay off = display_;
    off.offset_mm = offset;
    const viewer::PhaseSummary phase = viewer::phase_summary(off, found, eyes_of(picture), 0, {1});
    EXPECT_NEAR(phase.mean_pixels, std::abs(offset) / display_.panel.pitch_mm, 0.05) << offset;
  }
}

}  // namespace
}  // namespace prismesh::optics
