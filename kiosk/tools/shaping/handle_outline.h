// Where a part of the handle lies in the picture.
#pragma once

#include <vector>

#include "kiosk/input/gestures.h"
#include "kiosk/render/picture.h"
#include "kiosk/stereo/pointer.h"

namespace prismesh::kiosk::tools::shaping {

/// The lines along which a part of the handle is seen: the arrow, the rims of disk and ring, the circle and ball of an axis. Each pixel of
/// them takes that part, unless another part is in front. Pieces behind the eye are left out.
std::vector<std::vector<input::Pixel>> outline_of_part(const stereo::Aim& aim, const render::Handle& handle, input::Under part);

}  // namespace prismesh::kiosk::tools::shaping
