// Opening and saving a deck for a command. Inner to cli.
#pragma once

#include "cli/commands.h"
#include "mesh/deck/save.h"
#include "mesh/document/document.h"

namespace prismesh::cli {

/// Opens with the common options, with a progress bar, stopping when the user asks for it.
Result<mesh::document::Document> open_deck(const std::filesystem::path& deck, const Common& common, const Context& context);

/// Saves with a progress bar; told to stop, it writes nothing. Errors: those of document::save, with a file.
Result<mesh::deck::SaveReport> save_deck(const mesh::document::Document& document, const std::filesystem::path& target,
                                         const Context& context);

}  // namespace prismesh::cli
