#include "drivers/display/calibration.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

namespace prismesh::drivers::display {
namespace {

/// A smaller spread of ideal mask positions doesn't determine the gap.
constexpr double kMinSpreadForGapMm = 0.2;

MaskOptics without_zero(MaskOptics optics, double gap_scale) {
  optics.zero_mm = 0;
  optics.gap_scale = gap_scale;
  return optics;
}

/// Returns the resultant of the choices' offsets as unit vectors on a circle of one mask pitch: its angle is their circular mean, and its
/// length measures how well they agree.
std::complex<double> resultant(const MaskOptics& optics, std::span<const MaskChoice> choices) {
  const double turn = 2 * std::numbers::pi / optics.mask_pitch_mm();
  std::complex<double> sum = 0;
  for (const MaskChoice& choice : choices)
    sum += std::polar(1.0, turn * (mask_position_mm(optics, choice.between_eyes_mm) - choice.mask_mm));
  return sum;
}

double spread_mm(const MaskOptics& optics, std::span<const MaskChoice> choices) {
  const auto [low, high] = std::minmax_element(choices.begin(), choices.end(), [&](const MaskChoice& a, const MaskChoice& b) {
    return mask_position_mm(optics, a.between_eyes_mm) < mask_position_mm(optics, b.between_eyes_mm);
  });
  return mask_position_mm(optics, high->between_eyes_mm) - mask_position_mm(optics, low->between_eyes_mm);
}

/// Returns the scale at which the choices agree best: a fine grid search, then a ternary search between the neighbours of the best scale.
double best_gap_scale(const MaskOptics& optics, std::span<const MaskChoice> choices) {
  const auto disagreement = [&](double scale) { return -std::abs(resultant(without_zero(optics, scale), choices)); };
  constexpr int kSteps = 300;
  const double step = (kMaxGapScale - kMinGapScale) / kSteps;
  double best = kMinGapScale;
  for (int i = 0; i <= kSteps; ++i)
    if (const double scale = kMinGapScale + i * step; disagreement(scale) < disagreement(best)) best = scale;
  double low = best - step, high = best + step;
  while (high - low > 1e-7) {
    const double third = (high - low) / 3;
    if (disagreement(low + third) < disagreement(high - third))
      high -= third;
    else
      low += third;
  }
  return std::clamp(0.5 * (low + high), kMinGapScale, kMaxGapScale);
}

Result<void> check(std::span<const MaskChoice> choices) {
  if (choices.empty()) return fail("calibration", "no place of the mask was chosen");
  for (const MaskChoice& choice : choices)
    if (!choice.between_eyes_mm.allFinite() || !std::isfinite(choice.mask_mm) || choice.between_eyes_mm.z() < 100)
      return fail("calibration",
                  "the eyes weren't seen when choice " + std::to_string(&choice - choices.data() + 1) + " was made: choose again");
  return {};
}

}  // namespace

Result<MaskFit> fit_mask(const MaskOptics& optics, std::span<const MaskChoice> choices) {
  if (Result<void> checked = check(choices); !checked) return fail(checked.error());
  MaskFit fit;
  fit.gap_found = choices.size() >= 2 && spread_mm(without_zero(optics, optics.gap_scale), choices) >= kMinSpreadForGapMm;
  fit.gap_scale = fit.gap_found ? best_gap_scale(optics, choices) : optics.gap_scale;
  const MaskOptics fitted = without_zero(optics, fit.gap_scale);
  const double pitch = optics.mask_pitch_mm();
  fit.zero_mm = std::arg(resultant(fitted, choices)) / (2 * std::numbers::pi) * pitch;
  double squares = 0, worst = -1;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const double residual =
        std::abs(std::remainder(mask_position_mm(fitted, choices[i].between_eyes_mm) - fit.zero_mm - choices[i].mask_mm, pitch));
    squares += residual * residual;
    if (residual > worst) {
      worst = residual;
      fit.worst = i;
    }
  }
  const double pixels_per_mm = 2 / pitch;  // a mask pitch is two columns
  fit.scatter_mm = std::sqrt(squares / static_cast<double>(choices.size()));
  fit.scatter_px = fit.scatter_mm * pixels_per_mm;
  fit.worst_px = worst * pixels_per_mm;
  if (fit.scatter_px > kMaxScatterPx)
    return fail("calibration", "the chosen places contradict each other; choice " + std::to_string(fit.worst + 1) +
                                   " is the odd one out: sit still, close one eye, and choose it again");
  return fit;
}

}  // namespace prismesh::drivers::display
