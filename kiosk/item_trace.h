// Tells programs that watch what can be clicked or read on the screen.
#pragma once

#include <vector>

#include "kiosk/notices/trace.h"
#include "kiosk/panels/panel_layout.h"

namespace prismesh::kiosk {

class ItemTrace {
 public:
  /// Tells which items have come, changed or gone since the last call.
  void tell(const notices::Trace& trace, std::vector<panels::ScreenItem> items);

 private:
  std::vector<panels::ScreenItem> told_;
};

}  // namespace prismesh::kiosk
