#include "tests/phase_error/phase.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "drivers/display/phase_map.h"
#include "tests/viewer/owners.h"

namespace prismesh::phase_error {
namespace {

using drivers::display::EyePair;
using drivers::display::MaskOptics;
using drivers::display::PanelArea;
using drivers::display::PhaseMap;
using drivers::display::Profile;
using drivers::display::Weave;
using viewer::Owner;
using viewer::Owners;

/// As in the composition: a stripe belongs to the eye whose number there is nearer to an integer.
Owners mapped(const Profile& profile, const EyePair& eyes, double mask_mm) {
  const MaskOptics& optics = profile.optics;
  // One row, at half of the panel's height.
  const PanelArea area{.width = optics.panel_columns, .height = 1, .panel_columns = optics.panel_columns, .panel_rows = 1};
  const PhaseMap map = phase_map(optics, eyes, mask_mm, area);
  Owners owners{area.width, 1, {}};
  const bool fine = profile.subpixels != drivers::display::Subpixels::none;
  for (int stripe = 0; stripe < 3 * area.width; ++stripe) {
    const int column = stripe / 3;
    const double x = fine ? (stripe + 0.5) / 3 : column + 0.5;
    const std::array<double, 2> numbers = numbers_at(map, area.height, x, 0.5);
    const auto off = [](double number) { return std::abs(number - std::round(number)); };
    owners.stripes.push_back(off(numbers[0]) <= off(numbers[1]) ? Owner::left : Owner::right);
  }
  return owners;
}

/// Alternate columns that never change, except that the eyes are exchanged after a move back by half a period.
Owners alternating(const Profile& profile, const Eigen::Vector3d& between_mm, double mask_mm) {
  const MaskOptics& optics = profile.optics;
  const double halves = 2 * (mask_position_mm(optics, between_mm) - mask_mm) / optics.mask_pitch_mm();
  const bool swapped = std::abs(std::remainder(std::round(halves), 2)) > 0.5;
  Owners owners{optics.panel_columns, 1, {}};
  for (int stripe = 0; stripe < 3 * owners.columns; ++stripe)
    owners.stripes.push_back(((stripe / 3) % 2 == 0) != swapped ? Owner::left : Owner::right);
  return owners;
}

viewer::MaskDisplay display_of(const Profile& profile) {
  viewer::MaskDisplay display;
  const MaskOptics& optics = profile.optics;
  display.panel.columns = optics.panel_columns;
  display.panel.rows = 1;
  display.panel.pitch_mm = optics.pixel_pitch_mm;
  display.design_distance_mm = optics.design_distance_mm;
  display.design_separation_mm = optics.design_separation_mm;
  display.index = optics.refractive_index;
  return display;
}

double moved_pixels(const Profile& profile, const EyePair& drawn, double drawn_mask_mm, const EyePair& truly, double true_mask_mm) {
  constexpr int kPlaces = 17;
  const MaskOptics& optics = profile.optics;
  const double width = optics.panel_columns * optics.pixel_pitch_mm;
  std::array<double, 2> sum{};
  for (int i = 0; i < kPlaces; ++i) {
    const double u = width * (static_cast<double>(i) / (kPlaces - 1) - 0.5);
    const auto moved = [&](const Eigen::Vector3d& then, const Eigen::Vector3d& now) {
      return 2 * std::abs(window_number(optics, now, true_mask_mm, u, 0) - window_number(optics, then, drawn_mask_mm, u, 0)) / kPlaces;
    };
    sum[0] += moved(drawn.left, truly.left);
    sum[1] += moved(drawn.right, truly.right);
  }
  return std::max(sum[0], sum[1]);
}

}  // namespace

Phase phase_of(const Moment& moment, const Profile& profile) {
  const kiosk::stereo::SeenFrom& seen = moment.drawn;
  const double mask_mm = seen.mask_mm.value_or(mask_position_mm(profile.optics, seen.between_eyes_mm));
  const EyePair drawn = drivers::display::eyes_from(seen.between_eyes_mm, seen.eye_separation_mm, seen.toward_right);
  const EyePair truly = drivers::display::eyes_from(moment.head_mm, seen.eye_separation_mm);
  const Owners owners =
      profile.weave == Weave::mask ? mapped(profile, drawn, mask_mm) : alternating(profile, seen.between_eyes_mm, mask_mm);
  const viewer::MaskDisplay display = display_of(profile);
  Phase phase;
  phase.moved_pixels = moved_pixels(profile, drawn, mask_mm, truly, moment.mask_mm);
  std::vector<double> off;
  std::array<double, 2> nearest_mm{1e9, 1e9}, middle{};
  for (const Owner owner : {Owner::left, Owner::right}) {
    const Eigen::Vector3d& eye = owner == Owner::left ? truly.left : truly.right;
    const std::size_t which = owner == Owner::left ? 0 : 1;
    for (const viewer::PhaseError& error : phase_errors(display, owners, owner, {eye.x(), eye.y(), eye.z()}, moment.mask_mm, {0})) {
      off.push_back(std::isnan(error.off_pixels) ? 1 : std::abs(error.off_pixels));
      phase.wrong_share += error.wrong_share;
      if (std::abs(error.place_mm) >= nearest_mm[which]) continue;
      nearest_mm[which] = std::abs(error.place_mm);
      middle[which] = off.back();
    }
  }
  phase.middle_pixels = std::max(middle[0], middle[1]);
  const auto at = static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(off.size() - 1));
  std::nth_element(off.begin(), off.begin() + at, off.end());
  phase.panel_pixels = off[static_cast<std::size_t>(at)];
  phase.wrong_share /= static_cast<double>(off.size());
  return phase;
}

}  // namespace prismesh::phase_error
