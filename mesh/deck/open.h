// Opens decks of every format.
#pragma once

#include <filesystem>
#include <memory>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/deck/data/deck.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::deck {

struct OpenedDeck {
  std::shared_ptr<const Deck> deck;
  Model model;  ///< complete, with adjacency
};

/// Opens a deck with its includes. Errors: not readable, not a deck (says what it looks like instead), a format that
/// this build doesn't read (named), a malformed card whose loss would matter (file and line).
Result<OpenedDeck> open(const std::filesystem::path& path, const Progress& progress = {}, const StandIns& stand_ins = {});

}  // namespace prismesh::mesh::deck
