// Colours of the picture: a grey ground, part colours that colour-blind people can distinguish, and colours with a meaning, which no part
// has. Display values, 0..1.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace prismesh::kiosk::render {

using Colour = Eigen::Vector3f;

/// Seven hues in the order of [Okabe 2008] (orange, sky blue, bluish green, yellow, blue, vermilion, purple), lightened, in three
/// lightnesses; the last entry is for shells without a part.
inline constexpr std::size_t kPartColours = 22;
inline constexpr std::size_t kColourOfNoPart = 21;
const std::array<Colour, kPartColours>& part_colours();
/// Index into part_colours() for a PartIndex.
inline std::size_t colour_of_part(std::size_t part, std::size_t part_count) { return part < part_count ? part % 21 : kColourOfNoPart; }

/// Colours of a shell's grade in quality mode: ok, warn, fail.
const std::array<Colour, 3>& grade_colours();

inline const Colour kGroundTop{0.475F, 0.48F, 0.49F};
inline const Colour kGroundBottom{0.36F, 0.365F, 0.375F};
inline const Colour kSelectedColour{1.0F, 1.0F, 1.0F};
inline const Colour kActiveColour{0.22F, 0.72F, 0.36F};
inline const Colour kWarnColour{0.98F, 0.83F, 0.10F};
inline const Colour kFailColour{0.88F, 0.14F, 0.12F};
inline const Colour kInformationColour{0.36F, 0.66F, 0.98F};
/// The stripes on shells that touch: far apart in lightness, so that they show without colours, too.
inline const Colour kAlertBright{1.0F, 0.86F, 0.16F};
inline const Colour kAlertDark{0.07F, 0.07F, 0.09F};
inline const Colour kBorderColour{0.10F, 0.11F, 0.13F};
inline const Colour kCreaseColour{0.16F, 0.17F, 0.19F};
inline const Colour kLineElementColour{0.20F, 0.22F, 0.27F};

}  // namespace prismesh::kiosk::render
