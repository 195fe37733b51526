#include "mesh/select/crease_lines.h"

#include <cmath>

#include "base/deterministic_math.h"
#include "mesh/model/features.h"

namespace prismesh::mesh::select {

namespace {

constexpr int kMaxGap = 8;                    ///< edges to each side
constexpr double kCosStraight = 0.707106781;  ///< 45 degrees

}  // namespace

CreaseLines::CreaseLines(const Model& model, double angle_degrees, OutOfSight out_of_sight)
    : model_(model),
      out_of_sight_(out_of_sight),
      cos_sharp_(deterministic_cos_degrees(angle_degrees)),
      cos_weak_(deterministic_cos_degrees(angle_degrees / 2)),
      known_(model.adjacency->edge_count(), 0) {}

bool CreaseLines::is_crease(EdgeIndex edge, Edge ends, ShellIndex one, ShellIndex other) {
  std::uint8_t& known = known_[edge.value];
  if (known == 0) {
    const bool crease =
        mesh::is_crease(model_, one, other, ends, cos_sharp_) ||
        (mesh::is_crease(model_, one, other, ends, cos_weak_) && reaches_sharp_edge(ends, ends.low) && reaches_sharp_edge(ends, ends.high));
    known = crease ? 2 : 1;
  }
  return known == 2;
}

bool CreaseLines::reaches_sharp_edge(Edge edge, NodeIndex node) const {
  NodeIndex before = edge.low == node ? edge.high : edge.low;
  for (int i = 0; i < kMaxGap; ++i) {
    const NodeIndex next = straight_on(before, node);
    if (!next.valid()) return false;
    const Edge ahead = node < next ? Edge{node, next} : Edge{next, node};
    if (is_sharp(ahead, cos_sharp_)) return true;
    if (!is_sharp(ahead, cos_weak_)) return false;
    before = node;
    node = next;
  }
  return false;
}

NodeIndex CreaseLines::straight_on(NodeIndex before, NodeIndex node) const {
  const Vec3 along = model_.position(node) - model_.position(before);
  NodeIndex best;
  double best_cos = kCosStraight;
  for (const ShellIndex shell : model_.adjacency->shells_of(node)) {
    if (!in_sight(model_, shell, out_of_sight_)) continue;
    const ShellNodes& nodes = model_.shell(shell);
    const auto corners = static_cast<std::size_t>(nodes.corners());
    for (std::size_t i = 0; i < corners; ++i) {
      if (nodes.node[i] != node) continue;
      for (const NodeIndex next : {nodes.node[(i + 1) % corners], nodes.node[(i + corners - 1) % corners]}) {
        const Vec3 ahead = model_.position(next) - model_.position(node);
        const double cosine = along.dot(ahead) / std::sqrt(along.squaredNorm() * ahead.squaredNorm());
        if (cosine > best_cos || (cosine == best_cos && best.valid() && next < best)) best = next, best_cos = cosine;
      }
    }
  }
  return best;
}

bool CreaseLines::is_sharp(Edge edge, double cos_limit) const {
  const EdgeIndex index = model_.adjacency->find_edge(edge.low, edge.high);
  if (!index.valid()) return false;
  ShellIndex found[2];
  int count = 0;
  for (const ShellIndex shell : model_.adjacency->shells_of(index))
    if (in_sight(model_, shell, out_of_sight_) && count++ < 2) found[count - 1] = shell;
  return count == 2 && mesh::is_crease(model_, found[0], found[1], edge, cos_limit);
}

}  // namespace prismesh::mesh::select
