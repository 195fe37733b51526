#include "mesh/model/model.h"

#include <algorithm>
#include <cmath>

namespace prismesh::mesh {

std::string_view name(ElementClass element_class) {
  switch (element_class) {
    case ElementClass::shell: return "shell";
    case ElementClass::beam: return "beam";
    case ElementClass::solid: return "solid";
    case ElementClass::tshell: return "tshell";
    case ElementClass::discrete: return "discrete";
    case ElementClass::mass: return "mass";
    case ElementClass::sph: return "sph";
    case ElementClass::other: break;
  }
  return "other";
}

PartIndex Model::find_part(std::int64_t id) const {
  const auto at =
      std::lower_bound(parts->begin(), parts->end(), id, [](const Part& part, std::int64_t wanted) { return part.id < wanted; });
  if (at == parts->end() || at->id != id) return {};
  return PartIndex(static_cast<std::size_t>(at - parts->begin()));
}

std::vector<NodeIndex> moved_nodes(const Model& a, const Model& b) {
  std::vector<NodeIndex> moved;
  const std::size_t chunks = std::min(a.positions.chunk_count(), b.positions.chunk_count());
  for (std::size_t c = 0; c < chunks; ++c) {
    // equal addresses mean equal content, also where one array is longer than the other
    if (a.positions.chunk_owner(c) == b.positions.chunk_owner(c)) continue;
    const std::span<const Vec3> from = a.positions.chunk(c);
    const std::span<const Vec3> to = b.positions.chunk(c);
    for (std::size_t i = 0; i < std::min(from.size(), to.size()); ++i) {
      const NodeIndex node(c * kChunkSize + i);
      if (from[i] != to[i] && !a.is_removed(node) && !b.is_removed(node)) moved.push_back(node);
    }
  }
  return moved;
}

double largest_move(const Model& a, const Model& b, std::span<const NodeIndex> nodes) {
  double largest = 0;
  for (const NodeIndex node : nodes) largest = std::max(largest, (b.positions[node.value] - a.positions[node.value]).squaredNorm());
  return std::sqrt(largest);
}

std::string_view why_held(std::uint8_t hold) {
  if ((hold & kHeldByParameter) != 0) return "has coordinates given by a parameter";
  if ((hold & kHeldByInclude) != 0) return "stands in an include that is used more than once or can't be transformed back";
  if ((hold & kHeldByFrame) != 0) return "spans a coordinate system that other nodes stand in, or stands in one that can't be worked out";
  if ((hold & kHeldByRepeat) != 0) return "has two cards, and moving it would change only one of them";
  if ((hold & kHeldByMaking) != 0) return "has no card of its own: one card makes it and others";
  return "belongs to an element that also names a node that isn't defined";
}

}  // namespace prismesh::mesh
