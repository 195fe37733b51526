// Finds what differs between a model and the deck it was opened from, as changes of the text of the deck's files.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/editing/rounding.h"
#include "mesh/deck/editing/text_edits.h"
#include "mesh/deck/writing/card_writer.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::deck {

struct TextChanges {
  std::vector<std::vector<Replacement>> by_file;  ///< as Deck::files; ascending, none overlaps another
  Rounding rounding;
  CardCounts counts;
  std::size_t set_cards = 0;  ///< cards and sets changed besides those of nodes and shells
  std::size_t lines = 0;      ///< lines that are added, removed or changed
};

/// `original`: the model as opened; `model`: as edited from it. Costs what differs. Errors: what can't be saved safely, with the reason
/// and, where there is one, file and line; cancelled.
Result<TextChanges> text_changes(const Deck& deck, const Model& original, const Model& model, const Progress& progress = {});

/// Makes what text_changes makes, perhaps in another process: a deck that nobody vouches for isn't parsed here.
using TextMaker = std::function<Result<TextChanges>(const Deck&, const Model& original, const Model& model, const Progress&)>;

/// Whether added, removed and reshaped nodes and shells can be saved, and the new coordinates of the nodes in `moved` (ascending). Other
/// moved nodes aren't checked: each would cost a card, and the edit that moved them has checked them. Errors: as text_changes.
Result<void> can_restructure(const Deck& deck, const Model& original, const Model& model, std::vector<NodeIndex> moved);

}  // namespace prismesh::mesh::deck
