// What the Verdict library calls aspect, skew, warpage, taper and scaled Jacobian, under names of their own: other formulas than the
// metrics' (docs/quality/metrics.md), so that figures from programs that use Verdict can be compared. One shell at a time; nothing judges
// by them. Source: Stimpson et al., The Verdict geometric quality library, SAND2007-1751.
#pragma once

#include <span>

#include "mesh/model/model.h"

namespace prismesh::mesh::quality {

/// NaN where the metric doesn't apply to the shape or the shell has no area.
struct VerdictValues {
  double verdict_aspect;           ///< longest edge by perimeter over area, 1 for the square and the equilateral triangle
  double verdict_skew;             ///< quads: |cosine| of the angle between the mid-side lines
  double verdict_warpage;          ///< quads: cube of the least cosine between opposite corners' normals
  double verdict_taper;            ///< quads: difference of the diagonals' middles over the shorter mid-side line
  double verdict_scaled_jacobian;  ///< quads: least corner Jacobian over its two edges
};
/// Of 3 or 4 corners.
VerdictValues measure_verdict(std::span<const Vec3> corners);

}  // namespace prismesh::mesh::quality
