// The panels one by one. For panels*.cpp only.
#pragma once

#include <vector>

#include "kiosk/display/window.h"
#include "kiosk/panels/layout.h"
#include "kiosk/panels/panel_facts.h"

namespace prismesh::kiosk::panels {

using Actions = std::vector<PanelAction>;

void document_panel(const PanelData& data, display::PixelSize picture, Actions& actions);
void shaping_panel(const PanelData& data, display::PixelSize picture, Actions& actions);
void quality_panel(const PanelData& data, display::PixelSize picture, Actions& actions);
void model_panel(const PanelData& data, display::PixelSize picture, Actions& actions);
void compare_panel(const PanelData& data, display::PixelSize picture, CompareEntry& entry, Actions& actions);
/// Which state is seen where, a line each at the top of the picture.
void view_captions(const CompareFacts& facts, display::PixelSize picture, float top);
void warnings_panel(const PanelData& data, display::PixelSize picture);
void help_panel(const PanelData& data, display::PixelSize picture);
void menu_panel(const PanelData& data, display::PixelSize picture, Actions& actions);
/// `opened`: it wasn't there the last time.
void expression_box(const PanelData& data, display::PixelSize picture, bool opened, EntryState& entry, Actions& actions);
void number_box(const PanelData& data, display::PixelSize picture, bool opened, EntryState& entry, Actions& actions);

void question_box(const tools::Question& question, display::PixelSize picture, Actions& actions);

/// What is set, and a button that takes the next: "falloff ..... smooth".
void setting(const char* label, const std::string& value, tools::Command next, Actions& actions);
/// What the command of the item before does, while the pointer is over it.
void hint(tools::Command command);
void begin_centred(const char* name, display::PixelSize picture, float width);

}  // namespace prismesh::kiosk::panels
