// A window that is the whole screen, without a display server: the kiosk's own on a station.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/clock.h"
#include "kiosk/display/kms/output.h"
#include "kiosk/display/window.h"

namespace prismesh::kiosk::display::kms {

struct BareOptions {
  WantedOutput output;
  bool may_switch_consoles = false;                ///< Ctrl+Alt+F1 and so on show a text console
  std::function<void(const std::string&)> tell{};  ///< gets a sentence for each thing that a technician should know
};

/// Takes the seat, shows black on the chosen monitor, and makes an OpenGL ES context current on this thread until the window is destroyed.
/// Errors, as sentences: no seat, no graphics card, none with atomic mode setting, no monitor, no such mode, no OpenGL ES 3.1.
Result<std::unique_ptr<Window>> open_bare_window(const BareOptions& options, Clock& clock);

}  // namespace prismesh::kiosk::display::kms
