#include "mesh/model/model.h"

#include <algorithm>

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
  for (std::size_t c = 0; c < a.positions.chunk_count(); ++c) {
    if (a.positions.shares_chunk(b.positions, c)) continue;
    const std::span<const Vec3> from = a.positions.chunk(c);
    const std::span<const Vec3> to = b.positions.chunk(c);
    for (std::size_t i = 0; i < from.size(); ++i)
      if (from[i] != to[i]) moved.push_back(NodeIndex(c * kChunkSize + i));
  }
  return moved;
}

}  // namespace prismesh::mesh
