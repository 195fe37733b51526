// Regions in which shells of two parts, or two folds of one part, cross.
#pragma once

#include <vector>

#include "mesh/contact/triangle_crossing.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::contact {

struct Perforation {
  PartIndex part_a, part_b;                    ///< part_a <= part_b; invalid for shells without a part
  std::vector<ShellIndex> shells_a, shells_b;  ///< that cross shells of the other side, ascending
  std::vector<CurveSegment>
      curve;          ///< of the crossing curve, each once, by coordinates; an end is shared with the next to the last bit or so
  double length = 0;  ///< of the curve, deck's length unit
};

}  // namespace prismesh::mesh::contact
