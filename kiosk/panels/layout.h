// Small pieces that panels are put together from. For sources that lay panels out: includes ImGui.
#pragma once

#include <cmath>
#include <string>

#include <imgui.h>

#include "kiosk/display/window.h"
#include "kiosk/panels/gui.h"

namespace prismesh::kiosk::panels {

inline constexpr ImGuiWindowFlags kPanelFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                                ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

/// A grid multiple near `value`.
inline float on_grid(float value) { return kGrid * std::round(value / kGrid); }

/// Width of a side panel: twenty characters of the body's size, never more than a third of the picture.
inline float side_width(display::PixelSize picture) {
  const float wanted = ImGui::GetFontSize() * 18.5f, most = static_cast<float>(picture.width) * 0.3f;
  return on_grid(wanted < most ? wanted : most);
}
inline constexpr float kMargin = 2 * kGrid;

/// A signal: its meaning in shape and colour. Warn is a triangle, fail a square, everything else a disc.
enum class Signal { ok, warn, fail, information };
void draw_signal(Signal signal, float size);

/// Text that keeps to the width left in the line, its middle elided; the whole text in a tooltip.
void elided_text(const std::string& text, float width);

/// "label ........ value" over the panel's width; the value stands at the right.
void fact(const char* label, const std::string& value);

void section(const char* title);

/// The panel at the left, as high as its content but within the picture: then it scrolls.
void begin_left(const char* name, display::PixelSize picture);

/// A panel in the middle of the picture, as high as its content.
void begin_centred(const char* name, display::PixelSize picture, float width);

}  // namespace prismesh::kiosk::panels
