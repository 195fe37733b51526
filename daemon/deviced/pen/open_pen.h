// The pen of the settings with its line: opened, and handed to the guard.
#pragma once

#include <memory>
#include <string>

#include "base/error.h"
#include "daemon/deviced/pen/line_guard.h"
#include "drivers/haptic_pen/pen.h"
#include "drivers/settings/settings.h"

namespace prismesh::deviced::pen {

class OpenPen {
 public:
  virtual ~OpenPen() = default;
  virtual drivers::haptic_pen::HapticPen& pen() = 0;
  /// Errors: as LineGuard::watch.
  virtual Result<void> hand_to(LineGuard& guard) = 0;
};

/// What a user calls the place of this pen; empty: the daemon makes a line for a simulated one.
std::string pen_place(const drivers::settings::HapticPenSettings& settings);

/// Opens it. All that is sent takes the line's token of `page`, which must outlive the pen. Errors: the line can't be opened, a Falcon's
/// firmware file is bad, the Inverse3's service doesn't run or knows no device; a sentence each.
Result<std::unique_ptr<OpenPen>> open_pen(const drivers::settings::HapticPenSettings& settings, const std::string& place, GuardPage& page);

}  // namespace prismesh::deviced::pen
