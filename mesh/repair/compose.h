// Makes one change of two.
#pragma once

#include <vector>

#include "mesh/repair/restructuring.h"

namespace prismesh::mesh::repair {

/// A change that does what two changes in turn do.
struct Composition {
  Restructuring change;
  /// By the number of a new node or shell, first those of the first change, then those of the second: the index that it gets by `change`;
  /// invalid: the second change removed it.
  std::vector<NodeIndex> new_node_index;
  std::vector<ShellIndex> new_shell_index;
};

/// `second` is a change of the model that `first` makes of `model`. As in a single change, the card of a removed shell goes to the first
/// new shell that comes from it. What comes from a removed new node comes from that node's parents.
Composition compose(const Model& model, const Restructuring& first, const Restructuring& second);

}  // namespace prismesh::mesh::repair
