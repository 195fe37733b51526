// What each format has of its own: its reader and its writer of cards.
#pragma once

#include <memory>

#include "base/error.h"
#include "mesh/deck/assembly/file_set.h"
#include "mesh/deck/assembly/read_pieces.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck {

/// Reads a deck whose main file is in `files`. Told to stop, it returns what it has. Errors: a malformed card whose loss would matter (file
/// and line), cancelled.
Result<DeckContents> read(Format format, FileSet files, Watch& watch);

std::unique_ptr<const CardWriter> card_writer(Format format);

}  // namespace prismesh::mesh::deck
