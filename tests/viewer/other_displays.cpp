#include "tests/viewer/other_displays.h"

#include <algorithm>
#include <cmath>

namespace prismesh::viewer {

namespace {

/// Every pixel of a part of the picture.
LightImage part_of(const LightImage& picture, int x0, int y0, int width, int height, int row_step) {
  LightImage part(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) part.at(x, y) = picture.at(x0 + x, y0 + y * row_step);
  return part;
}

LightImage through_glass(const LightImage& picture, bool red) {
  LightImage seen(picture.width, picture.height);
  for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
    const Colour& light = picture.pixels[i];
    // Behind a cyan glass the eye weighs green most (Rec. 709: 0.7152 to 0.0722).
    const float grey = red ? light[0] : (0.7152F * light[1] + 0.0722F * light[2]) / 0.7874F;
    seen.pixels[i] = {grey, grey, grey};
  }
  return seen;
}

LightImage alone(PlainKind kind, const LightImage& picture, bool first) {
  const int w = picture.width, h = picture.height;
  switch (kind) {
    case PlainKind::rows: return part_of(picture, 0, first ? 0 : 1, w, first ? (h + 1) / 2 : h / 2, 2);
    case PlainKind::side_by_side: return part_of(picture, first ? 0 : (w + 1) / 2, 0, first ? (w + 1) / 2 : w / 2, h, 1);
    case PlainKind::top_bottom: return part_of(picture, 0, first ? 0 : (h + 1) / 2, w, first ? (h + 1) / 2 : h / 2, 1);
    case PlainKind::anaglyph: return through_glass(picture, first);
    case PlainKind::ordinary: return picture;
  }
  return picture;
}

/// One direction of `resized`, along x.
LightImage resized_across(const LightImage& image, int width) {
  LightImage result(width, image.height);
  const double step = static_cast<double>(image.width) / width;
  for (int x = 0; x < width; ++x) {
    const double from = x * step, to = (x + 1) * step;
    const int first = static_cast<int>(from), last = std::min(image.width - 1, static_cast<int>(std::ceil(to)) - 1);
    for (int i = first; i <= last; ++i) {
      const auto share = static_cast<float>((std::min(to, i + 1.0) - std::max(from, static_cast<double>(i))) / step);
      for (int y = 0; y < image.height; ++y)
        for (std::size_t c = 0; c < 3; ++c) result.at(x, y)[c] += share * image.at(i, y)[c];
    }
  }
  return result;
}

LightImage transposed(const LightImage& image) {
  LightImage result(image.height, image.width);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) result.at(y, x) = image.at(x, y);
  return result;
}

}  // namespace

std::optional<PlainKind> plain_kind_from(std::string_view name) {
  for (std::size_t i = 0; i < kPlainKindNames.size(); ++i)
    if (kPlainKindNames[i] == name) return static_cast<PlainKind>(i);
  return std::nullopt;
}

LightImage seen_on(PlainKind kind, const LightImage& picture, bool left_eye, bool swapped, double leak) {
  LightImage seen = alone(kind, picture, left_eye != swapped);
  if (leak <= 0 || kind == PlainKind::ordinary) return seen;
  const LightImage other = alone(kind, picture, left_eye == swapped);
  for (int y = 0; y < seen.height; ++y)
    for (int x = 0; x < seen.width; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        seen.at(x, y)[c] += static_cast<float>(leak) * other.at(std::min(x, other.width - 1), std::min(y, other.height - 1))[c];
  return seen;
}

LightImage resized(const LightImage& image, int width, int height) {
  return transposed(resized_across(transposed(resized_across(image, width)), height));
}

}  // namespace prismesh::viewer
