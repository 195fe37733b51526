// Gives the reader and the card writer of each format.
#pragma once

#include <memory>

#include "base/error.h"
#include "mesh/deck/assembly/deck_contents.h"
#include "mesh/deck/assembly/file_set.h"
#include "mesh/deck/assembly/watch.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck {

/// Reads a deck. `files`: its main file; `watch` gets the progress and can stop it, then the result is incomplete. Errors: the deck can't
/// be read in this format; the reason, with file and line.
Result<DeckContents> read(Format format, FileSet files, Watch& watch);

std::unique_ptr<const CardWriter> card_writer(Format format);

}  // namespace prismesh::mesh::deck
