#include "mesh/document/edge_middles.h"

#include <algorithm>

#include "mesh/model/adjacency.h"

namespace prismesh::mesh::document {

std::vector<EdgeMiddle> middles_in(const Model& model, const NodeSet& nodes, const ShellSet& shells) {
  std::vector<EdgeMiddle> middles;
  if (!model.midside || model.midside->empty()) return middles;
  const auto acted_on = [&](NodeIndex node) { return std::binary_search(nodes.begin(), nodes.end(), node); };
  const auto& all = *model.midside;
  auto entry = all.begin();
  for (const ShellIndex shell : shells) {
    entry = std::lower_bound(entry, all.end(), shell, [](const MidsideNodes& m, ShellIndex s) { return m.shell < s; });
    if (entry == all.end()) break;
    if (entry->shell != shell) continue;
    const ShellNodes& corners = model.shell(shell);
    const int count = corners.corners();
    for (int i = 0; i < count; ++i) {
      const NodeIndex node = entry->node[i];
      const std::array<NodeIndex, 2> end = {corners.node[i], corners.node[(i + 1) % count]};
      if (!node.valid() || !model.adjacency->shells_of(node).empty()) continue;
      if (acted_on(node) || acted_on(end[0]) || acted_on(end[1])) middles.push_back({node, end});
    }
  }
  std::stable_sort(middles.begin(), middles.end(), [](const EdgeMiddle& a, const EdgeMiddle& b) { return a.node < b.node; });
  middles.erase(std::unique(middles.begin(), middles.end(), [](const EdgeMiddle& a, const EdgeMiddle& b) { return a.node == b.node; }),
                middles.end());
  return middles;
}

}  // namespace prismesh::mesh::document
