// Cuts the shells with a plane: the curves of a cross section.
#pragma once

#include <cstddef>
#include <vector>

#include "base/error.h"
#include "mesh/model/in_sight.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::measure {

/// Lengths are in the deck's unit.
struct Plane {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitX();  ///< of any length above 0
};

/// A part of one sheet that the plane goes through without a gap.
struct SectionCurve {
  PartIndex part;  ///< invalid: of shells without a part
  bool closed = false;
  std::vector<Vec3> points;  ///< at least two, no neighbours equal; closed: the last isn't the first
  double length = 0;
};

struct CrossSection {
  std::vector<SectionCurve> curves;  ///< in the order of their first shells
  std::size_t shells = 0;            ///< that the plane goes through
  double length = 0;                 ///< of all curves
};

/// Cuts the visible shells. A quad counts as the two triangles at its diagonal from the first corner to the third, as in mesh/spatial, so
/// that a warped one is cut in two straight pieces. A node that lies in the plane counts as above it, along the normal: a sheet that lies
/// in the plane isn't cut, and an edge in the plane is cut once. Triangles with a corner that isn't finite are left out. Curves end at free
/// edges, at part borders, and where more than two shells of a part share an edge. Returns the same whatever the number of cores.
/// Costs a look at each shell. Errors: the plane isn't finite, or its normal has no length.
Result<CrossSection> cross_section(const Model& model, const Plane& plane, OutOfSight out_of_sight = {});

}  // namespace prismesh::mesh::measure
