// Reads a piece of bulk data into arrays of ids. This part of reading has to be fast. Runs on any thread.
#pragma once

#include <string_view>

#include "mesh/deck/nastran/piece_facts.h"

namespace prismesh::mesh::deck::nastran {

/// `text`: of the piece's whole file. A malformed card ends the reading; its place and message are in PieceCards::error.
PieceContent read_piece(std::string_view text, const Piece& piece);

}  // namespace prismesh::mesh::deck::nastran
