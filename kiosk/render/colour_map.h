// Colour maps for values, with perceptually even steps. Lightness alone distinguishes the values, so that colour-blind people can read
// them.
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
/// The map of a name in kColourMapNames.
std::optional<ColourMap> colour_map_from(std::string_view name);

inline constexpr std::size_t kColourMapSteps = 256;
/// The map's colours, from the first limit to the second. Equal steps are equal distances in OKLab [Ottosson 2020]; lightness only falls.
const std::array<Colour, kColourMapSteps>& colours_of(ColourMap map);

/// OKLab coordinates of a display colour: lightness (0..1) and the two hue axes [Ottosson 2020].
Eigen::Vector3f oklab_of(const Colour& colour);

}  // namespace prismesh::kiosk::render
