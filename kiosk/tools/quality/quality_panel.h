// The panel at the left that shows quality in figures.
#pragma once

#include "kiosk/panels/panel_layout.h"
#include "kiosk/tools/quality/quality_facts.h"

namespace prismesh::kiosk::tools::quality {

/// Lays the panel out (inside Gui::layout). Returns what the user asked for beside commands.
QualityActions quality_panel(const QualityFacts& facts, panels::PanelLayout& layout);

}  // namespace prismesh::kiosk::tools::quality
