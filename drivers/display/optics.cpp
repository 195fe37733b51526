#include "drivers/display/optics.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace prismesh::drivers::display {

namespace {

constexpr double kMinEyeDistanceMm = 20;
constexpr double kMaxCoordinateMm = 1e5;

/// Limits an eye position to the range in which the formulas are finite.
Eigen::Vector3d clamped_eye(const Eigen::Vector3d& eye_mm) {
  return {std::clamp(eye_mm.x(), -kMaxCoordinateMm, kMaxCoordinateMm), std::clamp(eye_mm.y(), -kMaxCoordinateMm, kMaxCoordinateMm),
          std::clamp(eye_mm.z(), kMinEyeDistanceMm, kMaxCoordinateMm)};
}

double designed_gap_mm(const MaskOptics& optics) { return optics.pixel_pitch_mm * optics.design_distance_mm / optics.design_separation_mm; }

/// Returns where the ray from an eye at `distance` from the mask to a panel position at lateral offset `reach` crosses the mask, as lateral
/// offset r. Snell's law: r + g tan(asin(sin / n)) = reach, with glass of thickness g = n g' under the mask.
double crossing_mm(double distance, double reach, double air_gap, double index) {
  const double glass = air_gap * index, bending = index * index - 1, straight = index * index * distance * distance;
  double r = reach / (1 + air_gap / distance);  // exact without refraction; otherwise on the near side of the root
  // The left side is increasing and concave, so Newton's steps approach the root from one side.
  constexpr int kSteps = 12;
  for (int step = 0; step < kSteps; ++step) {
    const double square = straight + bending * r * r;
    const double slant = glass / std::sqrt(square);
    const double change = (r * (1 + slant) - reach) / (1 + slant * straight / square);
    r -= change;
    if (!(std::abs(change) > 1e-12 * reach)) break;
  }
  return r;
}

/// Returns the mask coordinate of element 0.
double element_zero_mm(const MaskOptics& optics, double mask_mm) {
  const double reference = optics.reference_mm() * optics.design_distance_mm / (optics.design_distance_mm + designed_gap_mm(optics));
  return mask_mm + optics.zero_mm + reference;
}

}  // namespace

double MaskOptics::air_gap_mm() const { return designed_gap_mm(*this) * gap_scale; }

double MaskOptics::mask_pitch_mm() const {
  return 2 * pixel_pitch_mm * design_distance_mm / (design_distance_mm + designed_gap_mm(*this)) * pitch_scale;
}

double MaskOptics::reference_mm() const {
  const int even_column = 2 * ((panel_columns + 1) / 4);
  return (even_column - 0.5 * panel_columns) * pixel_pitch_mm;
}

double mask_position_mm(const MaskOptics& optics, const Eigen::Vector3d& between_mm) {
  const Eigen::Vector3d head = clamped_eye(between_mm);
  const double gap = optics.air_gap_mm();
  return (head.x() - optics.lean * head.y()) * gap / (head.z() + gap) - optics.zero_mm;
}

double window_number(const MaskOptics& optics, const Eigen::Vector3d& eye_mm, double mask_mm, double u_mm, double v_mm) {
  const Eigen::Vector3d eye = clamped_eye(eye_mm);
  const double du = std::clamp(u_mm, -kMaxCoordinateMm, kMaxCoordinateMm) - eye.x(),
               dv = std::clamp(v_mm, -kMaxCoordinateMm, kMaxCoordinateMm) - eye.y();
  const double reach = std::hypot(du, dv);  // eye, element and panel position lie in one plane perpendicular to the panel
  const double share = reach > 0 ? crossing_mm(eye.z(), reach, optics.air_gap_mm(), optics.refractive_index) / reach : 0;
  const double across = eye.x() + share * du - optics.lean * (eye.y() + share * dv);
  return (across - element_zero_mm(optics, mask_mm)) / optics.mask_pitch_mm();
}

WindowRow window_row(const MaskOptics& optics, const Eigen::Vector3d& eye_mm, double mask_mm, double panel_width_mm) {
  constexpr int kPlaces = 33;
  double mean_u = 0, mean_number = 0, number_number = 0, number_u = 0;
  std::array<double, kPlaces> numbers{}, places{};
  for (std::size_t i = 0; i < kPlaces; ++i) {
    places[i] = panel_width_mm * (static_cast<double>(i) / (kPlaces - 1) - 0.5);
    numbers[i] = window_number(optics, eye_mm, mask_mm, places[i], 0);
    mean_u += places[i] / kPlaces;
    mean_number += numbers[i] / kPlaces;
  }
  for (std::size_t i = 0; i < kPlaces; ++i) {
    number_number += (numbers[i] - mean_number) * (numbers[i] - mean_number);
    number_u += (numbers[i] - mean_number) * (places[i] - mean_u);
  }
  WindowRow row;
  row.spacing_mm = number_number > 0 ? number_u / number_number : optics.mask_pitch_mm();
  row.first_mm = mean_u - row.spacing_mm * mean_number;
  return row;
}

}  // namespace prismesh::drivers::display
