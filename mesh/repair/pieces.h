// Divides a repair into pieces that have no node in common, so that each can be repaired alone. docs/repairing.md describes it under
// "Pieces and threads".
#pragma once

#include <cstddef>
#include <vector>

#include "mesh/repair/context.h"
#include "mesh/repair/repair_state.h"

namespace prismesh::mesh::repair {

struct Piece {
  ShellSet shells;       ///< that its repair may change; ascending
  std::size_t work = 0;  ///< shells to repair, and nodes with too many triangles
  std::size_t bad = 0;   ///< shells to repair
};

/// The pieces of a repair, by ascending first shell. `whole`: the scope and the rings about it, judged. A piece is what a repair can reach
/// of some shells to repair: the shells around them, and the strips of quads that run through wide or narrow ones. Pieces that would have a
/// node in common are one piece. Shells that no repair needs are in none. `clusters`: nodes of the model with too many triangles,
/// ascending.
std::vector<Piece> pieces_of(const RepairContext& whole, const ChangeHistory& history, const NodeSet& clusters);

/// Shares out what a limit allows: every piece gets a little, as long as there is enough, and the rest goes by the pieces' work. The shares
/// depend on the pieces alone; their sum isn't above `allowed`, which isn't negative.
std::vector<long> shares_of(const std::vector<Piece>& pieces, long allowed);

}  // namespace prismesh::mesh::repair
