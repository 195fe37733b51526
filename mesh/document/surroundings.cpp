#include "mesh/document/surroundings.h"

#include <algorithm>

namespace prismesh::mesh::document {

namespace {

Attached find_attached(const Model& model) {
  Attached attached;
  std::size_t count = 0;
  for (const auto& block : model.elements)
    if (block) count += block->nodes.size();
  attached.uses.reserve(count);
  for (std::size_t c = 0; c < model.elements.size(); ++c) {
    if (!model.elements[c]) continue;
    const ElementBlock& block = *model.elements[c];
    for (std::size_t e = 0; e < block.size(); ++e)
      for (std::size_t n = block.first_node[e]; n < block.first_node[e + 1]; ++n)
        if (block.nodes[n].valid()) attached.uses.push_back({block.nodes[n], static_cast<ElementClass>(c), static_cast<std::uint32_t>(e)});
  }
  std::sort(attached.uses.begin(), attached.uses.end());
  attached.uses.erase(std::unique(attached.uses.begin(), attached.uses.end()), attached.uses.end());
  return attached;
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

std::shared_ptr<const Surroundings> find_surroundings(std::shared_ptr<const deck::Deck> deck, const Model& model) {
  auto around = std::make_shared<Surroundings>();
  around->attached = find_attached(model);
  around->names = find_names(*deck);
  around->dependents = find_dependents(*deck, model, around->attached);
  around->deck = std::move(deck);
  return around;
}

}  // namespace prismesh::mesh::document
