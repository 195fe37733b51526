// Where a movable node is on the reference surface, and what it may do there. Private to mesh/relax.
#pragma once

#include "mesh/model/model.h"
#include "mesh/relax/freedom.h"
#include "mesh/relax/reference_surface.h"

namespace prismesh::mesh::relax {

struct SurfaceAnchor {
  Freedom freedom = Freedom::fixed;
  ShellIndex shell;               ///< surface: of the reference
  NodeIndex from, to;             ///< line: of the reference
  Vec3 direction = Vec3::Zero();  ///< surface: unit normal; line: unit tangent
  double size = 0;                ///< of the reference's elements there
};

/// Of a node of a mesh that lies on the surface. Free edges, junctions and borders between parts are the mesh's; creases and corners are
/// the surface's, wherever the mesh's elements lean now. Fixed: a corner, in no shell, not finite, or not near the surface. By any thread.
SurfaceAnchor find_anchor(const Model& model, const ReferenceSurface& surface, NodeIndex node, double feature_cos);

/// The place on the node's line or sheet that is nearest to a point; `anchor` follows.
Vec3 put_back(const ReferenceSurface& surface, const Vec3& point, SurfaceAnchor& anchor);

}  // namespace prismesh::mesh::relax
