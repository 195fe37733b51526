// Steps that need all pieces of a deck: coordinate systems, scalar points, thicknesses, ids that are used twice.
#pragma once

#include <span>
#include <vector>

#include "mesh/deck/assembly/read_pieces.h"
#include "mesh/deck/nastran/piece_facts.h"

namespace prismesh::mesh::deck::nastran {

/// Resolves the coordinate systems, turns PieceRun::frame into indices into `found.frames`, and holds the grid points that span a system or
/// stand in one that can't be resolved.
void settle_frames(DeckContents& found, std::span<PieceFacts> facts);

/// Removes scalar points from elements' nodes and from what cards name: they have no coordinates.
void settle_scalar_points(DeckContents& found, std::span<PieceFacts> facts);

/// Fills found.taken by scalar points and aerodynamic boxes. The solvers differ in what boxes may share numbers with, so nothing new gets
/// theirs. Source: MSC Nastran Quick Reference Guide, "SPOINT", "EPOINT", "CAERO1" to "CAERO5".
void settle_taken_ids(DeckContents& found, std::span<const PieceFacts> facts);

/// Completes corner thicknesses by those of the properties.
void settle_thickness(DeckContents& found, std::span<const PieceFacts> facts, const PartTable& table);

/// Warns of elements of different classes with one id, which the manuals advise against.
void note_shared_element_ids(DeckContents& found);

}  // namespace prismesh::mesh::deck::nastran
