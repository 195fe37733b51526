// Merges the results of a repair's pieces.
#pragma once

#include <span>

#include "mesh/repair/repaired.h"

namespace prismesh::mesh::repair {

/// The pieces' results as one, for the model that they were made of. New nodes and shells get their indices in the order of the pieces. No
/// two pieces change the same node or shell. What was there before the repair isn't counted.
Repaired merge(const Model& model, std::span<const Repaired> pieces);

}  // namespace prismesh::mesh::repair
