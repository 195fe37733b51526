// The panel on which states and fields to compare are chosen, and the captions of the views.
#pragma once

#include <optional>

#include "kiosk/panels/panel_layout.h"
#include "kiosk/tools/comparison/legend_facts.h"

namespace prismesh::kiosk::tools::comparison {

/// Lays the panel out (inside Gui::layout). Returns another wish, if the user chose one.
std::optional<CompareWish> compare_panel(const CompareFacts& facts, CompareEntry& entry);

/// Says which state is seen where: a line for each at the top of the picture.
void view_captions(const CompareFacts& facts, int picture_width, float top);

}  // namespace prismesh::kiosk::tools::comparison
