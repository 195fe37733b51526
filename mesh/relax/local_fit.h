// The smooth sheet about one node: a polynomial height over its tangent plane that goes through the node and comes as near as it can to
// the nodes around it. Private to mesh/relax. Source: Cazals and Pouget, "Estimating differential quantities using polynomial fitting of
// osculating jets", 2005.
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
  int terms = 0;                   ///< of them in use: 2, 5 or 9; 0: a plane square to the normal

  struct Place {
    Vec3 point;
    Vec3 normal;  ///< not of unit length, on the side of LocalFit::normal
  };
  /// Straight above or below a point.
  Place over(const Vec3& point) const;
};

/// `normal`: about square to the sheet, unit. `around`: other nodes of the sheet, those of the same sheet side only; in any order that is
/// always the same. `ring` first ones share a shell with the node.
LocalFit fit_about(const Vec3& node, const Vec3& normal, std::span<const Vec3> around, std::size_t ring);

}  // namespace prismesh::mesh::relax
