// Finds the relations of a deck. Private to mesh/document.
#pragma once

#include <memory>

#include "mesh/deck/data/deck.h"
#include "mesh/document/deck_relations.h"

namespace prismesh::mesh::document {

/// `deck` has just been opened as `model`. Costs the model if anything may lie on shells.
std::shared_ptr<const DeckRelations> find_deck_relations(std::shared_ptr<const deck::Deck> deck, const Model& model);
/// Those of the same deck after some of its nodes' coordinates were saved: what depends on nodes stays what it was.
std::shared_ptr<const DeckRelations> carry_deck_relations(std::shared_ptr<const deck::Deck> saved, const DeckRelations& relations);

}  // namespace prismesh::mesh::document
