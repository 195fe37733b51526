// Repairs clusters of triangles: joins and divides shells anew until no node has more triangles than allowed.
#pragma once

#include <functional>
#include <vector>

#include "mesh/repair/cluster_state.h"
#include "mesh/repair/context.h"
#include "mesh/repair/repair_input.h"
#include "mesh/repair/repair_state.h"

namespace prismesh::mesh::repair {

ClusterState cluster_state_of(const RepairInput& input);

/// By how much the patch's current change lowers the number of triangles above the max, over all nodes that it touches.
double thinned_by(const Patch& patch, const ClusterState& clusters);

/// One pass over the clusters of the scope and those that the repair made. Keeps a change if it takes triangles away from crowded nodes and
/// no shell that passed fails; changes without new warnings come first. Then joins what triangles are left there, where nothing gets worse.
/// `goes_on`: false cancels. Returns whether a change was kept.
bool thin_clusters(const RepairContext& context, RepairState& state, const std::function<bool()>& goes_on);

/// The clusters of the scope and those that the repair made, as they are now; ascending by node, new nodes last.
std::vector<ClusterLeft> clusters_left(const RepairContext& context, const RepairState& state);

}  // namespace prismesh::mesh::repair
