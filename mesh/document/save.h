// Saves a document's current generation.
#pragma once

#include <filesystem>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/deck/save.h"
#include "mesh/deck/staged_save.h"
#include "mesh/document/document.h"

namespace prismesh::mesh::document {

/// Saves the current generation (deck::save).
Result<deck::SaveReport> save(const Document& document, const std::filesystem::path& target, const Progress& progress = {});
/// Saves, but doesn't replace the files yet; the report is complete. The document's deck must outlive the result.
Result<deck::StagedSave> stage_save(const Document& document, const std::filesystem::path& target, const Progress& progress = {});

}  // namespace prismesh::mesh::document
