// Finds the cards that join nodes or tie them to sheets. Private to mesh/document.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "mesh/document/dependents.h"
#include "mesh/model/references.h"

namespace prismesh::mesh::document {

struct NodeCards {
  std::vector<JoiningCard> joining;                       ///< nodes ascending
  std::vector<std::pair<NodeIndex, std::uint32_t>> tied;  ///< with the contact's referrer
};

/// Keywords are compared ignoring case. Costs the references.
NodeCards find_node_cards(const References& references, const Model& model);

}  // namespace prismesh::mesh::document
