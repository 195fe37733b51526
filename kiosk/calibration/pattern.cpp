#include "kiosk/calibration/pattern.h"

namespace prismesh::kiosk::calibration {
namespace {

constexpr Colour kBlack{0, 0, 0};
constexpr Colour kWhite{1, 1, 1};
constexpr Colour kGrey{0.5F, 0.5F, 0.5F};
constexpr Colour kDim{0.3F, 0.3F, 0.3F};

}  // namespace

Pattern one_eye_bright(bool left) {
  Pattern pattern;
  pattern.fields.push_back({0, 0, 1, 1, left ? kWhite : kBlack, left ? kBlack : kWhite});
  return pattern;
}

Pattern colour_stripes() {
  constexpr Colour kRed{1, 0, 0}, kBlue{0, 0, 1};
  Pattern pattern;
  pattern.ground = kDim;
  pattern.stripes.push_back({0.25, 0.15, 0.5, 0.45, 1, kRed, kBlue});
  pattern.stripes.push_back({0.5, 0.15, 0.75, 0.45, 2, kRed, kBlue});
  return pattern;
}

Pattern crosstalk_patches(bool left) {
  Pattern pattern;
  pattern.ground = kDim;
  for (const bool right_half : {false, true}) {
    const Colour other = right_half ? kWhite : kBlack;
    const double x0 = right_half ? 0.5 : 0.15, x1 = right_half ? 0.85 : 0.5;
    pattern.fields.push_back({x0, 0.1, x1, 0.5, left ? kGrey : other, left ? other : kGrey});
  }
  return pattern;
}

Pattern ruler_bar(int picture_width) {
  int pixels = 100;
  while (pixels + 100 <= picture_width * 9 / 10) pixels += 100;
  Pattern pattern;
  pattern.ground = kDim;
  pattern.bars.push_back({pixels});
  return pattern;
}

Pattern eye_marks() {
  Pattern pattern;
  pattern.ground = kDim;
  // A frame for both eyes, a vertical bar on the left for the left eye, a horizontal bar on the right for the right eye.
  pattern.fields.push_back({0.10, 0.08, 0.90, 0.10, kWhite, kWhite});
  pattern.fields.push_back({0.10, 0.48, 0.90, 0.50, kWhite, kWhite});
  pattern.fields.push_back({0.25, 0.15, 0.30, 0.43, kWhite, kDim});
  pattern.fields.push_back({0.60, 0.27, 0.80, 0.31, kDim, kWhite});
  return pattern;
}

}  // namespace prismesh::kiosk::calibration
