// Spreads needed displacements over the neighbourhood of the nodes that need them. Private to mesh/contact.
#pragma once

#include <functional>
#include <map>

#include "mesh/model/model.h"

namespace prismesh::mesh::contact {

/// A displacement: a length along a direction of length 1.
struct Lift {
  double length = 0;
  Vec3 direction = Vec3::UnitZ();
};
using Lifts = std::map<NodeIndex, Lift>;

/// Returns the lifts of `needed`, and of nodes about them that follow, so that lifts of neighbours differ by `slope` times their distance
/// over sides and diagonals of shells at most, and as smoothly as that permits. No lift is smaller than it is needed, none longer than the
/// longest. An infinite slope: those of
/// `needed` alone, as they are. Nodes that aren't `movable` stay, and nothing is spread over them. Costs the nodes that move. Precondition:
/// adjacency.
Lifts spread_lifts(const Model& model, const Lifts& needed, double slope, const std::function<bool(NodeIndex)>& movable);

}  // namespace prismesh::mesh::contact
