// Cuts mesh text into pieces, and repeats them for each instance of their part.
#pragma once

#include <string_view>
#include <vector>

#include "base/error.h"
#include "mesh/deck/abaqus/outline.h"

namespace prismesh::mesh::deck::abaqus {

/// Adds a segment to the last piece, or to new ones where that is full or differs from `place` (a piece without segments).
/// `text`: of the whole file.
void add_mesh(std::vector<Piece>& pieces, const Piece& place, const MeshSegment& segment, std::string_view text);

/// Copies the pieces of each part to its instances, and notes parts that have none or several. Without instances the parts stay as they
/// are. Errors: the copies would need more memory than this version takes.
Result<void> place_instances(DeckOutline& outline);

}  // namespace prismesh::mesh::deck::abaqus
