// Opens a window on an X11 display with its own OpenGL ES context.
#pragma once

#include <memory>
#include <string>

#include "kiosk/display/window.h"

namespace prismesh::kiosk::display::x11 {

struct X11Options {
  std::string title;
  PixelSize size{1600, 900};  ///< ignored when fullscreen
  bool fullscreen = false;
};

/// Opens the window and makes its context (OpenGL ES 3.1 or later) current on this thread, until the window is destroyed. Errors: no
/// display (says what to set), a display without EGL or OpenGL ES 3.1.
Result<std::unique_ptr<Window>> open_x11_window(const X11Options& options);

}  // namespace prismesh::kiosk::display::x11
