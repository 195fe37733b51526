// Guesses the unit of a deck's lengths.
#pragma once

#include "base/units.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::deck {

/// Guesses from the parts' densities and the median edge length.
LengthUnit guess_length_unit(const Model& model);

}  // namespace prismesh::mesh::deck
