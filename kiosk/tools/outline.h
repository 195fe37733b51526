// Outlines drawn on the picture. Pure.
#pragma once

#include <vector>

#include "kiosk/tools/gestures.h"

namespace prismesh::kiosk::tools {

/// What a closed outline encloses at `least_x` and right of it, as an outline (I. E. Sutherland, G. W. Hodgman, 1974); empty if nothing.
std::vector<Pixel> kept_right_of(const std::vector<Pixel>& outline, double least_x);

}  // namespace prismesh::kiosk::tools
