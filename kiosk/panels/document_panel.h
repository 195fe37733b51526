// The sections of the document's panel that belong to no tool. To be called inside Gui::layout.
#pragma once

#include "kiosk/panels/panel_facts.h"

namespace prismesh::kiosk::panels {

/// The deck's name, and the model's size and units.
void document_head(const DocumentFacts& document);
void history_section(const HistoryFacts& history);
/// The keys that open more.
void document_foot();

}  // namespace prismesh::kiosk::panels
