#include "mesh/deck/editing/check_difference.h"

#include <algorithm>
#include <optional>
#include <string>

#include "mesh/deck/editing/deck_card.h"
#include "mesh/deck/editing/names.h"
#include "mesh/deck/editing/text_place.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::deck {
namespace {

template <class Array>
std::optional<std::size_t> first_difference(const Array& a, const Array& b) {
  for (std::size_t c = 0; c < std::min(a.chunk_count(), b.chunk_count()); ++c) {
    if (a.chunk_owner(c) == b.chunk_owner(c)) continue;
    const auto before = a.chunk(c), after = b.chunk(c);
    for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i)
      if (before[i] != after[i]) return c * kChunkSize + i;
  }
  return std::nullopt;
}

Result<void> check_same(const ModelDifference& difference, std::optional<std::size_t> differing_shell, const std::string& property) {
  if (!differing_shell) return {};
  const ShellIndex shell(*differing_shell);
  const DeckCard card = card_of(difference.deck, shell);
  return fail(
      refusal_at(difference.deck, card.run.file, card.offset,
                 shell_name(difference.model, shell) + " has another " + property + " than its card, which this version can't write"));
}

bool is_gone(const Model& model, NodeIndex node) { return node.valid() && model.is_removed(node); }

Error still_used(const ModelDifference& difference, NodeIndex node, const std::string& user) {
  const DeckCard card = card_of(difference.deck, node);
  return refusal_at(difference.deck, card.run.file, card.offset,
                    node_name(difference.model, node) + " can't be removed: " + user + " has it");
}

/// Errors: the shell is there and has a removed node.
Result<void> check_nodes_of(const ModelDifference& difference, ShellIndex shell) {
  const Model& model = difference.model;
  if (model.is_removed(shell)) return {};
  for (const NodeIndex node : model.shell(shell).node) {
    if (!is_gone(model, node)) continue;
    if (node.value < difference.original.node_count()) return fail(still_used(difference, node, shell_name(model, shell)));
    return fail(refusal(difference.deck, shell_name(model, shell) + " has " + node_name(model, node) + ", which was removed again"));
  }
  return {};
}

Result<void> check_other_elements(const ModelDifference& difference) {
  for (int c = 0; c < kElementClassCount; ++c) {
    const auto& block = difference.model.elements[static_cast<std::size_t>(c)];
    if (!block) continue;
    for (std::size_t e = 0; e < block->size(); ++e)
      for (std::uint32_t n = block->first_node[e]; n < block->first_node[e + 1]; ++n)
        if (is_gone(difference.model, block->nodes[n]))
          return fail(still_used(difference, block->nodes[n],
                                 std::string(name(static_cast<ElementClass>(c))) + " " + std::to_string(block->id[e])));
  }
  return {};
}

Result<void> check_hidden_elements(const ModelDifference& difference) {
  const HiddenElements& hidden = difference.deck.hidden;
  for (std::size_t e = 0; e < hidden.size(); ++e)
    for (const NodeIndex node : hidden.nodes_of(e))
      if (is_gone(difference.model, node))
        return fail(still_used(
            difference, node,
            std::string(name(hidden.cards[e].element_class)) + " " + std::to_string(hidden.cards[e].id) + ", which isn't shown,"));
  return {};
}

Result<void> check_midside_nodes(const ModelDifference& difference) {
  const Model& model = difference.model;
  for (const MidsideNodes& midside : *difference.original.midside) {
    if (model.is_removed(midside.shell)) continue;
    for (const NodeIndex node : midside.node)
      if (is_gone(model, node)) return fail(still_used(difference, node, shell_name(model, midside.shell)));
  }
  return {};
}

/// Errors: a shell that is there, or another element, has a node that was removed.
Result<void> check_removed_nodes(const ModelDifference& difference) {
  const Changes& changes = difference.changes;
  for (const auto* shells : {&changes.added_shells, &changes.reshaped_shells})
    for (const ShellIndex shell : *shells)
      if (Result<void> fine = check_nodes_of(difference, shell); !fine) return fine;
  if (changes.removed_nodes.empty()) return {};
  for (const NodeIndex node : changes.removed_nodes)
    if (difference.original.adjacency)
      for (const ShellIndex shell : difference.original.adjacency->shells_of(node))
        if (Result<void> fine = check_nodes_of(difference, shell); !fine) return fine;
  if (Result<void> fine = check_other_elements(difference); !fine) return fine;
  if (Result<void> fine = check_hidden_elements(difference); !fine) return fine;
  return check_midside_nodes(difference);
}

}  // namespace

Result<void> check_difference(const ModelDifference& difference) {
  const Model& original = difference.original;
  const Model& model = difference.model;
  if (Result<void> same = check_same(difference, first_difference(original.shell_parts, model.shell_parts), "part"); !same) return same;
  if (Result<void> same = check_same(difference, first_difference(original.shell_thickness, model.shell_thickness), "thickness"); !same)
    return same;
  return check_removed_nodes(difference);
}

}  // namespace prismesh::mesh::deck
