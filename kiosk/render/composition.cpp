#include "kiosk/render/composition.h"

#include <algorithm>
#include <cmath>

namespace prismesh::kiosk::render {

using drivers::display::LinearNumbers;
using drivers::display::MaskOptics;
using drivers::display::PanelArea;
using drivers::display::PhaseMap;
using stereo::Eye;
using stereo::Weave;

namespace {

/// Size of an eye's image, and the map from pixels of the picture to it.
struct ImageFrame {
  int width = 1, height = 1;
  stereo::ImageMap from_picture;
};

/// The picture's eyes, with defaults for values that aren't finite.
stereo::PictureEyes finite_eyes(const Picture& picture) {
  stereo::PictureEyes eyes;
  if (picture.between_eyes_mm.allFinite()) eyes.between_mm = picture.between_eyes_mm;
  if (picture.toward_right.allFinite() && picture.toward_right.norm() > 0) eyes.toward_right = picture.toward_right;
  if (picture.eye_separation_mm >= 0 && picture.eye_separation_mm <= 1000) eyes.separation_mm = picture.eye_separation_mm;
  eyes.depth_share = std::clamp(std::isfinite(picture.depth_share) ? picture.depth_share : 0, 0.0, 1.0);
  return eyes;
}

Vec3 centre_on_panel_mm(const PanelArea& area, double pitch) {
  return {area.u_mm(0.5 * area.width, pitch), area.v_mm(0.5 * area.height, pitch), 0};
}

/// A mask's optics for this panel, and its position.
struct PlacedMask {
  MaskOptics optics;
  double mask_mm = 0;
};

PlacedMask place_mask(const Picture& picture, const stereo::PictureEyes& eyes, const PanelArea& area) {
  PlacedMask placed{picture.profile.optics, 0};
  placed.optics.panel_columns = area.panel_columns;
  const double ideal = mask_position_mm(placed.optics, eyes.between_mm);
  if (picture.profile.mask_moves) placed.mask_mm = picture.mask_mm && std::isfinite(*picture.mask_mm) ? *picture.mask_mm : ideal;
  // A mask shifted by half a period exchanges the eyes.
  if (picture.profile.swap_eyes) placed.mask_mm += 0.5 * placed.optics.mask_pitch_mm();
  return placed;
}

/// Whether fixed alternate columns must be exchanged: a movable mask may stand an odd number of half periods from its ideal position.
bool columns_swapped(const Picture& picture, const stereo::PictureEyes& eyes) {
  bool swapped = picture.profile.swap_eyes;
  if (picture.profile.has_mask() && picture.profile.mask_moves && picture.mask_mm && std::isfinite(*picture.mask_mm)) {
    const MaskOptics& optics = picture.profile.optics;
    const double halves = 2 * (mask_position_mm(optics, eyes.between_mm) - *picture.mask_mm) / optics.mask_pitch_mm();
    if (std::abs(std::remainder(std::round(halves), 2)) > 0.5) swapped = !swapped;
  }
  return swapped;
}

/// Evenly spaced windows of one eye: their numbers as a linear function of the picture's pixels, and the range of numbers.
struct EvenWindows {
  LinearNumbers numbers;
  int first = 0;
  int count = 0;
  bool by_rows = false;
};

/// The frame of an image with one texel for each window. Texel i has its middle where the number is first + i.
ImageFrame frame_of_windows(const EvenWindows& windows, const PanelArea& area) {
  const LinearNumbers& numbers = windows.numbers;
  const double scale = 2.0 / windows.count;
  ImageFrame frame{area.width, area.height, stereo::whole_picture(area.width, area.height)};
  (windows.by_rows ? frame.height : frame.width) = windows.count;
  frame.from_picture.row(windows.by_rows ? 1 : 0) << scale * numbers.by_x, scale * numbers.by_y,
      scale * (numbers.at_origin - windows.first + 0.5) - 1;
  return frame;
}

/// Number of texels across an eye's image. It is the same for most positions of the head, so that moves don't allocate new images.
int texels_for(const PlacedMask& mask, const PhaseMap& phases, const PanelArea& area) {
  const MaskOptics& optics = mask.optics;
  const double spacing = optics.mask_pitch_mm() * (1 + optics.air_gap_mm() / optics.design_distance_mm);
  const double extent = (area.width + std::abs(optics.lean) * area.height) * optics.pixel_pitch_mm;
  const int usual = static_cast<int>(std::ceil(1.02 * extent / spacing)) + 8;
  const int needed = std::max(phases.windows[0], phases.windows[1]);
  constexpr int kStep = 64;
  return needed <= usual ? usual : (needed + kStep - 1) / kStep * kStep;
}

LinearNumbers evenly_spaced(const PlacedMask& mask, const Vec3& eye_mm, const PanelArea& area) {
  const double pitch = mask.optics.pixel_pitch_mm;
  const auto row = window_row(mask.optics, eye_mm, mask.mask_mm, area.panel_columns * pitch);
  // number = (u - lean v - first) / spacing
  const double by_u = 1 / row.spacing_mm, by_v = -mask.optics.lean / row.spacing_mm;
  return {by_u * pitch, -by_v * pitch, by_u * area.u_mm(0, pitch) + by_v * area.v_mm(0, pitch) - row.first_mm / row.spacing_mm};
}

std::array<ImageFrame, 2> behind_mask(const Picture& picture, const stereo::PictureEyes& eyes, const PanelArea& area,
                                      Composition& composed) {
  const PlacedMask mask = place_mask(picture, eyes, area);
  const stereo::EyePair pair = eyes.eyes();
  composed.join = Join::interlaced;
  composed.subpixel = picture.profile.subpixels == stereo::Subpixels::rgb   ? 1.0 / 3
                      : picture.profile.subpixels == stereo::Subpixels::bgr ? -1.0 / 3
                                                                            : 0;
  composed.phases = phase_map(mask.optics, pair, mask.mask_mm, area);
  const int texels = texels_for(mask, composed.phases, area);
  std::array<ImageFrame, 2> frames;
  for (const Eye eye : {Eye::left, Eye::right}) {
    const auto i = static_cast<std::size_t>(eye);
    frames[i] = frame_of_windows({evenly_spaced(mask, pair.of(eye), area), composed.phases.first[i], texels}, area);
  }
  return frames;
}

/// Alternate columns or rows of the panel, independent of the eyes.
std::array<LinearNumbers, 2> alternating(bool by_rows, bool swapped, const PanelArea& area) {
  std::array<LinearNumbers, 2> numbers;
  for (const std::size_t eye : {0U, 1U}) {
    const double own = (eye == 1) != swapped ? 1.5 : 0.5;  // the middle of its first column or row
    if (by_rows)
      numbers[eye] = {0, -0.5, -0.5 * (area.y - own)};  // count up from below
    else
      numbers[eye] = {0.5, 0, 0.5 * (area.x - own)};
  }
  return numbers;
}

std::array<ImageFrame, 2> alternate(const Picture& picture, const stereo::PictureEyes& eyes, const PanelArea& area, Composition& composed) {
  composed.by_rows = picture.profile.weave == Weave::rows;
  const auto numbers = alternating(composed.by_rows, columns_swapped(picture, eyes), area);
  composed.phases = phase_map(numbers, area.width, area.height);
  std::array<ImageFrame, 2> frames;
  if (picture.profile.weave == Weave::stencil) {
    composed.join = Join::stencil;
    frames.fill({area.width, area.height, stereo::whole_picture(area.width, area.height)});
    return frames;
  }
  composed.join = Join::interlaced;
  const int from = composed.by_rows ? area.y : area.x, pixels = composed.by_rows ? area.height : area.width;
  const int before = from >> 1, last = (from + pixels - 1) >> 1;  // shifts round down also if the picture starts left of or above the panel
  for (const std::size_t eye : {0U, 1U}) {
    // The map's first number is that of its outermost node; the image starts with the first column or row that exists.
    const int first = composed.by_rows ? -last : before;
    for (auto& node : composed.phases.numbers) node[eye] += static_cast<float>(composed.phases.first[eye] - first);
    composed.phases.first[eye] = first;
    composed.phases.windows[eye] = last - before + 1;
    frames[eye] = frame_of_windows({numbers[eye], first, composed.phases.windows[eye], composed.by_rows}, area);
  }
  return frames;
}

ImageFrame half_width(int width, int height) {
  ImageFrame frame{(width + 1) / 2, height, stereo::whole_picture(width, height)};
  frame.from_picture(0, 0) = 1.0 / frame.width;
  return frame;
}

ImageFrame half_height(int width, int height) {
  ImageFrame frame{width, (height + 1) / 2, stereo::whole_picture(width, height)};
  frame.from_picture(1, 1) = -1.0 / frame.height;
  return frame;
}

/// Frames of the two eyes' images. Sets how they are joined in `composed`.
std::array<ImageFrame, 2> frames_for(const Picture& picture, const stereo::PictureEyes& eyes, const PanelArea& area,
                                     Composition& composed) {
  const ImageFrame whole{area.width, area.height, stereo::whole_picture(area.width, area.height)};
  switch (picture.profile.weave) {
    case Weave::mask: return behind_mask(picture, eyes, area, composed);
    case Weave::columns:
    case Weave::stencil:
    case Weave::rows: return alternate(picture, eyes, area, composed);
    case Weave::side_by_side:
      composed.join = Join::beside;
      return {half_width(area.width, area.height), half_width(area.width, area.height)};
    case Weave::top_bottom:
      composed.join = Join::stacked;
      return {half_height(area.width, area.height), half_height(area.width, area.height)};
    case Weave::anaglyph: composed.join = Join::anaglyph; return {whole, whole};
    case Weave::one_eye:
    case Weave::centre: break;
  }
  composed.join = Join::alone;
  return {whole, whole};
}

}  // namespace

Composition compose(const Picture& picture, int width, int height) {
  const PanelArea area = panel_area(picture.panel, width, height);
  const stereo::PictureEyes eyes = finite_eyes(picture);
  const Vec3 centre = centre_on_panel_mm(area, picture.profile.optics.pixel_pitch_mm);
  const bool sharing = picture.profile.weave != Weave::anaglyph && picture.profile.stereo();
  Composition composed;
  composed.swapped = picture.profile.swap_eyes;
  composed.gamma = picture.profile.gamma;
  if (sharing) composed.leak = picture.profile.crosstalk;
  const auto image = [&](std::optional<Eye> eye, const ImageFrame& frame) {
    composed.images.push_back({eye, eyes.picture_eye(eye) - centre, frame.width, frame.height, frame.from_picture});
  };
  const bool flat = picture.profile.stereo() && eyes.depth_share == 0;
  if (flat && picture.profile.interlaced()) {
    // Without depth both eyes see the same picture: one image with a texel for each pixel.
    image(std::nullopt, {width, height, stereo::whole_picture(width, height)});
    return composed;
  }
  const std::array<ImageFrame, 2> frames = frames_for(picture, eyes, area, composed);
  if (flat || picture.profile.weave == Weave::centre)
    image(std::nullopt, frames[0]);
  else if (picture.profile.weave == Weave::one_eye)
    image(picture.profile.eye, frames[0]);
  else
    for (const Eye eye : {Eye::left, Eye::right}) image(eye, frames[static_cast<std::size_t>(eye)]);
  return composed;
}

}  // namespace prismesh::kiosk::render
