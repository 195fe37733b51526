// The card of a node or shell of the deck: which text it stands in and where.
#pragma once

#include <cstddef>
#include <string_view>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/writing/cards.h"

namespace prismesh::mesh::deck {

struct DeckCard {
  const CardRun& run;
  std::string_view text;   ///< of its whole file
  std::size_t offset = 0;  ///< of its first line

  CardRef ref() const { return {text, offset, run.style}; }
};

inline DeckCard card_of(const Deck& deck, NodeIndex node) {
  const CardRun& run = deck.run_of(node);
  return {run, deck.files[run.file].bytes.text(), deck.node_line[node.value]};
}

inline DeckCard card_of(const Deck& deck, ShellIndex shell) {
  const CardRun& run = deck.run_of(shell);
  return {run, deck.files[run.file].bytes.text(), deck.shell_line[shell.value]};
}

}  // namespace prismesh::mesh::deck
