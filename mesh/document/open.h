// Opens a deck as a document.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "base/units.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/open.h"
#include "mesh/document/document.h"
#include "mesh/document/judging_rules.h"
#include "mesh/quality/criteria.h"

namespace prismesh::mesh::document {

struct OpenOptions {
  std::optional<LengthUnit> length_unit;
  std::optional<TargetSize> target_size;  ///< of all parts
  std::optional<std::filesystem::path> criteria;
  std::vector<JudgingRule> rules;            ///< applied after the settings file and the two above
  bool read_settings_file = true;            ///< the settings beside the deck, if there are any
  std::shared_ptr<const Judging> judged_by;  ///< replaces all of these and the guesses
  std::optional<DocumentSettings> settings;  ///< with `judged_by`: where it came from
  /// Not null: a state whose model is the deck's but for the places of nodes, judged by `judged_by`. What it knows isn't worked out again.
  const Generation* like = nullptr;
  std::vector<Error>* unread_criteria = nullptr;     ///< not null: criteria that can't be read are left out, and the reasons put here
  std::size_t history_bytes = std::size_t{2} << 30;  ///< Document::history_bytes
  Progress progress;
};

/// Opens a deck: model, guessed or given settings, quality of every shell. Errors: those of deck::open, apply_rules and the settings file.
Result<Document> open(const std::filesystem::path& path, const OpenOptions& options);
/// Makes a document of a deck that is open already.
Result<Document> open(const std::filesystem::path& path, deck::OpenedDeck opened, const OpenOptions& options);

}  // namespace prismesh::mesh::document
