// Arranges the panels of the tools and the editor about the view: bar, rail, dock, options and status line. Messages, boxes and what
// covers the view lie over it.
#pragma once

#include <string>

#include "kiosk/input/mouse_layout.h"
#include "kiosk/kept_arrangement.h"
#include "kiosk/panels/panel_layout.h"
#include "kiosk/toolkit/tool_context.h"

namespace prismesh::kiosk {

class PanelArrangement {
 public:
  explicit PanelArrangement(KeptArrangement kept) : kept_(std::move(kept)) {}

  /// Lays all panels out (inside Gui::layout); what the user asked for goes into the layout. `mouse`: what the mouse does, for the help.
  void build(toolkit::ToolContext& context, std::span<const input::MouseBinding> mouse, panels::PanelLayout& layout);

 private:
  void build_dock(toolkit::ToolContext& context, panels::PanelLayout& layout);
  void build_box(toolkit::ToolContext& context, panels::PanelLayout& layout);
  void build_menu(toolkit::ToolContext& context, panels::PanelLayout& layout);
  void keep_tab(const std::string& shown);
  void follow_borders(panels::PanelLayout& layout);

  toolkit::OpenPanels::Dialog shown_dialog_;
  std::optional<input::Pixel> menu_at_;  ///< of the menu that is open under the pointer
  KeptArrangement kept_;
  bool tab_brought_ = false;  ///< the kept tab was shown, or can't be
  int tab_tries_ = 0;
};

}  // namespace prismesh::kiosk
