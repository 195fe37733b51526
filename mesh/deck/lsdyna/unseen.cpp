#include "mesh/deck/lsdyna/unseen.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

struct UnseenKeyword {
  std::string_view start;
  Unseen what;
};

constexpr Unseen kElements = {"unread-elements", "isn't read in this version; it is kept as it is and not shown", true};
constexpr Unseen kDevices = {"unread-elements", "is kept as it is; the device isn't shown", true};
constexpr Unseen kMoved = {"moved-at-start", "moves nodes when the solver starts; they are shown and edited where their cards put them"};
constexpr Unseen kMade = {"made-at-start", "makes parts and elements when the solver starts; they aren't shown", true};

/// The first entry that a keyword starts with counts.
constexpr UnseenKeyword kEntries[] = {
    {"ELEMENT_SEATBELT_", kDevices},
    {"ELEMENT_", kElements},
    {"IGA_", kElements},
    {"MESH_", kElements},
    {"COMPONENT_", kMade},
    {"PART_DUPLICATE", kMade},
    {"PART_STACKED_ELEMENTS", kMade},
    {"PART_MOVE", kMoved},
    {"NODE_TRANSFORM", kMoved},
    {"NODE_SCALAR", {"unread-nodes", "has nodes without a position; they are kept as they are and not shown", true}},
    {"NODE_RIGID_SURFACE", {"unread-nodes", "isn't read in this version; its nodes are kept as they are and not shown", true}},
    {"NODE_THICKNESS",
     {"overridden-thickness", "replaces the thickness of shells at nodes; they are shown with that of their own card or section", true}},
    {"NODE_MERGE", {"merged-at-start", "merges nodes when the solver starts; they are shown and edited as they stand in the deck"}},
    {"CASE_BEGIN", {"only-in-case", "and *CASE_END enclose what holds for some cases only; it is shown as if it always held"}},
};

}  // namespace

std::optional<Unseen> unseen(std::string_view keyword) {
  for (const UnseenKeyword& entry : kEntries)
    if (keyword.substr(0, entry.start.size()) == entry.start) return entry.what;
  return std::nullopt;
}

}  // namespace prismesh::mesh::deck::lsdyna
