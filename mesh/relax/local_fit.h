// The smooth sheet about one node: a polynomial height over the tangent plane, through the node, fitted to the nodes about it by least
// squares. Private to mesh/relax. Source: Cazals and Pouget, "Estimating differential quantities using polynomial fitting of osculating
// jets", 2005 [Cazals 2005].
#pragma once

#include <array>
#include <span>

#include "mesh/model/model.h"

namespace prismesh::mesh::relax {

struct LocalFit {
  Vec3 origin = Vec3::Zero();  ///< the node
  Vec3 u = Vec3::Zero();       ///< with v and normal a right-handed frame of unit vectors
  Vec3 v = Vec3::Zero();
  Vec3 normal = Vec3::Zero();
  double scale = 1;                ///< length that counts as 1 in the polynomial
  std::array<double, 9> height{};  ///< of u, v, u², uv, v², u³, u²v, uv², v³, times scale
  double edge = 0;                 ///< mean length of the edges of the shells at the node
  int terms = 0;                   ///< number of terms in use: 2, 5 or 9; 0: the plane normal to `normal`

  struct FitPoint {
    Vec3 point;
    Vec3 normal;  ///< not of unit length, on the side of LocalFit::normal
  };
  /// The point of the sheet above or below a point, along the normal.
  FitPoint point_over(const Vec3& point) const;
};

/// Fits the sheet about `node`. `normal`: approximate normal of the sheet, unit. `around`: other nodes of the same sheet, in an order that
/// is always the same; the first `ring` of them share a shell with the node.
LocalFit fit_about(const Vec3& node, const Vec3& normal, std::span<const Vec3> around, std::size_t ring);

}  // namespace prismesh::mesh::relax
