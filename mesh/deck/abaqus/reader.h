// Reads an Abaqus input deck (also CalculiX's) with its includes.
#pragma once

#include <filesystem>

#include "mesh/deck/deck.h"

namespace prismesh::mesh::deck::abaqus {

/// `main`: the bytes of the file at `path`.
Result<OpenedDeck> read(const std::filesystem::path& path, FileBytes main, const Progress& progress);

}  // namespace prismesh::mesh::deck::abaqus
