// The monitor that a place of an X11 desktop lies on, as the RandR extension describes it.
#pragma once

#include <optional>

#include <X11/Xlib.h>

#include "kiosk/display/monitor.h"

namespace prismesh::kiosk::display {

/// The monitor that shows most of the rectangle (desktop pixels); empty without RandR 1.3 or when no monitor shows any of it. Asks the X
/// server several times: once when something changed, not for each picture.
std::optional<Monitor> monitor_at(Display* display, ::Window root, int x, int y, PixelSize size);

}  // namespace prismesh::kiosk::display
