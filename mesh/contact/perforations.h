// Regions in which shells of two parts, or two folds of one part, cross.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "mesh/contact/triangle_crossing.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::contact {

struct Perforation {
  PartIndex part_a, part_b;                                  ///< part_a <= part_b; invalid for shells without a part
  ShellSet shells_a, shells_b;                               ///< that cross shells of the other side, ascending
  std::vector<std::pair<ShellIndex, ShellIndex>> crossings;  ///< of side a and of side b, ascending
  std::vector<CurveSegment> curve;                           ///< each piece of the crossing curve once, ascending by coordinates
  double length = 0;                                         ///< of the curve, deck's length unit
};

/// How far a perforation goes through.
struct PerforationDepth {
  bool a_enters = false;      ///< else side b does
  NodeSet entering;           ///< nodes of the piece that the curve cuts off, ascending; empty: half through
  std::optional<double> max;  ///< the greatest distance of such a node from the other side; nothing: half through
  double mean = 0;            ///< over those nodes
  std::vector<Vec3> nearest;  ///< of each entering node the other side's nearest point; the node itself where there is none
  NodeIndex deepest;          ///< where the max is; of equal ones the first
  NodeSet other_cut_off;      ///< nodes that the curve cuts off from the side that doesn't enter, ascending
};

}  // namespace prismesh::mesh::contact
