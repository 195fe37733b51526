// Saves decks of every format: rewrites only the cards of what differs.
#pragma once

#include <filesystem>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/save_report.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::deck {

/// Checks whether `model` can be saved. Edits check this before they are applied. `original`: the model as it was opened; `model`: as
/// edited from it. Costs what differs. Errors: what can't be written safely, with the reason (docs/formats/editing.md has the rules).
Result<void> can_save(const Deck& deck, const Model& original, const Model& model);

/// Writes the deck to `target`, with what differs between `original` (as opened) and `model` (as edited from it). Cards of nodes and shells
/// that differ are rewritten in their own columns and style. New cards stand right behind those that they come from. Cards that name added
/// or removed ones follow the rules of docs/formats/editing.md. To the deck's own path, only changed files are written. To another path,
/// all files are written, includes under their relative paths. Before the first file is replaced, an error or a stop leaves all as it was;
/// later ones as StagedSave::put_in_place_or_leave, and after a kill the next opening of the deck finishes the save. Errors: those of
/// can_save; a file on disk is no longer the one that was read (own path); an include is outside the main file's folder (other path); a
/// file can't be written; cancelled.
Result<SaveReport> save(const Deck& deck, const Model& original, const Model& model, const std::filesystem::path& target,
                        const Progress& progress = {});

}  // namespace prismesh::mesh::deck
