// What the tab "Model" shows. To be called inside Gui::layout.
#pragma once

#include "kiosk/panels/panel_facts.h"

namespace prismesh::kiosk::panels {

/// The deck's folder, and the model's size and units.
void model_facts(const DocumentFacts& document);
/// What the states kept for undo take.
void history_facts(const HistoryFacts& history);
void video_memory_facts(const VideoMemoryFacts& memory);

}  // namespace prismesh::kiosk::panels
