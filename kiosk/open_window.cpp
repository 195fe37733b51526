#include "kiosk/open_window.h"

#include <cstdlib>

#include "kiosk/display/kms/bare_window.h"
#include "kiosk/display/x11/x11_window.h"

namespace prismesh::kiosk {

using drivers::settings::ScreenKind;

Result<std::unique_ptr<display::Window>> open_window(const WindowOptions& options, Clock& clock) {
  const char* server = std::getenv("DISPLAY");
  const bool session = server != nullptr && *server != '\0';
  if (options.screen == ScreenKind::x11 || (options.screen == ScreenKind::usual && session))
    return display::x11::open_x11_window({options.title, options.size, options.fullscreen});
  display::kms::BareOptions bare;
  bare.output = {options.connector, options.mode, options.refresh_hz};
  bare.may_switch_consoles = options.may_switch_consoles;
  bare.tell = options.tell;
  Result<std::unique_ptr<display::Window>> window = display::kms::open_bare_window(bare, clock);
  if (!window && options.screen == ScreenKind::usual)
    return fail("", "no display: DISPLAY names no X server, and the bare screen can't be used (" + window.error().text() +
                        "); --headless-frames N --shots DIR draws pictures without a display");
  return window;
}

}  // namespace prismesh::kiosk
