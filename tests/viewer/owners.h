// Determines which eye each stripe of a panel belongs to, from woven plain eye images; and the distance between the windows through which
// the eyes look and the middle of their own stripes.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/viewer/light.h"
#include "tests/viewer/mask_display.h"

namespace prismesh::viewer {

enum class Owner : std::uint8_t { nobody, left, right, both };

/// [row][column][stripe from the left]; a panel without stripes has three equal ones.
struct Owners {
  int columns = 0;
  int rows = 0;
  std::vector<Owner> stripes;
  Owner at(int row, int stripe) const { return stripes[static_cast<std::size_t>(row) * columns * 3 + stripe]; }
};

/// `left_lit`: the woven picture of a white image for the left eye and a black one for the right; `right_lit`: the opposite. A stripe is
/// lit if it has at least half of white's light. Crosstalk correction must be off. Errors: the two differ in size.
Result<Owners> owners_of(const Panel& panel, const LightImage& left_lit, const LightImage& right_lit);

/// One window and the nearest run of stripes that belong to the eye.
struct PhaseError {
  int element = 0;
  int row = 0;
  double place_mm = 0;     ///< the window's middle
  double off_pixels = 0;   ///< the run's middle minus the window's; NaN: the eye has no stripe in this row
  double run_pixels = 0;   ///< the run's width
  double wrong_share = 0;  ///< share of the window's width (one pixel) that belongs to the other eye
};

/// For every element whose window and nearest run aren't cut off by the panel's borders. `rows` must be valid.
std::vector<PhaseError> phase_errors(const MaskDisplay& display, const Owners& owners, Owner eye_is, const Point& eye, double mask_mm,
                                     const std::vector<int>& rows);

struct PhaseSummary {
  std::size_t windows = 0;
  double worst_pixels = 0;  ///< infinite if an eye has no stripe at all
  double p99_pixels = 0;
  double mean_pixels = 0;  ///< of the magnitude
  double worst_wrong_share = 0;
  double mean_wrong_share = 0;
};
/// Both eyes together.
PhaseSummary phase_summary(const MaskDisplay& display, const Owners& owners, const Eyes& eyes, double mask_mm,
                           const std::vector<int>& rows);

}  // namespace prismesh::viewer
