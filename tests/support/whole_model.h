// All nodes and shells of a model as sets, for tests that work on whole models. Removed shells are among them.
#pragma once

#include <cstddef>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::test {

inline mesh::NodeSet all_nodes(const mesh::Model& model) {
  mesh::NodeSet nodes(model.node_count());
  for (std::size_t n = 0; n < nodes.size(); ++n) nodes[n] = mesh::NodeIndex(n);
  return nodes;
}

inline mesh::ShellSet all_shells(const mesh::Model& model) {
  mesh::ShellSet shells(model.shell_count());
  for (std::size_t s = 0; s < shells.size(); ++s) shells[s] = mesh::ShellIndex(s);
  return shells;
}

}  // namespace prismesh::test
