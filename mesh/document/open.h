// Opens a deck as a document.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "base/error.h"
#include "base/progress.h"
#include "base/units.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/open.h"
#include "mesh/document/document.h"
#include "mesh/quality/criteria.h"

namespace prismesh::mesh::document {

struct OpenOptions {
  std::optional<LengthUnit> length_unit;
  std::optional<double> target_size;
  std::optional<std::filesystem::path> criteria;
  std::optional<quality::Criteria> judged_by;        ///< replaces `criteria`; the deck's time-step control still applies
  std::size_t history_bytes = std::size_t{2} << 30;  ///< Document::history_bytes
  Progress progress;
};

/// Opens a deck: model, guessed or given settings, quality of every shell. Errors: those of deck::open and load_criteria, a
/// target size that isn't positive.
Result<Document> open(const std::filesystem::path& path, const OpenOptions& options);
/// Makes a document of a deck that is open already.
Result<Document> open(const std::filesystem::path& path, deck::OpenedDeck opened, const OpenOptions& options);

}  // namespace prismesh::mesh::document
