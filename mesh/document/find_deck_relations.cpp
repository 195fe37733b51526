#include "mesh/document/find_deck_relations.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "mesh/document/find_dependents.h"

namespace prismesh::mesh::document {

namespace {

std::vector<ElementUse> find_element_uses(const Model& model) {
  std::vector<ElementUse> uses;
  std::size_t count = 0;
  for (const auto& block : model.elements)
    if (block) count += block->nodes.size();
  uses.reserve(count);
  for (std::size_t c = 0; c < model.elements.size(); ++c) {
    if (!model.elements[c]) continue;
    const ElementBlock& block = *model.elements[c];
    for (std::size_t e = 0; e < block.size(); ++e)
      for (std::size_t n = block.first_node[e]; n < block.first_node[e + 1]; ++n)
        if (block.nodes[n].valid()) uses.push_back({block.nodes[n], static_cast<ElementClass>(c), static_cast<std::uint32_t>(e)});
  }
  std::sort(uses.begin(), uses.end());
  uses.erase(std::unique(uses.begin(), uses.end()), uses.end());
  return uses;
}

std::vector<HiddenUse> find_hidden_uses(const deck::HiddenElements& hidden) {
  std::vector<HiddenUse> uses;
  uses.reserve(hidden.nodes.size());
  for (std::uint32_t e = 0; e < hidden.size(); ++e)
    for (const NodeIndex node : hidden.nodes_of(e)) uses.push_back({node, e});
  std::sort(uses.begin(), uses.end());
  uses.erase(std::unique(uses.begin(), uses.end()), uses.end());
  return uses;
}

/// Points into the deck.
select::Names find_names(const deck::Deck& deck) {
  select::Names names;
  names.references = deck.references.get();
  for (const deck::SourceFile& file : deck.files) names.files.push_back(file.relative.generic_string());
  if (!deck.node_runs.empty()) names.file_of_node = [&deck](NodeIndex node) { return deck.run_of(node).file; };
  if (!deck.shell_runs.empty()) names.file_of_shell = [&deck](ShellIndex shell) { return deck.run_of(shell).file; };
  return names;
}

}  // namespace

std::shared_ptr<const DeckRelations> find_deck_relations(std::shared_ptr<const deck::Deck> deck, const Model& model) {
  auto relations = std::make_shared<DeckRelations>();
  relations->names = find_names(*deck);
  relations->element_uses = find_element_uses(model);
  relations->hidden_uses = find_hidden_uses(deck->hidden);
  relations->dependents = find_dependents(*deck, model, relations->element_uses);
  relations->deck = std::move(deck);
  return relations;
}

std::shared_ptr<const DeckRelations> carry_deck_relations(std::shared_ptr<const deck::Deck> saved, const DeckRelations& relations) {
  auto carried = std::make_shared<DeckRelations>(relations);
  carried->names = find_names(*saved);
  carried->deck = std::move(saved);
  return carried;
}

}  // namespace prismesh::mesh::document
