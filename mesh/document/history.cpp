#include "mesh/document/history.h"

#include <span>
#include <vector>

#include "mesh/document/branches.h"
#include "mesh/document/deck_relations.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::document {

namespace {

template <class T>
std::size_t own_bytes(const ChunkedArray<T>& before, const ChunkedArray<T>& next) {
  std::size_t chunks = 0;
  for (std::size_t c = 0; c < next.chunk_count(); ++c)
    // The pointers are compared instead of shares_chunk: a grown array shares all chunks but the last.
    if (c >= before.chunk_count() || next.chunk_owner(c) != before.chunk_owner(c)) ++chunks;
  return chunks * sizeof(typename ChunkedArray<T>::Chunk);
}

/// Bytes of the tables that every edit of the structure makes anew.
std::size_t own_bytes(const Model& before, const Model& next) {
  std::size_t bytes = 0;
  const auto add = [&](const auto& values) { bytes += values.size() * sizeof(values[0]); };
  if (next.adjacency && next.adjacency != before.adjacency) {
    const Adjacency& table = *next.adjacency;
    add(table.node_first), add(table.node_shells), add(table.edge_first);
    add(table.edge_high), add(table.edge_shell_first), add(table.edge_shells);
  }
  if (next.topology_change && next.topology_change != before.topology_change) {
    static const TopologyChange none;
    const TopologyChange& old = before.topology_change ? *before.topology_change : none;
    bytes +=
        own_bytes(old.node_origins, next.topology_change->node_origins) + own_bytes(old.shell_parents, next.topology_change->shell_parents);
    add(next.topology_change->placed_nodes);
    for (const auto& examples : next.topology_change->element_examples) add(examples);
    for (const AddedPart& part : next.topology_change->added_parts) bytes += part.cards.size();
    add(next.topology_change->removed_nodes), add(next.topology_change->removed_shells), add(next.topology_change->reshaped_shells);
  }
  for (std::size_t c = 0; c < next.elements.size(); ++c)
    if (next.elements[c] && next.elements[c] != before.elements[c]) {
      const ElementBlock& block = *next.elements[c];
      add(block.id), add(block.part), add(block.first_node), add(block.nodes);
    }
  return bytes;
}

std::size_t own_bytes(const DeckRelations& relations) {
  return relations.element_uses.size() * sizeof(ElementUse) +
         relations.dependents.on_sheets.size() * (sizeof(NodeOnSheet) + sizeof(std::uint32_t));
}

}  // namespace

std::size_t own_bytes(const Generation& before, const Generation& next) {
  const Model& a = before.model;
  const Model& b = next.model;
  // The generation itself and its chunk pointers, which an edit costs even if it changes nothing.
  const std::size_t pointers = b.positions.chunk_count() * 4 + b.shell_nodes.chunk_count() * 6;
  std::size_t bytes = sizeof(Generation) + pointers * sizeof(std::shared_ptr<void>);
  bytes += own_bytes(a.node_ids, b.node_ids) + own_bytes(a.positions, b.positions) + own_bytes(a.node_holds, b.node_holds);
  bytes += own_bytes(a.shell_ids, b.shell_ids) + own_bytes(a.shell_nodes, b.shell_nodes) + own_bytes(a.shell_parts, b.shell_parts);
  bytes += own_bytes(a.shell_thickness, b.shell_thickness);
  bytes += own_bytes(before.node_marks, next.node_marks) + own_bytes(before.shell_marks, next.shell_marks);
  bytes += own_bytes(before.quality, next.quality);
  bytes += own_bytes(a, b);
  if (before.relations != next.relations && next.relations) bytes += own_bytes(*next.relations);
  if (before.parts != next.parts) bytes += next.parts->size() * sizeof(PartState);
  return bytes;
}

HistoryExcess excess_with(const Document& document, const Generation& next) {
  // generations[i].own_bytes is the cost of keeping generations[i - 1].
  std::size_t total = next.own_bytes;
  for (std::size_t i = 1; i <= document.cursor; ++i) total += document.generations[i]->own_bytes;
  const bool leaves = leaves_branch(document);
  std::vector<std::size_t> branches;
  for (const Branch& branch : document.branches) branches.push_back(bytes_of(branch.states));
  if (leaves) branches.push_back(bytes_of(std::span(document.generations).subspan(document.cursor + 1)));
  for (const std::size_t bytes : branches) total += bytes;
  HistoryExcess drop;
  while (total > document.history_bytes && drop.branches < branches.size()) total -= branches[drop.branches++];
  while (total > document.history_bytes && drop.generations <= document.cursor) {
    total -= drop.generations < document.cursor ? document.generations[drop.generations + 1]->own_bytes : next.own_bytes;
    ++drop.generations;
  }
  return drop;
}

Document with_current(const Document& document, std::shared_ptr<const Generation> generation) {
  Document further = document;
  further.generations.resize(document.cursor + 1);
  further.branches.clear();
  further.generations.push_back(std::move(generation));
  further.cursor = further.generations.size() - 1;
  return further;
}

}  // namespace prismesh::mesh::document
