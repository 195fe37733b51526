#include "mesh/document/exchange_relations.h"

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "mesh/connections/sheet_reach.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/find_dependents.h"
#include "mesh/model/topology_change.h"
#include "mesh/spatial/closest_point.h"

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

ShellSet shells_of_part(const Model& model, PartIndex part) {
  ShellSet shells;
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    if (const ShellIndex shell(s); model.shell_parts[s] == part && !model.is_removed(shell)) shells.push_back(shell);
  return shells;
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
  std::vector<NodeOnSheet> found;
  std::map<PartIndex, spatial::ShellTree> sheets;
  for (const NodeOnSheet& each : again) {
    const PartIndex part = before.shell_parts[each.shell.value];
    if (!sheets.contains(part)) sheets.emplace(part, spatial::ShellTree(next.model, shells_of_part(next.model, part)));
    // The reach of the old shell counts too: on smaller shells at the same place nothing is farther away.
    const auto on = sheets.at(part).closest(next.model.position(each.node));
    const auto attachment = each.tied ? connections::Attachment::tied : connections::Attachment::placed;
    const double reach = on ? std::max(each.reach, connections::sheet_reach(next.model, on->shell, attachment)) : 0;
    if (!on || on->distance > reach) {
      lost.push_back(each);
      continue;
    }
    found.push_back(each);
    found.back().shell = on->shell;
    found.back().reach = reach;
  }
  relations->dependents.on_sheets = std::move(stay);
  add_on_sheets(std::move(found), relations->dependents);
  next.relations = std::move(relations);
  return lost;
}

}  // namespace prismesh::mesh::document
