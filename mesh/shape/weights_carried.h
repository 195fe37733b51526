// Transfers weights across welds, to pieces that no path along the surface connects to the grab. Private to mesh/shape.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/connections/joined_sheets.h"
#include "mesh/model/model.h"
#include "mesh/spatial/patch.h"

namespace prismesh::mesh::shape {

/// Fills `weight` at nodes where `reached` is 0 (no weight known yet), and sets `reached` to 1 there. Works round by round. A connected
/// piece of the patch gets weights as a whole if one of its nodes is within the length of a joint (connections::max_joint_length) of a
/// surface whose weights are known, and `joined` joins its sheet to that surface's, or it is the same sheet. Each of its nodes gets the
/// weight at the closest point of these surfaces, where unselected corners of a shell count as 0. A node without a shell takes it from any
/// sheet. The next round starts from these pieces; the closest point is looked for on the surfaces of all rounds. `reached` and `weight`
/// have one entry for each node of the patch. The same bits for any number of threads.
void carry_across_welds(const Model& model, const spatial::Patch& patch, const connections::JoinedSheets& joined,
                        std::vector<std::uint8_t>& reached, std::vector<double>& weight);

}  // namespace prismesh::mesh::shape
