// Where a movable node lies on the reference surface, and how it may move there. Private to mesh/relax.
#pragma once

#include "mesh/model/model.h"
#include "mesh/relax/freedom.h"
#include "mesh/relax/reference_surface.h"

namespace prismesh::mesh::relax {

struct SurfaceAnchor {
  Freedom freedom = Freedom::fixed;
  ShellIndex shell;               ///< freedom surface: of the reference's model
  NodeIndex from, to;             ///< freedom line: the feature edge's ends in the reference's model
  Vec3 direction = Vec3::Zero();  ///< freedom surface: unit normal; freedom line: unit tangent
  double size = 0;                ///< mean edge length of the reference there
};

/// Finds the anchor of a node of a mesh on the surface. Free edges, junctions and borders between parts are those of the mesh; creases and
/// corners are those of the surface, even where the mesh's elements make none now. Fixed: a corner, in no shell, not finite, or not near
/// the surface. Thread-safe.
SurfaceAnchor find_anchor(const Model& model, const ReferenceSurface& surface, NodeIndex node, double feature_cos);

/// Moves an anchor along its line or sheet to the point nearest to `point`. Returns that point.
Vec3 move_anchor(const ReferenceSurface& surface, const Vec3& point, SurfaceAnchor& anchor);

}  // namespace prismesh::mesh::relax
