// Transfers weights across welds, to pieces that no path along the surface connects to the grab. Private to mesh/shape.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/spatial/patch.h"

namespace prismesh::mesh::shape {

/// A piece gets weights if it comes this near, in mean side lengths of the shell closest to it. Welded sheets lie about a thickness apart,
/// which is less than an element's side wherever a sheet is modelled by shells.
inline constexpr double kWeldReach = 1.5;

/// Fills `weight` at nodes where `reached` is 0 (no weight known yet), and sets `reached` to 1 there. Works round by round: a connected
/// piece of the patch gets weights as a whole if one of its nodes is near enough to the surface whose weights are known; each of its nodes
/// gets the weight at the closest point of that surface, where unselected corners of a shell count as 0. The next round starts from these
/// pieces; the closest point is looked for on the surfaces of all rounds. `reached` and `weight` have one entry for each node of the
/// patch. The same bits for any number of threads.
void carry_across_welds(const Model& model, const spatial::Patch& patch, std::vector<std::uint8_t>& reached, std::vector<double>& weight);

}  // namespace prismesh::mesh::shape
