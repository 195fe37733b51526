// The key of colours that mean a grade.
#pragma once

#include "kiosk/panels/panel_layout.h"
#include "kiosk/render/picture.h"

namespace prismesh::kiosk::tools::view {

/// Lays the key out at the bottom of the picture (inside Gui::layout), and takes its room from the layout. Colours of parts have none.
void colour_key(render::ColourMode colour, panels::PanelLayout& layout);

}  // namespace prismesh::kiosk::tools::view
