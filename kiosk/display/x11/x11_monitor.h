// Finds the monitor at a position of an X11 desktop through the RandR extension.
#pragma once

#include <optional>

#include <X11/Xlib.h>

#include "kiosk/display/monitor.h"

namespace prismesh::kiosk::display::x11 {

/// The monitor that shows the largest part of the rectangle (desktop pixels); empty without RandR 1.3 or if no monitor shows any of it. It
/// takes several requests to the X server, so call it after a change, not for each picture.
std::optional<Monitor> monitor_at(Display* display, ::Window root, int x, int y, PixelSize size);

}  // namespace prismesh::kiosk::display::x11
