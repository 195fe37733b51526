// A guess at the unit of a deck's lengths.
#pragma once

#include "base/units.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::deck {

/// Guesses from densities and the median edge.
LengthUnit guess_length_unit(const Model& model);

}  // namespace prismesh::mesh::deck
