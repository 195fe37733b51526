// How far relaxing and repairing may move nodes: what the hand sets for all of these commands. Plain data.
#pragma once

#include <optional>

#include "mesh/document/edit.h"

namespace prismesh::kiosk::tools::quality {

/// Lengths in the deck's unit.
struct MendLimits {
  mesh::document::MoveLimits max_move;
  std::optional<double> threshold;  ///< relaxing from a node: one that moves farther adds its neighbours; empty: the document's own
};

/// One of the numbers, as it is typed.
enum class MendLimit : std::uint8_t { sheet, line, threshold };

}  // namespace prismesh::kiosk::tools::quality
