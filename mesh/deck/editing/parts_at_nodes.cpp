#include "mesh/deck/editing/parts_at_nodes.h"

#include <limits>

#include "mesh/deck/editing/ancestors.h"

namespace prismesh::mesh::deck {

namespace {
constexpr std::uint32_t kNoPartThere = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kSeveralPartsThere = kNoPartThere - 1;
}  // namespace

PartsAtNodes::PartsAtNodes(const Model& original) : part_of_node_(original.node_count(), kNoPartThere) {
  for (std::size_t s = 0; s < original.shell_count(); ++s) {
    const PartIndex part = original.shell_parts[s];
    const std::uint32_t number = part.valid() ? static_cast<std::uint32_t>(part.value) : kSeveralPartsThere;
    for (const NodeIndex node : original.shell(ShellIndex(s)).node) {
      std::uint32_t& known = part_of_node_[node.value];
      known = known == kNoPartThere || known == number ? number : kSeveralPartsThere;
    }
  }
}

PartIndex PartsAtNodes::part_at(const Model& model, NodeIndex node) const {
  std::uint32_t all = kNoPartThere;
  for (const NodeIndex ancestor : deck_ancestors(model, node)) {
    const std::uint32_t part = ancestor.value < part_of_node_.size() ? part_of_node_[ancestor.value] : kNoPartThere;
    if (part == kNoPartThere || part == kSeveralPartsThere || (all != kNoPartThere && all != part)) return {};
    all = part;
  }
  return all == kNoPartThere ? PartIndex() : PartIndex(all);
}

}  // namespace prismesh::mesh::deck
