#include "mesh/document/refusal.h"

#include <algorithm>

#include "base/counted.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::document {

namespace {

/// The first locked part with an element at the node.
const Part* locked_part_at(const Generation& generation, NodeIndex node) {
  const Model& model = generation.model;
  const auto locked = [&](PartIndex part) { return part.valid() && (*generation.parts)[part.value].locked; };
  for (const ShellIndex shell : model.adjacency->shells_of(node))
    if (locked(model.shell_parts[shell.value])) return &(*model.parts)[model.shell_parts[shell.value].value];
  if (model.midside)
    for (const MidsideNodes& midside : *model.midside)
      if (std::find(midside.node.begin(), midside.node.end(), node) != midside.node.end() && locked(model.shell_parts[midside.shell.value]))
        return &(*model.parts)[model.shell_parts[midside.shell.value].value];
  for (const auto& block : model.elements) {
    if (!block) continue;
    for (std::size_t e = 0; e < block->size(); ++e)
      if (locked(block->part[e]))
        for (std::size_t n = block->first_node[e]; n < block->first_node[e + 1]; ++n)
          if (block->nodes[n] == node) return &(*model.parts)[block->part[e].value];
  }
  return nullptr;
}

struct Card {
  std::string file;
  long line = 0;
  std::string_view text;
};

Card card_of(const deck::Deck& deck, NodeIndex node) {
  if (deck.node_runs.empty() || node.value >= deck.node_line.size()) return {};
  const deck::SourceFile& file = deck.file_of(node);
  const std::string_view text = file.bytes.text();
  const std::size_t begin = std::min<std::size_t>(deck.node_line[node.value], text.size());
  const std::size_t end = std::min(text.find('\n', begin), text.size());
  return {file.path.string(), 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(begin), '\n'),
          text.substr(begin, end - begin)};
}

/// "&name" as it stands in the card; empty if there is none.
std::string parameter_in(std::string_view card) {
  const std::size_t begin = card.find('&');
  if (begin == std::string_view::npos) return "";
  return std::string(card.substr(begin, card.find_first_of(" ,\t\r)+-*/", begin + 1) - begin));
}

/// Names the parameter if that is the reason.
std::string why_held(std::uint8_t hold, const Card& card) {
  std::string why(mesh::why_held(hold));
  if ((hold & kHeldByParameter) != 0)
    if (const std::string parameter = parameter_in(card.text); !parameter.empty())
      why = "has coordinates given by the parameter " + parameter;
  return why;
}

}  // namespace

Result<void> refuse_held(const Generation& generation, const NodeSet& nodes, const deck::Deck* deck) {
  const Model& model = generation.model;
  NodeIndex first_locked, first_held;
  std::size_t locked = 0, held = 0;
  for (const NodeIndex node : nodes) {
    if ((generation.node_marks[node.value] & kLocked) != 0 && locked++ == 0) first_locked = node;
    if (model.node_holds[node.value] != 0 && held++ == 0) first_held = node;
  }
  if (locked > 0) {
    const Part* part = locked_part_at(generation, first_locked);
    const std::string where = part == nullptr ? "a locked part" : "the locked part " + std::to_string(part->id);
    return fail("", "node " + std::to_string(model.node_ids[first_locked.value]) + " would move but belongs to " + where +
                        (locked > 1 ? " (" + counted(locked, "such node") + " in all)" : "") + "; unlock the part or deselect its nodes");
  }
  if (held > 0) {
    const Card card = deck != nullptr ? card_of(*deck, first_held) : Card{};
    return fail(card.file, card.line,
                "node " + std::to_string(model.node_ids[first_held.value]) + " can't be moved: it " +
                    why_held(model.node_holds[first_held.value], card) + (held > 1 ? " (" + counted(held, "such node") + " in all)" : "") +
                    "; deselect it");
  }
  return {};
}

}  // namespace prismesh::mesh::document
