// Searches the sheets on which nodes may lie. Private to mesh/connections.
#pragma once

#include <optional>

#include "mesh/model/in_sight.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::connections {

/// The visible shells in whose reach, placed or tied, any of some nodes may be.
class SheetsNear {
 public:
  /// Costs a pass over the shells of the model if there are nodes.
  SheetsNear(const Model& model, const NodeSet& nodes, OutOfSight out_of_sight);

  bool empty() const { return tree_.empty(); }
  const spatial::ShellTree& tree() const { return tree_; }
  /// Twice the mean reach of these shells for tied nodes: how far the sheets at a tied node are searched.
  double search_radius() const { return search_radius_; }

 private:
  SheetsNear(const Model& model, const ShellSet& shells);

  spatial::ShellTree tree_;
  double search_radius_ = 0;
};

}  // namespace prismesh::mesh::connections
