// Groups pairs of shells into regions. Private to mesh/contact.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/model/model.h"

namespace prismesh::mesh::contact {

/// A pair of shells in the order of its parts: part_a <= part_b, whose order is that of indices; in one part either shell may come first.
struct SidedPair {
  ShellIndex a, b;
  PartIndex part_a, part_b;
};
SidedPair in_order_of_parts(const Model& model, ShellIndex a, ShellIndex b);

/// The region that a pair belongs to.
struct InRegion {
  std::uint32_t first = 0;  ///< the region's first pair
  bool swapped = false;     ///< in one part: the pair's shell a is on the side of the first pair's shell b
};

/// Two pairs of the same two parts belong together if the shells of each side are the same or share a node; in one part, the two folds are
/// the sides. Returns one entry for each pair. Costs the pairs. Preconditions: the model has its adjacency; less than 2^32 pairs.
std::vector<InRegion> find_regions(const Model& model, std::span<const SidedPair> pairs);

}  // namespace prismesh::mesh::contact
