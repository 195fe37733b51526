// The section of the panel at the right that is about the pen.
#pragma once

#include <string>

#include "ipc/pen/messages.h"

namespace prismesh::kiosk::tools::pen {

/// What the user can do now, or what is wrong; a sentence.
std::string advice_for(const ipc::PenInfo& pen, bool holds);

/// Inside Gui::layout.
void pen_section(const ipc::PenInfo& pen, bool holds);
/// Its height in pixels in a panel of that inner width.
float pen_section_height(const ipc::PenInfo& pen, bool holds, float width);

}  // namespace prismesh::kiosk::tools::pen
