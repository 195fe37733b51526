// What a deck says besides its shells, as edits need it: which names expressions may use, and what hangs on the nodes that move. Found
// when the deck is opened, shared by all generations.
#pragma once

#include <memory>
#include <vector>

#include "mesh/deck/deck.h"
#include "mesh/document/dependents.h"
#include "mesh/document/document.h"
#include "mesh/select/names.h"

namespace prismesh::mesh::document {

/// Elements other than shells at each node: what moves along when the node is moved. Ascending by node.
struct Attached {
  struct Use {
    NodeIndex node;
    ElementClass element_class = ElementClass::other;
    std::uint32_t element = 0;  ///< index in Model::elements[element_class]
    auto operator<=>(const Use&) const = default;
  };
  std::vector<Use> uses;
};

struct Surroundings {
  std::shared_ptr<const deck::Deck> deck;  ///< keeps what `names` points into
  select::Names names;
  Attached attached;
  Dependents dependents;
};

std::shared_ptr<const Surroundings> find_surroundings(std::shared_ptr<const deck::Deck> deck, const Model& model);

}  // namespace prismesh::mesh::document
