#include "mesh/document/pins.h"

#include <algorithm>

#include "mesh/document/deck_relations.h"
#include "mesh/document/edge_middles.h"
#include "mesh/document/kept_welds.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::document {

Pins::Pins(const Generation& generation, const KeptWelds* welds) : generation_(generation), welds_(welds) {
  const Model& model = generation.model;
  if (model.midside)
    for (const MidsideNodes& midside : *model.midside)
      if (!model.is_removed(midside.shell)) pin_beside_middles(midside);
  std::sort(beside_middles_.begin(), beside_middles_.end());
}

Stays Pins::of(NodeIndex node) const {
  const Stays why = by_itself(node);
  return why == Stays::goes && std::binary_search(beside_middles_.begin(), beside_middles_.end(), node) ? Stays::mid_side : why;
}

Stays Pins::by_itself(NodeIndex node) const {
  if ((generation_.node_marks[node.value] & kLocked) != 0) return Stays::locked;
  if (generation_.model.node_holds[node.value] != 0) return Stays::held;
  for (const ElementUse& use : uses_at(*generation_.relations, node))
    if (welds_ == nullptr || !welds_->may_follow(use)) return Stays::other_element;
  const auto joined = cards_at(*generation_.relations, node);
  const bool all_follow =
      welds_ != nullptr && std::all_of(joined.begin(), joined.end(), [&](const JoinedNode& each) { return welds_->may_follow(each.card); });
  return joined.empty() || all_follow ? Stays::goes : Stays::joined;
}

/// A mid-side node follows the ends of its edge. If it can't, or is a corner of another shell, the ends stay, and so does it.
void Pins::pin_beside_middles(const MidsideNodes& midside) {
  const Model& model = generation_.model;
  const ShellNodes& corners = model.shell(midside.shell);
  const int count = corners.corners();
  for (int i = 0; i < count; ++i) {
    const NodeIndex node = midside.node[i];
    if (!node.valid() || (model.adjacency->shells_of(node).empty() && by_itself(node) == Stays::goes)) continue;
    beside_middles_.insert(beside_middles_.end(), {node, corners.node[i], corners.node[(i + 1) % count]});
  }
}

NodeSet let_middles_follow(const Model& before, const NodeSet& moved, Generation& next) {
  NodeSet followed;
  for (const EdgeMiddle& middle : middles_in(before, moved, shells_touching(before, moved))) {
    Vec3 by = Vec3::Zero();
    for (const NodeIndex end : middle.end) by += 0.5 * (next.model.position(end) - before.position(end));
    next.model.positions.set(middle.node.value, before.position(middle.node) + by);
    followed.push_back(middle.node);
  }
  return followed;
}

}  // namespace prismesh::mesh::document
