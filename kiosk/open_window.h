// Opens a window on what this computer has: in an X11 session, or on the bare screen.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/clock.h"
#include "base/error.h"
#include "drivers/settings/settings.h"
#include "kiosk/display/window.h"

namespace prismesh::kiosk {

struct WindowOptions {
  drivers::settings::ScreenKind screen = drivers::settings::ScreenKind::usual;
  std::string title;
  display::PixelSize size{1600, 900};  ///< ignored when fullscreen, and on a bare screen
  bool fullscreen = false;
  // Of a bare screen only.
  std::string connector;                           ///< "DP-1"; empty: the first with a monitor
  display::PixelSize mode;                         ///< empty: the panel's own
  double refresh_hz = 0;                           ///< 0: the monitor's own
  bool may_switch_consoles = false;                ///< Ctrl+Alt+F1 and so on show a text console
  std::function<void(const std::string&)> tell{};  ///< gets a sentence for each thing that a technician should know
};

/// Opens the window and makes its context (OpenGL ES 3.1 or later) current on this thread, until the window is destroyed. Errors, as
/// sentences that say what to do: no display, no right to it, no EGL or OpenGL ES 3.1.
Result<std::unique_ptr<display::Window>> open_window(const WindowOptions& options, Clock& clock);

}  // namespace prismesh::kiosk
