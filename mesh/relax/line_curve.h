// Feature lines as smooth curves: a cubic from node to node whose tangents are those of the circles through neighbouring nodes. Private to
// mesh/relax.
#pragma once

#include <optional>

#include "mesh/model/model.h"

namespace prismesh::mesh::relax {

/// A piece of a line, from one node to the next.
struct LinePiece {
  NodeIndex from;
  NodeIndex to;
};

struct LinePlace {
  LinePiece piece;
  Vec3 point = Vec3::Zero();
  Vec3 tangent = Vec3::Zero();  ///< unit, from `from` to `to`
  double distance = 0;          ///< from the point asked for
};

/// The nearest place on one piece.
LinePlace place_on_piece(const Model& model, LinePiece piece, const Vec3& point, double cos_limit);

/// The nearest place on the line of `piece`, walking from it and not beyond corners.
LinePlace follow_line(const Model& model, LinePiece piece, const Vec3& point, double cos_limit);

}  // namespace prismesh::mesh::relax
