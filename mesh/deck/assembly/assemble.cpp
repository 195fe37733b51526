#include "mesh/deck/assembly/assemble.h"

#include <algorithm>
#include <string>
#include <utility>

#include "mesh/deck/assembly/assemble_elements.h"
#include "mesh/deck/assembly/assemble_nodes.h"
#include "mesh/deck/assembly/assemble_parts.h"
#include "mesh/deck/assembly/assemble_shells.h"

namespace prismesh::mesh::deck {
namespace {

/// Files whose nodes must not be moved, ascending.
std::vector<std::uint32_t> held_files(std::span<const PieceCards> cards) {
  std::vector<std::uint32_t> held;
  for (const PieceCards& piece : cards)
    if (piece.held) held.push_back(piece.file);
  std::sort(held.begin(), held.end());
  held.erase(std::unique(held.begin(), held.end()), held.end());
  return held;
}

void count_cards(std::span<const PieceCards> cards, Deck& deck) {
  for (const PieceCards& piece : cards) {
    deck.element_cards += piece.counts;
    deck.left_out_cards += piece.left_out;
    for (const auto& [kind, count] : piece.kinds) deck.element_kinds[kind] += count;
  }
}

void note_oddities(std::span<const PieceCards> cards, Warnings& warnings) {
  for (const PieceCards& piece : cards)
    for (const Oddity& oddity : piece.oddities) {
      const std::string id = oddity.id > 0 ? " (id " + std::to_string(oddity.id) + ")" : std::string();
      const std::string message =
          oddity.kind == "undefined-parameter" ? "a card" + id + " names a parameter that isn't defined; it is left out"
          : oddity.kind == "unnamed-node" ? std::string("a node has the id 0, by which no card can name it; it is kept and isn't shown")
                                          : "an element" + id + " has fewer nodes than its kind needs; it is left out";
      warnings.note(oddity.kind, piece.file, oddity.offset, message, oddity.count);
    }
}

void put_nodes(AssembledNodes nodes, Model& model, Deck& deck) {
  model.node_index = std::move(nodes.index);
  model.node_ids = std::move(nodes.ids);
  model.positions = std::move(nodes.positions);
  model.node_holds = std::move(nodes.holds);
  deck.node_runs = std::move(nodes.runs);
  deck.node_line = std::move(nodes.offset);
}

void put_shells(AssembledShells shells, Model& model, Deck& deck) {
  model.shell_index = std::move(shells.index);
  model.second_shells = std::move(shells.second);
  deck.shared_shell_ids = model.shell_index->duplicates();
  model.shell_ids = std::move(shells.ids);
  model.shell_nodes = std::move(shells.nodes);
  model.shell_parts = std::move(shells.parts);
  model.shell_thickness = std::move(shells.thickness);
  model.midside = std::move(shells.midside);
  deck.shell_runs = std::move(shells.runs);
  deck.shell_line = std::move(shells.offset);
}

/// Marks the first unread node that an element may need as an error, and warns of the others.
void settle_unread_nodes(std::span<PieceCards> cards, std::vector<std::int64_t> undefined, Warnings& warnings) {
  std::sort(undefined.begin(), undefined.end());
  for (PieceCards& piece : cards)
    for (UnreadNode& node : piece.unread_nodes) {
      const bool is_needed = node.id == 0 ? !undefined.empty() : std::binary_search(undefined.begin(), undefined.end(), node.id);
      if (!is_needed)
        warnings.note("bad-card", piece.file, node.offset, node.message + "; no element needs it, so it is kept as it is");
      else if (!piece.error)
        piece.error = {node.offset, std::move(node.message)};
    }
}

/// Warns of a quad and a triangle with one number.
void note_shared_ids(const Model& model, const Deck& deck, Warnings& warnings) {
  if (!model.second_shells) return;
  for (const ShellIndex shell : *model.second_shells) {
    const std::string id = std::to_string(model.shell_ids[shell.value]);
    warnings.note("shared-shell-number", deck.run_of(shell).file, deck.shell_line[shell.value],
                  "two shells have the number " + id + "; quad:" + id + " and tri:" + id +
                      " name one of them. Such shells can be moved, but not divided or removed");
  }
}

/// The elements that a reader has found, but couldn't pass on.
void hide_unusable(std::span<const PieceCards> cards, const IdLookup& lookup, HiddenElements& hidden) {
  std::vector<NodeIndex> nodes;
  for (const PieceCards& piece : cards)
    for (const RawHiddenElement& element : piece.hidden) {
      nodes.clear();
      for (const std::int64_t node : element.nodes)
        if (node > 0) nodes.push_back(lookup.node(node));
      hide({element.element_class, element.id, piece.file, element.offset}, nodes, hidden);
    }
}

void put_left_out(LeftOutElements left_out, Model& model, Deck& deck) {
  deck.left_out_cards += left_out.counts;
  for (const NodeIndex node : left_out.nodes)
    model.node_holds.set(node.value, static_cast<std::uint8_t>(model.node_holds[node.value] | kHeldByMissing));
  deck.left_out_elements = std::move(left_out.ids);
  for (const HiddenElements::Card& card : left_out.hidden.cards) deck.left_out_elements.push_back(card.id);
  deck.hidden = std::move(left_out.hidden);
}

}  // namespace

Model assemble(std::span<PieceCards> cards, std::vector<Part> parts, Deck& deck, Warnings& warnings) {
  deck.held_files = held_files(cards);
  count_cards(cards, deck);
  note_oddities(cards, warnings);

  Model model;
  put_nodes(assemble_nodes(cards, deck.frames, warnings), model, deck);
  const AssembledParts assembled_parts = assemble_parts(cards, std::move(parts));
  model.parts = assembled_parts.parts;

  const IdLookup lookup{*model.node_index, assembled_parts.index};
  LeftOutElements left_out;
  put_shells(assemble_shells(cards, lookup, left_out, warnings), model, deck);
  note_shared_ids(model, deck, warnings);
  model.elements = assemble_elements(cards, lookup, left_out, warnings);
  hide_unusable(cards, lookup, left_out.hidden);
  // A new node with such an id would complete an element that nobody sees.
  for (const std::int64_t node : left_out.undefined_nodes) deck.taken.nodes.push_back({node, node});
  settle_unread_nodes(cards, std::move(left_out.undefined_nodes), warnings);
  put_left_out(std::move(left_out), model, deck);
  return model;
}

}  // namespace prismesh::mesh::deck
