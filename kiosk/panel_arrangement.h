// Arranges the panels of the tools and the editor: document and tools at the left, quality and parts at the right, messages over the
// picture.
#pragma once

#include <span>

#include "kiosk/tools/mouse_layout.h"
#include "kiosk/tools/panel_layout.h"
#include "kiosk/tools/tool_context.h"

namespace prismesh::kiosk {

class PanelArrangement {
 public:
  /// Lays all panels out (inside Gui::layout); what the user asked for goes into the layout. `mouse`: what the mouse does, for the help.
  void build(tools::ToolContext& context, std::span<const tools::MouseBinding> mouse, tools::PanelLayout& layout);
  /// Pixels of the picture's width that the panels at the sides take.
  double covered_width() const { return covered_width_; }

 private:
  void build_box(tools::ToolContext& context, tools::PanelLayout& layout);

  tools::OpenPanels::Dialog shown_dialog_;
  double covered_width_ = 0;
};

}  // namespace prismesh::kiosk
