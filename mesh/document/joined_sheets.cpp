#include "mesh/document/joined_sheets.h"

#include <vector>

#include "mesh/connections/find_joined_sheets.h"
#include "mesh/document/deck_relations.h"

namespace prismesh::mesh::document {

namespace {

std::vector<NodeSet> cards_that_join(const Dependents& dependents) {
  std::vector<NodeSet> cards;
  for (const JoiningCard& card : dependents.joining_cards)
    if (card.joins_sheets) cards.push_back(card.nodes);
  return cards;
}

}  // namespace

connections::JoinedSheets joined_sheets(const Generation& generation, OutOfSight out_of_sight) {
  const Dependents& dependents = generation.relations->dependents;
  return connections::find_joined_sheets(generation.model, cards_that_join(dependents), out_of_sight, dependents.on_sheets);
}

std::vector<connections::JoinedSheets::Pair> joints(const Generation& generation) {
  const Dependents& dependents = generation.relations->dependents;
  return connections::find_joints(generation.model, cards_that_join(dependents), {}, dependents.on_sheets);
}

}  // namespace prismesh::mesh::document
