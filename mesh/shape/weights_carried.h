// Weights of pieces that no way along the surface leads to: taken from the sheets they are welded to. Private to mesh/shape.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/spatial/patch.h"

namespace prismesh::mesh::shape {

/// How near a piece comes to be carried, in mean side lengths of the shell it comes nearest to. Welded sheets lie about a thickness
/// apart, which is less than an element's side wherever a sheet is modelled by shells.
inline constexpr double kWeldReach = 1.5;

/// Gives `weight` to what `reached` (1 where a weight is known) leaves out, and marks it there. A connected piece of the patch is carried
/// as a whole if one of its nodes is near enough to what was reached before it; each of its nodes gets the weight at the closest point of
/// that, the unselected corners of a shell counting as 0. Carried pieces carry further ones, the nearest surface always counting.
/// Both have one entry for each node of the patch. The same bits for any number of threads.
void carry_across_welds(const Model& model, const spatial::Patch& patch, std::vector<std::uint8_t>& reached, std::vector<double>& weight);

}  // namespace prismesh::mesh::shape
