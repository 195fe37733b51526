// What differs between a model and the deck it was opened from, as changes of the files' text.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/editing/rounding.h"
#include "mesh/deck/writing/card_writer.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::deck {

struct TextChanges {
  std::vector<std::vector<Replacement>> by_file;  ///< as Deck::files; ascending, none overlaps another
  Rounding rounding;
  std::size_t nodes_moved = 0;
  std::size_t nodes_added = 0;
  std::size_t nodes_removed = 0;
  std::size_t shells_changed = 0;
  std::size_t shells_added = 0;
  std::size_t shells_removed = 0;
  std::size_t shells_turned = 0;  ///< whose material angles were changed because their first edge has turned
  std::size_t set_cards = 0;      ///< cards and sets changed besides those of nodes and shells
  std::size_t lines = 0;          ///< lines that come, go or change
};

/// Errors: what can't be saved safely, with the reason and, where there is one, file and line; cancelled. Costs what differs.
Result<TextChanges> text_changes(const Deck& deck, const Model& original, const Model& model, const Progress& progress = {});

/// Whether what came, went or has other corners can be saved, and the nodes of `moved` (ascending; others that have moved were asked about
/// when they did, and would cost a card each). Errors: as text_changes.
Result<void> can_restructure(const Deck& deck, const Model& original, const Model& model, std::vector<NodeIndex> moved);

/// Where something stands, for messages: "deck.k:12".
std::string place_of(const Deck& deck, std::uint32_t file, std::size_t offset);

}  // namespace prismesh::mesh::deck
