// What each eye sees of displays without a mask: polarised rows, pictures side by side or one above the other, coloured glasses.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "tests/viewer/light.h"

namespace prismesh::viewer {

enum class PlainKind : unsigned char {
  rows,          ///< every second row polarised for the other glass
  side_by_side,  ///< the display stretches each half over its whole width
  top_bottom,    ///< the display stretches each half over its whole height
  anaglyph,      ///< red before the left eye, cyan before the right
  ordinary,      ///< both eyes see everything
};
inline constexpr std::array<std::string_view, 5> kPlainKindNames{"rows", "side-by-side", "top-bottom", "anaglyph", "ordinary"};
std::optional<PlainKind> plain_kind_from(std::string_view name);

/// `swapped`: the right eye has the even rows (0, the uppermost, is even), the right half, the lower half or the red glass. `leak`: share
/// of the other eye's light that is seen too. Rows: half the height; side by side: half the width; top-bottom: half the height; an extra
/// odd row or column belongs to the first picture. Anaglyph: grey.
LightImage seen_on(PlainKind kind, const LightImage& picture, bool left_eye, bool swapped = false, double leak = 0);

/// Resizes a picture; each pixel is the mean of the area that it covers.
LightImage resized(const LightImage& image, int width, int height);

}  // namespace prismesh::viewer
