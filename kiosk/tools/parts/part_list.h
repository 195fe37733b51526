// The list of parts and files, the part of the panel at the right that scrolls.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kiosk/panels/panel_layout.h"
#include "mesh/document/edit.h"

namespace prismesh::kiosk::tools::parts {

struct PartRow {
  std::int64_t id = 0;
  std::string name;
  std::uint64_t shells = 0;
  unsigned colour = 0;  ///< 0xAABBGGRR, as the picture shows it
  bool hidden = false;
  bool locked = false;
};

/// A file of the deck that holds shells.
struct FileRow {
  std::string name;
  std::uint64_t shells = 0;
  std::size_t parts = 0;
  bool hidden = false, locked = false;  ///< all of its parts are
};

struct PartFacts {
  std::vector<PartRow> parts;
  std::vector<FileRow> files;  ///< none if there is only one
};

/// `on` is an expression of parts: an id, or file:NAME.
struct SetVisibility {
  std::string on;
  mesh::document::VisibilityAction action = mesh::document::VisibilityAction::hide;
};

/// Lays the list out (inside Gui::layout). Returns what the user asked for.
std::vector<SetVisibility> part_list(const PartFacts& facts, panels::PanelLayout& layout);

}  // namespace prismesh::kiosk::tools::parts
