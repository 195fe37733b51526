// A document: a deck, its settings, and the generations that undo and redo walk. See docs/architecture.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/editing/text_changes.h"
#include "mesh/deck/open.h"
#include "mesh/document/generation.h"
#include "mesh/document/settings.h"

namespace prismesh::mesh::document {

/// States that an edit took the place of after they were undone. They can come back (TakeBranch).
struct Branch {
  std::uint64_t number = 0;                               ///< its name; counts from 1, never reused
  std::uint64_t fork = 0;                                 ///< number of the generation that the first state was made from
  std::vector<std::shared_ptr<const Generation>> states;  ///< oldest first, never empty
};

/// Reads another deck that an edit names.
using DeckReader = std::function<Result<deck::OpenedDeck>(const std::filesystem::path&, const Progress&)>;
inline Result<deck::OpenedDeck> read_deck(const std::filesystem::path& path, const Progress& progress) {
  return deck::open(path, progress);
}

struct Document {
  std::filesystem::path path;
  std::shared_ptr<const deck::Deck> deck;
  DocumentSettings settings;
  std::size_t history_bytes = std::size_t{2} << 30;            ///< max size of what the old generations and the branches don't share
  std::vector<std::shared_ptr<const Generation>> generations;  ///< oldest first; undo and redo move among them
  std::size_t cursor = 0;                                      ///< the current one
  std::shared_ptr<const Generation> opened;                    ///< as read from the deck; what saving compares with
  std::uint64_t next_number = 1;
  deck::TextMaker make_text = deck::text_changes;  ///< the new text of the deck's files when it is saved
  DeckReader read_variant = read_deck;             ///< reads the decks that edits name, perhaps in another process, as make_text
  std::vector<Branch> branches;  ///< in the order in which they were left; each fork is in `generations` or in another branch
  std::uint64_t next_branch = 1;

  const Generation& current() const { return *generations[cursor]; }
  bool can_undo() const { return cursor > 0; }
  bool can_redo() const { return cursor + 1 < generations.size(); }
};

/// What the shells of the current generation are judged by. The document must outlive the result and not change.
inline quality::SizedCriteria judged_by(const Document& document) { return sized(*document.current().judging); }

}  // namespace prismesh::mesh::document
