// What stands in the picture about the pointer: the part of a handle below it, and words beside it. Drawn over the scene, which stays.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kiosk/panels/panel_layout.h"

namespace prismesh::kiosk::panels {

/// Draws wide green lines over a part of a handle (inside Gui::layout). Pixels of the picture.
void highlight_part(std::span<const std::vector<Eigen::Vector2d>> lines, const PanelLayout& layout);

/// Writes words below and to the right of the pointer, within the view (inside Gui::layout). Programs that watch find them as "hand".
void words_at_hand(const std::string& words, const Eigen::Vector2d& pointer, PanelLayout& layout);

}  // namespace prismesh::kiosk::panels
