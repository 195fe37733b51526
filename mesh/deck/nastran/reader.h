// Reads Nastran bulk data: walks over its files, reads all cards in parallel, and puts the model together.
#pragma once

#include <filesystem>

#include "mesh/deck/deck.h"

namespace prismesh::mesh::deck::nastran {

/// `main` is the main file, already read. See deck::open for errors.
Result<OpenedDeck> read(const std::filesystem::path& path, FileBytes main, const Progress& progress);

}  // namespace prismesh::mesh::deck::nastran
