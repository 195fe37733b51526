// What saving compares: the model as it was opened, and the edited one.
#pragma once

#include <vector>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/writing/card_writer.h"
#include "mesh/model/model.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::deck {

struct ModelDifference {
  const Deck& deck;
  const Model& original;  ///< as it was opened from the deck
  const Model& model;     ///< as edited
  const CardWriter& writer;
  Changes changes;               ///< nodes and shells that were added, removed or got other corners
  std::vector<NodeIndex> moved;  ///< the deck's nodes whose coordinates are written; ascending
};

}  // namespace prismesh::mesh::deck
