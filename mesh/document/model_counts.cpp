#include "mesh/document/model_counts.h"

#include "mesh/deck/data/deck.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::document {

ModelCounts count_model(const Document& document) {
  const Generation& current = document.current();
  const deck::ElementCounts cards = document.deck->element_cards.without(document.deck->left_out_cards);
  return {live_nodes(current.model), live_shells(current.model) + cards.all() - cards.shells(), current.model.parts->size(),
          current.counts.warn, current.counts.fail};
}

}  // namespace prismesh::mesh::document
