// Where the nodes of transformed includes stand: the frames of all includes, worked out when all nodes are read, since transformations may
// be given by nodes and be defined after the include.
#pragma once

#include <span>
#include <vector>

#include "mesh/deck/assembly/piece_cards.h"
#include "mesh/deck/assembly/warnings.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/lsdyna/includes.h"
#include "mesh/deck/lsdyna/transformations.h"

namespace prismesh::mesh::deck::lsdyna {

/// One frame a context, in their order. Each piece's nodes are in one frame, whose number is that of the context. Pieces whose frame can't
/// be worked out are held; where it leads out of the range of numbers they get an error.
std::vector<Frame> include_frames(std::span<const IncludeContext> contexts, const Transformations& transformations,
                                  std::span<PieceCards> cards, Warnings& warnings);

}  // namespace prismesh::mesh::deck::lsdyna
