#include "kiosk/render/colour_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/LU>

namespace prismesh::kiosk::render {

namespace {

/// Matrices of [Ottosson 2020]: linear sRGB to cone responses; cube roots of cone responses to OKLab.
Eigen::Matrix3f cones_of_rgb() {
  Eigen::Matrix3f m;
  m << 0.4122214708F, 0.5363325363F, 0.0514459929F, 0.2119034982F, 0.6806995451F, 0.1073969566F, 0.0883024619F, 0.2817188376F,
      0.6299787005F;
  return m;
}
Eigen::Matrix3f lab_of_cones() {
  Eigen::Matrix3f m;
  m << 0.2104542553F, 0.7936177850F, -0.0040720468F, 1.9779984951F, -2.4285922050F, 0.4505937099F, 0.0259040371F, 0.7827717662F,
      -0.8086757660F;
  return m;
}

float linear_of(float value) { return value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F); }
float display_of(float value) { return value <= 0.0031308F ? 12.92F * value : 1.055F * std::pow(value, 1 / 2.4F) - 0.055F; }

/// Not clamped to 0..1.
Eigen::Vector3f linear_rgb_of(const Eigen::Vector3f& lab) {
  static const Eigen::Matrix3f cones = lab_of_cones().inverse(), rgb = cones_of_rgb().inverse();
  return rgb * (cones * lab).array().cube().matrix();
}

/// Lightness, chroma and hue in degrees at both ends of a map.
struct MapEnds {
  float lightness[2], chroma[2], hue[2];
};

/// The colour at `share` of the path between the ends, with less chroma where the display can't show it.
Eigen::Vector3f lab_at(const MapEnds& ends, float share) {
  const auto between = [share](const float(&values)[2]) { return values[0] + share * (values[1] - values[0]); };
  const float angle = between(ends.hue) * std::numbers::pi_v<float> / 180;
  const auto lab = [&](float chroma) {
    return Eigen::Vector3f(between(ends.lightness), chroma * std::cos(angle), chroma * std::sin(angle));
  };
  const auto shown = [&](float chroma) {
    const Eigen::Vector3f rgb = linear_rgb_of(lab(chroma));
    return (rgb.array() >= -1e-4F && rgb.array() <= 1.0001F).all();
  };
  float max_chroma = between(ends.chroma);
  if (shown(max_chroma)) return lab(max_chroma);
  float min_chroma = 0;
  for (int i = 0; i < 16; ++i) {
    const float middle = 0.5F * (min_chroma + max_chroma);
    (shown(middle) ? min_chroma : max_chroma) = middle;
  }
  return lab(min_chroma);
}

std::array<Colour, kColourMapSteps> make(const MapEnds& ends) {
  constexpr int kFine = 1024;
  std::vector<float> length(kFine + 1, 0.0F);
  for (int i = 1; i <= kFine; ++i)
    length[static_cast<std::size_t>(i)] =
        length[static_cast<std::size_t>(i - 1)] +
        (lab_at(ends, static_cast<float>(i) / kFine) - lab_at(ends, static_cast<float>(i - 1) / kFine)).norm();
  std::array<Colour, kColourMapSteps> colours;
  std::size_t at = 0;
  for (std::size_t i = 0; i < kColourMapSteps; ++i) {
    const float wanted = length.back() * static_cast<float>(i) / (kColourMapSteps - 1);
    while (at < kFine && length[at] < wanted) ++at;
    const Eigen::Vector3f rgb = linear_rgb_of(lab_at(ends, static_cast<float>(at) / kFine));
    for (int c = 0; c < 3; ++c) colours[i][c] = display_of(std::clamp(rgb[c], 0.0F, 1.0F));
  }
  return colours;
}

}  // namespace

std::optional<ColourMap> colour_map_from(std::string_view name) {
  for (std::size_t i = 0; i < kColourMapNames.size(); ++i)
    if (kColourMapNames[i] == name) return static_cast<ColourMap>(i);
  return std::nullopt;
}

const std::array<Colour, kColourMapSteps>& colours_of(ColourMap map) {
  static const auto crimson = make({{0.80F, 0.38F}, {0.10F, 0.19F}, {240, 378}});
  static const auto blues = make({{0.88F, 0.34F}, {0.06F, 0.14F}, {235, 262}});
  return map == ColourMap::blues ? blues : crimson;
}

Eigen::Vector3f oklab_of(const Colour& colour) {
  const Eigen::Vector3f linear(linear_of(colour.x()), linear_of(colour.y()), linear_of(colour.z()));
  const Eigen::Vector3f cones = cones_of_rgb() * linear;
  return lab_of_cones() * Eigen::Vector3f(std::cbrt(cones.x()), std::cbrt(cones.y()), std::cbrt(cones.z()));
}

}  // namespace prismesh::kiosk::render
