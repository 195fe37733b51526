// Saves decks of every format: only the cards of what differs are rewritten.
#pragma once

#include <filesystem>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/save_report.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::deck {

/// Whether `model` can be saved as what `original` has become: an edit asks this before it is applied. Costs what differs. Errors: what
/// can't be written safely, with the reason (docs/formats/editing.md has the rules). `original` is the model as it was opened.
Result<void> can_save(const Deck& deck, const Model& original, const Model& model);

/// Writes the deck as `model` has it to `target`. Only cards of nodes and shells that differ are rewritten, in their own columns and
/// style; new ones stand right behind those they come from; cards that name what came or went follow by the rules of
/// docs/formats/editing.md. To the deck's own path: changed files only, and refused if a file on disk is no longer the one that was read.
/// Elsewhere: all files, includes under their relative paths (one outside the main file's folder is refused by name). Atomic (see
/// replace_files); stopped by its progress, it leaves everything as it was. Errors: those of can_save, before anything is written, those
/// of writing, cancelled. `original` is the model as it was opened.
Result<SaveReport> save(const Deck& deck, const Model& original, const Model& model, const std::filesystem::path& target,
                        const Progress& progress = {});

}  // namespace prismesh::mesh::deck
