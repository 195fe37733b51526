// Arranges the panels of the tools and the editor: document and tools at the left, quality and parts at the right, messages over the
// picture.
#pragma once

#include <span>

#include "kiosk/input/mouse_layout.h"
#include "kiosk/panels/panel_layout.h"
#include "kiosk/toolkit/tool_context.h"

namespace prismesh::kiosk {

class PanelArrangement {
 public:
  /// Lays all panels out (inside Gui::layout); what the user asked for goes into the layout. `mouse`: what the mouse does, for the help.
  void build(toolkit::ToolContext& context, std::span<const input::MouseBinding> mouse, panels::PanelLayout& layout);
  /// Pixels of the picture's width that the panels at the sides take.
  double covered_width() const { return covered_width_; }

 private:
  void build_box(toolkit::ToolContext& context, panels::PanelLayout& layout);

  toolkit::OpenPanels::Dialog shown_dialog_;
  double covered_width_ = 0;
};

}  // namespace prismesh::kiosk
