#include "mesh/deck/abaqus/instance_shifts.h"

namespace prismesh::mesh::deck::abaqus {

std::vector<std::int64_t> shifts_of(const DeckOutline& outline, const Block& block, const Parameters& given) {
  if (const auto instance = given.value("INSTANCE"); instance && block.scope == 0) {
    const auto at = outline.instance_by_name.find(label(*instance));
    if (at == outline.instance_by_name.end()) return {};
    return {outline.instances[at->second].shift};
  }
  if (block.instance != kNone) return {outline.instances[block.instance].shift};
  if (block.scope == 0 || outline.instances.empty()) return {0};
  std::vector<std::int64_t> out;
  for (const std::uint32_t instance : outline.scopes[block.scope].instances) out.push_back(outline.instances[instance].shift);
  return out;
}

}  // namespace prismesh::mesh::deck::abaqus
