#include "mesh/document/part_marks.h"

#include <algorithm>
#include <span>

#include "mesh/document/deck_relations.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::document {

std::vector<std::uint8_t> hidden_parts(const Generation& generation) {
  const std::vector<PartState>& states = *generation.parts;
  if (std::none_of(states.begin(), states.end(), [](const PartState& state) { return state.hidden; })) return {};
  std::vector<std::uint8_t> hidden(states.size());
  for (std::size_t part = 0; part < states.size(); ++part) hidden[part] = states[part].hidden ? 1 : 0;
  return hidden;
}

namespace {

/// A bit above those of the marks: a visible part uses the node.
constexpr std::uint8_t kUsedInSight = 8;

void note_use(std::vector<std::uint8_t>& bits, NodeIndex node, const PartState* state) {
  if (!node.valid()) return;
  std::uint8_t use = kUsedInSight;
  if (state != nullptr && state->hidden) use = kHidden;
  if (state != nullptr && state->locked) use |= kLocked;
  bits[node.value] |= use;
}

std::vector<std::uint8_t> gather_uses(const Model& model, const std::vector<PartState>& states) {
  std::vector<std::uint8_t> bits(model.node_count(), 0);
  const auto state_of = [&](PartIndex part) { return part.valid() ? &states[part.value] : nullptr; };
  for (std::size_t c = 0; c < model.shell_nodes.chunk_count(); ++c) {
    const std::span<const ShellNodes> shells = model.shell_nodes.chunk(c);
    const std::span<const PartIndex> parts = model.shell_parts.chunk(c);
    for (std::size_t i = 0; i < shells.size(); ++i)
      for (const NodeIndex node : shells[i].node) note_use(bits, node, state_of(parts[i]));
  }
  if (model.midside)
    for (const MidsideNodes& midside : *model.midside)
      for (const NodeIndex node : midside.node) note_use(bits, node, state_of(model.shell_parts[midside.shell.value]));
  for (const auto& block : model.elements) {
    if (!block) continue;
    for (std::size_t e = 0; e < block->size(); ++e)
      for (std::size_t n = block->first_node[e]; n < block->first_node[e + 1]; ++n)
        note_use(bits, block->nodes[n], state_of(block->part[e]));
  }
  return bits;
}

}  // namespace

void mark_parts(const Model& model, const std::vector<PartState>& states, ChunkedArray<std::uint8_t>& marks) {
  const bool plain = std::all_of(states.begin(), states.end(), [](const PartState& state) { return state == PartState{}; });
  const std::vector<std::uint8_t> bits = plain ? std::vector<std::uint8_t>(model.node_count(), 0) : gather_uses(model, states);
  constexpr std::uint8_t kOfParts = kLocked | kHidden;
  const auto wanted = [&](std::size_t node) {
    const std::uint8_t use = bits[node];
    const bool hidden = (use & kHidden) != 0 && (use & kUsedInSight) == 0;
    return static_cast<std::uint8_t>((use & kLocked) | (hidden ? kHidden : 0));
  };
  for (std::size_t c = 0; c < marks.chunk_count(); ++c) {
    const std::size_t first = c * kChunkSize;
    const std::span<const std::uint8_t> old = marks.chunk(c);
    std::size_t i = 0;
    while (i < old.size() && (old[i] & kOfParts) == wanted(first + i)) ++i;
    if (i == old.size()) continue;
    const std::span<std::uint8_t> chunk = marks.own_chunk(c);
    for (; i < chunk.size(); ++i) chunk[i] = static_cast<std::uint8_t>((chunk[i] & ~kOfParts) | wanted(first + i));
  }
}

namespace {

/// The marks of one node by the parts' states.
std::uint8_t part_marks_of(const Generation& generation, NodeIndex node) {
  const Model& model = generation.model;
  const std::vector<PartState>& states = *generation.parts;
  bool in_sight = false, hidden = false, locked = false;
  const auto note = [&](PartIndex part) {
    const PartState state = part.valid() ? states[part.value] : PartState{};
    (state.hidden ? hidden : in_sight) = true;
    locked = locked || state.locked;
  };
  for (const ShellIndex shell : model.adjacency->shells_of(node)) note(model.shell_parts[shell.value]);
  for (const ElementUse& use : uses_at(*generation.relations, node))
    note(model.elements[static_cast<std::size_t>(use.element_class)]->part[use.element]);
  if (model.midside)
    for (const MidsideNodes& midside : *model.midside)
      if (std::find(midside.node.begin(), midside.node.end(), node) != midside.node.end()) note(model.shell_parts[midside.shell.value]);
  return static_cast<std::uint8_t>((locked ? kLocked : 0) | (hidden && !in_sight ? kHidden : 0));
}

}  // namespace

void mark_parts_at(const NodeSet& nodes, Generation& next) {
  const std::vector<PartState>& states = *next.parts;
  if (std::all_of(states.begin(), states.end(), [](const PartState& state) { return state == PartState{}; })) return;
  for (const NodeIndex node : nodes) {
    const std::uint8_t old = next.node_marks[node.value];
    const auto mark = static_cast<std::uint8_t>((old & kSelected) | part_marks_of(next, node));
    if (mark != old) next.node_marks.set(node.value, mark);
  }
}

}  // namespace prismesh::mesh::document
