// How faceted shells are: by how much their normals jump more than those of the surface that they stand for.
#pragma once

#include "mesh/repair/context.h"

namespace prismesh::mesh::repair {

/// The sum over the edges inside sheets of the shells that the patch's current change made or changed: the angle between the normals of the
/// two shells, less the angle between the surface's normals at their centres; in degrees, 0 where the surface bends more. Edges whose
/// centres are off the surface don't count.
double facets_now(const RepairContext& context);
/// The same of the shells as they were at Patch::begin.
double facets_before(const RepairContext& context);

}  // namespace prismesh::mesh::repair
