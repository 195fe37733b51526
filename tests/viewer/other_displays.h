// What each eye sees of displays without a mask to trace: polarised rows, pictures side by side or one above the other, coloured glasses.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "tests/viewer/light.h"

namespace prismesh::viewer {

enum class PlainKind : unsigned char {
  rows,          ///< every other row polarised for the other glass
  side_by_side,  ///< the display stretches each half over its whole width
  top_bottom,    ///< likewise over its height
  anaglyph,      ///< red before the left eye, cyan before the right
  ordinary,      ///< both eyes see all
};
inline constexpr std::array<std::string_view, 5> kPlainKindNames{"rows", "side-by-side", "top-bottom", "anaglyph", "ordinary"};
std::optional<PlainKind> plain_kind_from(std::string_view name);

/// `swapped`: the right eye has the even rows (0, the uppermost, is even), the right half, the lower half or the red glass's place. `leak`:
/// share of the other eye's light that comes through as well. Rows: half the height; side by side: half the width; top-bottom: half the
/// height; the odd row or column that is left over is the first picture's. Anaglyph: grey.
LightImage seen_on(PlainKind kind, const LightImage& picture, bool left_eye, bool swapped = false, double leak = 0);

/// Brought to another size, each pixel the mean of what it covers.
LightImage resized(const LightImage& image, int width, int height);

}  // namespace prismesh::viewer
