// Finds sheets that touch each other where no joint says how they are attached. Private to mesh/connections.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/connections/joined_sheets.h"
#include "mesh/model/in_sight.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::connections {

/// Sheets of which the planes differ by more don't lie flat on each other. The cosine of 60 degrees.
inline constexpr double kMinCosOfTouching = 0.5;

/// Numbers the sheets of the visible shells: one number for each shell, the same for shells that are connected over shared nodes.
std::vector<std::uint32_t> number_sheets(const Model& model, OutOfSight out_of_sight);

/// Pairs of shells of a sheet without a joint to another sheet, and of a sheet that it touches: a node of either shell lies on the other
/// shell (Attachment::touching), and their planes differ by at most 60 degrees. Decks whose welds aren't placed yet, or are stated by
/// contacts between parts, have such sheets. `joints`: the pairs that joints join. Costs the sheets without a joint.
std::vector<JoinedSheets::Pair> find_touching(const Model& model, std::span<const std::uint32_t> sheet_numbers,
                                              std::span<const JoinedSheets::Pair> joints, OutOfSight out_of_sight);

}  // namespace prismesh::mesh::connections
