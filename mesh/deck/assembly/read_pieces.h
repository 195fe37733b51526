// Reads pieces of text in parallel, for the readers of all formats.
#pragma once

#include <cstddef>
#include <functional>

#include "mesh/deck/assembly/deck_contents.h"
#include "mesh/deck/assembly/piece_cards.h"
#include "mesh/deck/assembly/watch.h"

namespace prismesh::mesh::deck {

/// The size of a piece of text: large enough to be worth a thread's while, small enough to give each thread several.
inline constexpr std::size_t kPieceBytes = std::size_t{1} << 20;

/// Hashes all files and reads all pieces, in parallel: fills `hashes` and `cards`. `read(i)` is called once for each piece, from any
/// thread. The progress goes to kRead.
void read_pieces(DeckContents& found, std::size_t pieces, const std::function<PieceCards(std::size_t)>& read, Watch& watch);

}  // namespace prismesh::mesh::deck
