// Finds creases whose angle varies along their line.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/model/adjacency.h"
#include "mesh/model/in_sight.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::select {

/// Decides for one edge at a time and remembers the answer. An edge of two visible shells is a crease if they bend by more than the angle;
/// also if they bend by more than half of it and the line of such edges through it reaches, within 8 edges to both sides, one that bends by
/// more. At a node a line continues on the edge that is straightest, within 45 degrees.
class CreaseLines {
 public:
  /// Keeps references; `model` needs its adjacency.
  CreaseLines(const Model& model, double angle_degrees, OutOfSight out_of_sight);

  /// `one` and `other` are the two shells at the edge.
  bool is_crease(EdgeIndex edge, Edge ends, ShellIndex one, ShellIndex other);

 private:
  bool reaches_sharp_edge(Edge edge, NodeIndex node) const;
  /// The next edge of the line behind `node`, as its far end; invalid where the line ends.
  NodeIndex straight_on(NodeIndex before, NodeIndex node) const;
  bool is_sharp(Edge edge, double cos_limit) const;

  const Model& model_;
  OutOfSight out_of_sight_;
  double cos_sharp_, cos_weak_;
  std::vector<std::uint8_t> known_;  ///< for each edge 0: not yet asked, 1: no crease, 2: crease
};

}  // namespace prismesh::mesh::select
