// Feature lines as smooth curves: a cubic from node to node whose tangents are those of the circles through neighbouring nodes. Private to
// mesh/relax.
#pragma once

#include <optional>

#include "mesh/model/model.h"
#include "mesh/relax/line_cache.h"

namespace prismesh::mesh::relax {

/// A piece of a line, from one node to the next.
struct LinePiece {
  NodeIndex from;
  NodeIndex to;
};

struct CurvePoint {
  LinePiece piece;
  Vec3 point = Vec3::Zero();
  Vec3 tangent = Vec3::Zero();  ///< unit, from `from` to `to`
  double distance = 0;          ///< from the given point
};

/// The point of one piece that is nearest to `point`.
CurvePoint closest_on_piece(const LineCache& lines, LinePiece piece, const Vec3& point);

/// The nearest point on the line of `piece`, found by walking from the piece, and not beyond corners.
CurvePoint follow_line(const LineCache& lines, LinePiece piece, const Vec3& point);

}  // namespace prismesh::mesh::relax
