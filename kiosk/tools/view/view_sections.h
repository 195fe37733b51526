// The sections of the panels that are about the view: colours, display, eyes and depth.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kiosk/panels/panel_layout.h"
#include "kiosk/toolkit/eyes_facts.h"

namespace prismesh::kiosk::tools::view {

/// Lays out what the model is coloured by, in a word, and the display profile (inside Gui::layout). Returns another profile, if the user
/// chose one.
std::optional<std::string> picture_section(const std::string& colours, const std::string& profile, const std::vector<std::string>& profiles,
                                           panels::PanelLayout& layout);
/// Lays out whether shells are drawn with their thickness, and what the picture doesn't show of it.
void thickness_section(bool thickness, const std::string& note, panels::PanelLayout& layout);
/// The profiles as entries of a menu or list.
std::optional<std::string> profile_entries(const std::string& now, const std::vector<std::string>& profiles, panels::PanelLayout& layout);

/// How much depth the picture has.
struct DepthFacts {
  int strength_percent = 100;
  double comfort_degrees = 1;
  bool selection_in_plane = false;  ///< the selection is kept in the plane of the screen
};

/// Whatever of it there is: eyes if they are followed, depth if the picture is in stereo.
struct StereoFacts {
  std::optional<toolkit::EyesFacts> eyes;
  std::optional<DepthFacts> depth;
};
void stereo_sections(const StereoFacts& facts, panels::PanelLayout& layout);

}  // namespace prismesh::kiosk::tools::view
