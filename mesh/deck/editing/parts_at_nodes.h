// Tells on the shells of which part a placed node lies, by the nodes that its card follows.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/model/model.h"

namespace prismesh::mesh::deck {

class PartsAtNodes {
 public:
  /// `original`: the model as its deck has it; only read here.
  explicit PartsAtNodes(const Model& original);
  /// The part of all shells of the deck at the node, or at all the nodes of the deck that it comes from; invalid: there are several or
  /// none.
  PartIndex part_at(const Model& model, NodeIndex node) const;

 private:
  std::vector<std::uint32_t> part_of_node_;
};

}  // namespace prismesh::mesh::deck
