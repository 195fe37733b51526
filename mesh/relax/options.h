// Options of relaxing: distances and rounds.
#pragma once

#include <optional>
#include <vector>

#include "mesh/model/model.h"

namespace prismesh::mesh::relax {

struct Options {
  double feature_angle = 30;                  ///< degrees
  std::optional<double> max_move_on_surface;  ///< max move of a node inside a sheet; deck's length unit; empty: no limit
  std::optional<double> max_move_on_line;     ///< max move of a node on a feature line
  /// For each node of the model, the position that its max move counts from, at most so far from the node; one that isn't finite: no limit.
  /// Null: the node's own position.
  const std::vector<Vec3>* move_origins = nullptr;
  int max_rounds = 200;
  /// Check elements in between, not only when all nodes are at rest, and check each further step of nodes at bad ones. Converges sooner in
  /// rough meshes. Without, elements may be too long for a while, so that a stretch over many elements is shared between them.
  bool checks_before_rest = true;
};

}  // namespace prismesh::mesh::relax
