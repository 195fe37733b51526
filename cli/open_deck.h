// Opens and saves decks for commands. Inner to cli.
#pragma once

#include "cli/commands.h"
#include "mesh/deck/save.h"
#include "mesh/document/document.h"
#include "mesh/document/open.h"

namespace prismesh::cli {

/// The common options that a document is opened with.
mesh::document::OpenOptions open_options(const Common& common);

/// Opens a deck with the common options and a progress bar. Errors: those of document::open, with a file; cancelled.
Result<mesh::document::Document> open_deck(const std::filesystem::path& deck, const Common& common, const Context& context);

/// Opens a deck that nobody vouches for: prismesh-import reads it, locked in. The settings beside the deck, which may come from the same
/// source, aren't read. Says what the sandbox can't forbid here. Errors: those of ipc::import_deck and document::open, with a file.
Result<mesh::document::Document> open_sandboxed(const std::filesystem::path& deck, const Common& common, const Context& context);

/// Errors: `output` is a file of the deck, which a picture or a page must not replace.
Result<void> check_replaces_no_deck(const std::filesystem::path& output, const mesh::document::Document& document);

/// Saves with a progress bar; when cancelled it writes nothing. Errors: those of document::save, with a file.
Result<mesh::deck::SaveReport> save_deck(const mesh::document::Document& document, const std::filesystem::path& target,
                                         const Context& context);

/// Keeps the document's target sizes and criteria in the settings file beside its deck, and says so. False: it can't be written; the reason
/// was printed.
bool save_settings(const mesh::document::Document& document, const Context& context);

}  // namespace prismesh::cli
