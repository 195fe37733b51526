// The panels: document and tools on the left, quality and parts on the right, a sentence at the bottom.
#pragma once

#include <string>
#include <vector>

#include "kiosk/display/window.h"
#include "kiosk/panels/panel_facts.h"

namespace prismesh::kiosk::panels {

/// Lays out all panels (inside Gui::layout) and says what the user asked of them.
class Panels {
 public:
  std::vector<PanelAction> build(const PanelData& data, display::PixelSize picture);
  /// Pixels of the picture's width that the side panels take.
  double covered_width() const { return covered_width_; }

 private:
  void build_dialog(const PanelData& data, display::PixelSize picture, std::vector<PanelAction>& actions);
  void build_path(const PanelData& data, std::vector<PanelAction>& actions, bool opened);

  Dialog shown_dialog_ = Dialog::none;
  std::string typed_;
  EntryState entry_;
  CompareEntry compare_entry_;
  bool caret_to_end_ = false;
  std::vector<std::string> offered_;
  std::string offered_for_;
  double covered_width_ = 0;
};

}  // namespace prismesh::kiosk::panels
