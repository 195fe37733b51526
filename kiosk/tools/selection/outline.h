// Clips outlines that were drawn on the picture. Pure.
#pragma once

#include <vector>

#include "kiosk/input/gestures.h"

namespace prismesh::kiosk::tools::selection {

/// The part of a closed outline at `min_x` and right of it, as an outline; empty if there is none (I. E. Sutherland, G. W. Hodgman,
/// 1974).
std::vector<input::Pixel> kept_right_of(const std::vector<input::Pixel>& outline, double min_x);

}  // namespace prismesh::kiosk::tools::selection
