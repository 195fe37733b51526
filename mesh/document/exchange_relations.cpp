#include "mesh/document/exchange_relations.h"

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

#include "mesh/connections/nodes_on_sheets.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/find_dependents.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::document {

namespace {

/// New nodes between nodes of a card that joins many belong to it as well, as they join its set.
void exchange_joined(const Model& model, const Changes& changes, Dependents& dependents) {
  if (dependents.joining_cards.empty()) return;
  const std::set<NodeIndex> removed(changes.removed_nodes.begin(), changes.removed_nodes.end());
  dependents.joined_nodes.clear();
  for (std::size_t j = 0; j < dependents.joining_cards.size(); ++j) {
    NodeSet& nodes = dependents.joining_cards[j].nodes;
    const NodeSet before = nodes;
    const auto had = [&](NodeIndex node) { return std::binary_search(before.begin(), before.end(), node); };
    constexpr std::size_t kFewNodes = 2;  // of a weld or a hinge: these name their nodes alone
    if (before.size() > kFewNodes)
      for (const NodeIndex node : changes.added_nodes) {
        if (placed_node(model, node) != nullptr) continue;
        const NodeOrigin& origin = origin_of(model, node);
        if (std::all_of(origin.parent.begin(), origin.parent.begin() + origin.count(), had)) nodes.push_back(node);
      }
    std::erase_if(nodes, [&](NodeIndex node) { return removed.contains(node); });
    std::sort(nodes.begin(), nodes.end());
    for (const NodeIndex node : nodes) dependents.joined_nodes.push_back({node, static_cast<std::uint32_t>(j)});
  }
  std::sort(dependents.joined_nodes.begin(), dependents.joined_nodes.end());
}

}  // namespace

std::vector<NodeOnSheet> exchange_relations(const Model& before, Generation& next) {
  const Changes changes = changes_between(before, next.model);
  if (changes.empty() || !next.relations) return {};
  auto relations = std::make_shared<DeckRelations>(*next.relations);
  exchange_joined(next.model, changes, relations->dependents);

  const auto is_in = [](const ShellSet& shells, ShellIndex shell) { return std::binary_search(shells.begin(), shells.end(), shell); };
  std::vector<NodeOnSheet> stay, again, lost;
  for (const NodeOnSheet& each : relations->dependents.on_sheets) {
    if (next.model.is_removed(each.node)) continue;
    const bool exchanged = is_in(changes.removed_shells, each.shell) || is_in(changes.reshaped_shells, each.shell);
    (exchanged ? again : stay).push_back(each);
  }
  const std::vector<NodeOnSheet> found = connections::find_sheets(next.model, again);
  auto at = found.begin();
  for (const NodeOnSheet& each : again) {
    // A weld of which both ends lie on one sheet joins nothing.
    const bool lies = at != found.end() && at->node == each.node;
    if (!lies || next.model.shell_parts[at->shell.value] != before.shell_parts[each.shell.value]) lost.push_back(each);
    if (lies) ++at;
  }
  relations->dependents.on_sheets = std::move(stay);
  add_on_sheets(found, relations->dependents);
  next.relations = std::move(relations);
  return lost;
}

}  // namespace prismesh::mesh::document
