// A window on an X11 display with an OpenGL ES context of its own.
#pragma once

#include <memory>
#include <string>

#include "kiosk/display/window.h"

namespace prismesh::kiosk::display {

struct X11Options {
  std::string title;
  PixelSize size{1600, 900};  ///< ignored when fullscreen
  bool fullscreen = false;
};

/// Opens the window and makes its context (OpenGL ES 3.1 or later) current on this thread; it stays current until the window
/// dies. Errors: no display (says what to set), no EGL or no OpenGL ES 3.1 on it.
Result<std::unique_ptr<Window>> open_x11_window(const X11Options& options);

}  // namespace prismesh::kiosk::display
