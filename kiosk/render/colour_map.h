// One-dimensional colour maps for values: even steps for the eye, told apart by lightness alone, so that colour-blind people read them too.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "kiosk/render/palette.h"

namespace prismesh::kiosk::render {

enum class ColourMap : std::uint8_t {
  crimson,  ///< light blue over violet to a deep crimson, darker than the red that means fail
  blues,    ///< light to dark, one hue
};
inline constexpr std::array<std::string_view, 2> kColourMapNames{"crimson", "blues"};
std::optional<ColourMap> colour_map_from(std::string_view name);

inline constexpr std::size_t kColourMapSteps = 256;
/// From where a value begins to be shown to the limit. Equal steps are equal distances in OKLab (B. Ottosson, "A perceptual color space
/// for image processing", 2020), lightness only falls.
const std::array<Colour, kColourMapSteps>& colours_of(ColourMap map);

/// Lightness (0..1) and the two hue axes of a display colour.
Eigen::Vector3f oklab_of(const Colour& colour);

}  // namespace prismesh::kiosk::render
