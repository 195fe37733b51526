// Regions in which shells of two parts, or two folds of one part, are too close without crossing.
#pragma once

#include <vector>

#include "mesh/contact/closeness.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::contact {

/// A node that is too close to the other side.
struct WayOut {
  NodeIndex node;
  Vec3 direction = Vec3::UnitZ();  ///< from the closest point of the other side; on it, its normal
  double depth = 0;                ///< how far the node must move along it
};

struct Penetration {
  PartIndex part_a, part_b;              ///< part_a <= part_b; invalid for shells without a part
  ShellSet shells_a, shells_b;           ///< that are too close to shells of the other side, ascending
  std::vector<CloseShells> pairs;        ///< a of side a, b of side b: not by index; ascending
  double max_depth = 0;                  ///< deck's length unit
  double mean_depth = 0;                 ///< over the area of the side with the smaller one, each shell with its max
  double area = 0;                       ///< of that side's shells
  CloseShells worst;                     ///< the deepest pair, of equal ones the first
  bool is_clearance = false;             ///< only the gap makes it: its faces don't touch
  std::vector<WayOut> nodes_a, nodes_b;  ///< the corners of each side that are too close to the other one, ascending; edges that cross
                                         ///< above each other have none
};

}  // namespace prismesh::mesh::contact
