// Lays out the tree of files and parts, with the filter above it and the actions below that.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kiosk/panels/panel_layout.h"
#include "kiosk/render/part_paint.h"
#include "kiosk/tools/parts/part_tree.h"
#include "mesh/document/edit.h"

namespace prismesh::kiosk::tools::parts {

/// `on` is an expression of parts: an id, or file:NAME.
struct SetVisibility {
  std::string on;
  mesh::document::VisibilityAction action = mesh::document::VisibilityAction::hide;
};
/// Changes how this kiosk draws parts.
struct SetPaint {
  std::vector<std::int64_t> parts;  ///< ids
  std::optional<bool> transparent;  ///< absent: as it is
  bool colours = false;             ///< sets `colour`, too
  std::optional<render::Colour> colour;
};
struct PartWishes {
  std::vector<SetVisibility> edits;
  std::vector<SetPaint> paints;
};

/// Inside Gui::layout. What was clicked changes the tree at once; the rest is returned.
PartWishes part_list(PartTree& tree, panels::PanelLayout& layout);

/// The colours that can be chosen for a part: those that parts have by themselves, pale and full, and greys.
std::vector<render::Colour> choosable_colours();

unsigned packed(const render::Colour& colour);  ///< 0xAABBGGRR

}  // namespace prismesh::kiosk::tools::parts
