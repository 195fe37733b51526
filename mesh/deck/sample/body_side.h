// The sample's shape: a front rail with its closing plate that runs into a sill, a pillar on it (outer, inner, reinforcement),
// a floor panel with beads and a crossmember. The left side of a car: x to the rear, y to the right, z up, in mm.
#pragma once

#include <vector>

#include "mesh/deck/sample/loft.h"

namespace prismesh::mesh::deck::sample {

/// A spot weld: one end in the middle surface of each sheet.
struct SpotWeld {
  Vec3 from;
  Vec3 to;
};

struct Assembly {
  std::vector<Part> parts;
  std::vector<SpotWeld> welds;
};

/// `size`: the edge length of the meshes; beads are at least as wide as it can resolve.
Assembly body_side(double size);

}  // namespace prismesh::mesh::deck::sample
