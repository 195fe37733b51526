// Small pieces that panels are put together from. For sources that lay panels out: includes ImGui.
#pragma once

#include <cmath>
#include <string>

#include <imgui.h>

#include "kiosk/display/window.h"
#include "kiosk/panels/gui.h"
#include "kiosk/panels/places.h"

namespace prismesh::kiosk::panels {

inline constexpr ImGuiWindowFlags kPanelFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                                ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

/// A grid multiple near `value`.
inline float on_grid(float value) { return kGrid * std::round(value / kGrid); }
inline constexpr float kMargin = 2 * kGrid;

/// A signal: its meaning in shape and colour. Warn is a triangle, fail a square, everything else a disc.
enum class Signal { ok, warn, fail, information };
void draw_signal(Signal signal, float size);

/// Text that keeps to the width left in the line, its middle elided; the whole text in a tooltip.
void elided_text(const std::string& text, float width);

/// "label ........ value" over the panel's width; the value stands at the right.
void fact(const char* label, const std::string& value);

void section(const char* title);

/// A panel that fills its place, opaque and without rounded corners.
void begin_docked(const char* name, const Place& place, ImGuiWindowFlags flags = 0);

/// A panel in the middle of a room, as high as its content.
void begin_centred(const char* name, const Place& room, float width);

}  // namespace prismesh::kiosk::panels
