// Fields of distances: from where nodes were, from a surface, between two shapes.
#pragma once

#include "base/error.h"
#include "base/progress.h"
#include "base/units.h"
#include "mesh/document/field.h"
#include "mesh/model/model.h"
#include "mesh/spatial/distance.h"

namespace prismesh::mesh::document {

// All fields: the same bits whatever the number of threads. Nodes and shells that are removed, aren't finite or have no counterpart have
// no value. Errors: a sentence if nothing has a value.

/// How far each node lies from where the node of the same id is in `before`. The same for two generations and two decks. A node that was
/// added since, and whose origin is known, is measured from where it would have been made in `before`: between the nodes it comes from.
/// Costs the nodes; between generations, chunks that both share cost nothing. Suggested limits: 1 mm and 5 mm.
Result<Field> displacement_field(const Model& before, const Model& now, LengthUnit unit);

/// How far each node of a shell lies from the closest point of the other model's shells: exactly 0 for nodes that haven't moved. Suggested
/// limits: 0.05 mm and 1 mm. Errors: also cancelled.
Result<Field> surface_distance_field(const Model& surface, const Model& now, LengthUnit unit, const Progress& progress = {});

/// Of the nodes that one shape has: how far from the closest point of the other, both of one model. Suggested limits: all of it, the close
/// ones coloured.
Result<Field> gap_field(const Model& model, const spatial::Shape& from, const spatial::Shape& to, LengthUnit unit,
                        const Progress& progress = {});

}  // namespace prismesh::mesh::document
