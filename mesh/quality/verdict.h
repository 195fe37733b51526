// Aspect, skew, warpage, taper and scaled Jacobian by the formulas of the Verdict library, which differ from our metrics
// (docs/quality/metrics.md): for comparison with programs that use Verdict. Nothing is judged by them. Source: Stimpson et al., The Verdict
// geometric quality library, SAND2007-1751 [Stimpson 2007].
#pragma once

#include <span>

#include "mesh/model/model.h"

namespace prismesh::mesh::quality {

/// NaN where the metric doesn't apply to the shape or the shell has no area.
struct VerdictValues {
  double verdict_aspect;           ///< longest edge by perimeter over area, 1 for the square and the equilateral triangle
  double verdict_skew;             ///< quads: |cosine| of the angle between the mid-side lines
  double verdict_warpage;          ///< quads: cube of the min cosine between opposite corners' normals
  double verdict_taper;            ///< quads: difference of the diagonals' middles over the shorter mid-side line
  double verdict_scaled_jacobian;  ///< quads: min corner Jacobian over its two edges
};
/// Measures a shell of 3 or 4 corners.
VerdictValues measure_verdict(std::span<const Vec3> corners);

}  // namespace prismesh::mesh::quality
