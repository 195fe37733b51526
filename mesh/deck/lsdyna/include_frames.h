// Computes the frames of transformed includes. This is possible only when all nodes are read: a transformation may be given by nodes and
// be defined after the include.
#pragma once

#include <span>
#include <vector>

#include "mesh/deck/assembly/piece_cards.h"
#include "mesh/deck/assembly/warnings.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/lsdyna/includes.h"
#include "mesh/deck/lsdyna/transformations.h"

namespace prismesh::mesh::deck::lsdyna {

/// One frame for each context, in their order. All nodes of a piece are in one frame; its index is that of the context. Pieces whose frame
/// can't be computed become held. Pieces that a frame moves too far away get an error.
std::vector<Frame> include_frames(std::span<const IncludeContext> contexts, const Transformations& transformations,
                                  std::span<PieceCards> cards, Warnings& warnings);

}  // namespace prismesh::mesh::deck::lsdyna
