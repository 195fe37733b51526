// What can be said of a deck only when all its pieces are read: systems, scalar points, thicknesses, ids used twice.
#pragma once

#include <span>
#include <vector>

#include "mesh/deck/assembly/read_pieces.h"
#include "mesh/deck/nastran/piece.h"

namespace prismesh::mesh::deck::nastran {

/// Works out the coordinate systems, makes PieceRun::frame indices into `found.frames`, and holds the grid points that span a system or
/// stand in one that can't be worked out.
void settle_frames(DeckContents& found, std::span<PieceFacts> facts);

/// Takes scalar points out of elements' nodes and of what cards name: they have no place.
void settle_scalar_points(DeckContents& found, std::span<PieceFacts> facts);

/// Completes corner thicknesses by those of the properties.
void settle_thickness(DeckContents& found, std::span<const PieceFacts> facts, const PartTable& table);

/// Element ids are unique whatever the element: of equal ids the first counts.
void settle_element_ids(DeckContents& found);

}  // namespace prismesh::mesh::deck::nastran
