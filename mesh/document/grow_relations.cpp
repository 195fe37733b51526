#include "mesh/document/grow_relations.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "mesh/connections/nodes_on_sheets.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/find_dependents.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::document {

void grow_relations(const Model& before, Generation& next) {
  const Changes changes = changes_between(before, next.model);
  if (changes.other_elements() == 0 || !next.relations) return;
  std::vector<ElementUse> uses;
  for (std::size_t c = 0; c < changes.added_elements.size(); ++c)
    for (const std::uint32_t element : changes.added_elements[c]) {
      const ElementBlock& block = *next.model.elements[c];
      for (std::size_t n = block.first_node[element]; n < block.first_node[element + 1]; ++n)
        uses.push_back({block.nodes[n], static_cast<ElementClass>(c), element});
    }
  std::sort(uses.begin(), uses.end());
  uses.erase(std::unique(uses.begin(), uses.end()), uses.end());

  auto relations = std::make_shared<DeckRelations>(*next.relations);
  std::vector<NodeOnSheet> on_sheets = connections::find_sheets(next.model, connections::find_weld_nodes(next.model, uses));
  const auto old_uses = static_cast<std::ptrdiff_t>(relations->element_uses.size());
  relations->element_uses.insert(relations->element_uses.end(), uses.begin(), uses.end());
  std::inplace_merge(relations->element_uses.begin(), relations->element_uses.begin() + old_uses, relations->element_uses.end());
  add_on_sheets(std::move(on_sheets), relations->dependents);
  next.relations = std::move(relations);
}

void place_anew(const NodeSet& moved, Generation& next) {
  const auto is_moved = [&](const NodeOnSheet& each) { return std::binary_search(moved.begin(), moved.end(), each.node); };
  if (moved.empty()) return;
  std::vector<NodeOnSheet> nodes = connections::find_weld_nodes(next.model, next.relations->element_uses);
  std::erase_if(nodes, [&](const NodeOnSheet& each) { return !is_moved(each); });
  if (nodes.empty()) return;
  auto relations = std::make_shared<DeckRelations>(*next.relations);
  std::erase_if(relations->dependents.on_sheets, [&](const NodeOnSheet& each) { return !each.tied && is_moved(each); });
  add_on_sheets(connections::find_sheets(next.model, std::move(nodes)), relations->dependents);
  next.relations = std::move(relations);
}

}  // namespace prismesh::mesh::document
