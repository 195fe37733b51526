// Whether shells share a node. Private to mesh/contact.
#pragma once

#include <algorithm>

#include "mesh/model/model.h"

namespace prismesh::mesh::contact {

inline bool share_a_node(const ShellNodes& a, const ShellNodes& b) {
  for (const NodeIndex of_a : a.node)
    if (std::find(b.node.begin(), b.node.end(), of_a) != b.node.end()) return true;
  return false;
}

}  // namespace prismesh::mesh::contact
