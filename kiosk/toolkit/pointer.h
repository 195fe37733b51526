// The mouse pointer as tools meet it.
#pragma once

#include <optional>

#include "kiosk/input/gestures.h"

namespace prismesh::kiosk::toolkit {

/// Its pixel, if it is on the picture and on no panel.
using Pointer = std::optional<input::Pixel>;

}  // namespace prismesh::kiosk::toolkit
