// Computes fields of distances: to earlier positions, to a surface, between two shapes.
#pragma once

#include "base/error.h"
#include "base/progress.h"
#include "base/units.h"
#include "mesh/document/field.h"
#include "mesh/model/model.h"
#include "mesh/spatial/distance.h"

namespace prismesh::mesh::document {

// All fields have the same bits whatever the number of threads. Nodes and shells that are removed, aren't finite or have no counterpart
// have no value. Errors: nothing has a value.

/// The distance of each node from the node of the same id in `before`, another generation or another deck. A node that was added since, and
/// whose origin is known, is measured from where it would have been made in `before`: between the nodes it comes from. Costs the nodes;
/// between generations, shared chunks cost nothing. Suggested limits: 1 mm and 5 mm.
Result<Field> displacement_field(const Model& before, const Model& now, LengthUnit unit);

/// The distance of each node of a shell from the closest point of the other model's shells; exactly 0 for nodes that haven't moved.
/// Suggested limits: 0.05 mm and 1 mm. Errors: also cancelled.
Result<Field> surface_distance_field(const Model& surface, const Model& now, LengthUnit unit, const Progress& progress = {});

/// The distance of each node of one shape from the closest point of the other, both of one model. Suggested limits: the whole range, with
/// small distances coloured.
Result<Field> gap_field(const Model& model, const spatial::Shape& from, const spatial::Shape& to, LengthUnit unit,
                        const Progress& progress = {});

}  // namespace prismesh::mesh::document
