#include "ipc/import/model_change.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "ipc/import/hand_over_bytes.h"
#include "mesh/model/topology_change.h"

namespace prismesh::ipc {

namespace {

using mesh::Model;
using mesh::NodeIndex;
using mesh::NodeOrigin;
using mesh::ShellIndex;
using mesh::ShellNodes;
using mesh::Vec3;

constexpr std::uint64_t kChangeMagic = 0x3247'4843'4d53'5250;  // "PRSMCHG2"

/// Added elements of a class; lists of one length belong together.
struct AddedElements {
  std::vector<std::int64_t> ids;
  std::vector<mesh::PartIndex> parts;
  std::vector<std::uint32_t> examples;
  std::vector<std::uint32_t> first_node;  ///< as ElementBlock::first_node
  std::vector<NodeIndex> nodes;
};

/// An added part: what saving needs of it.
struct NewPart {
  std::int64_t id = 0;
  std::string name;
  std::string cards;
};

/// Lists of one length belong together.
struct ModelChange {
  std::vector<NodeIndex> moved;  ///< of the deck
  std::vector<Vec3> moved_to;
  std::vector<std::int64_t> node_ids;  ///< of added nodes, those that were removed again too
  std::vector<Vec3> node_positions;
  std::vector<NodeOrigin> node_origins;
  std::vector<std::int64_t> shell_ids;  ///< of added shells
  std::vector<ShellNodes> shell_nodes;
  std::vector<ShellIndex> shell_parents;
  std::vector<ShellIndex> reshaped;  ///< of the deck
  std::vector<ShellNodes> reshaped_to;
  std::vector<ShellIndex> removed_shells;  ///< in the order of their removal, as the nodes
  std::vector<NodeIndex> removed_nodes;
  std::vector<mesh::PlacedNode> placed;  ///< of the added nodes
  std::array<AddedElements, mesh::kElementClassCount> elements;
  std::vector<NewPart> parts;
};

template <class Archive>
void describe_change(Archive& io, auto& change) {
  io.array(change.moved);
  io.array(change.moved_to);
  io.array(change.node_ids);
  io.array(change.node_positions);
  io.array(change.node_origins);
  io.array(change.shell_ids);
  io.array(change.shell_nodes);
  io.array(change.shell_parents);
  io.array(change.reshaped);
  io.array(change.reshaped_to);
  io.array(change.removed_shells);
  io.array(change.removed_nodes);
  io.array(change.placed);
  for (auto& added : change.elements) {
    io.array(added.ids);
    io.array(added.parts);
    io.array(added.examples);
    io.array(added.first_node);
    io.array(added.nodes);
  }
  io.list(change.parts, 24, [&](auto& part) {
    io.number(part.id);
    io.text(part.name);
    io.text(part.cards);
  });
}

AddedElements added_elements(const Model& model, std::size_t element_class) {
  AddedElements added;
  const mesh::TopologyChange& grown = *model.topology_change;
  if (!model.elements[element_class]) return added;
  const mesh::ElementBlock& block = *model.elements[element_class];
  added.first_node.push_back(0);
  for (std::size_t e = grown.deck_elements[element_class]; e < block.size(); ++e) {
    added.ids.push_back(block.id[e]);
    added.parts.push_back(block.part[e]);
    added.nodes.insert(added.nodes.end(), block.nodes.begin() + block.first_node[e], block.nodes.begin() + block.first_node[e + 1]);
    added.first_node.push_back(static_cast<std::uint32_t>(added.nodes.size()));
  }
  added.examples = grown.element_examples[element_class];
  return added;
}

ModelChange change_between(const Model& original, const Model& model) {
  ModelChange change;
  change.moved = mesh::moved_nodes(original, model);
  for (const NodeIndex node : change.moved) change.moved_to.push_back(model.position(node));
  if (!model.topology_change) return change;
  const mesh::TopologyChange& grown = *model.topology_change;
  for (std::size_t n = original.node_count(); n < model.node_count(); ++n) {
    change.node_ids.push_back(model.node_ids[n]);
    change.node_positions.push_back(model.positions[n]);
    change.node_origins.push_back(mesh::origin_of(model, NodeIndex(n)));
  }
  for (std::size_t s = original.shell_count(); s < model.shell_count(); ++s) {
    change.shell_ids.push_back(model.shell_ids[s]);
    change.shell_nodes.push_back(model.shell_nodes[s]);
    change.shell_parents.push_back(grown.shell_parents[s - grown.deck_shells]);
  }
  change.reshaped = mesh::changes_between(original, model).reshaped_shells;
  for (const ShellIndex shell : change.reshaped) change.reshaped_to.push_back(model.shell(shell));
  change.removed_shells = grown.removed_shells;
  change.removed_nodes = grown.removed_nodes;
  change.placed = grown.placed_nodes;
  for (std::size_t c = 1; c < change.elements.size(); ++c) change.elements[c] = added_elements(model, c);
  for (std::size_t p = grown.deck_parts; model.parts && p < model.parts->size(); ++p)
    change.parts.push_back({(*model.parts)[p].id, (*model.parts)[p].name, grown.added_parts[p - grown.deck_parts].cards});
  return change;
}

template <class Index>
bool all_below(const std::vector<Index>& indices, std::size_t end) {
  return std::all_of(indices.begin(), indices.end(), [&](Index index) { return index.value < end; });
}

bool all_below(const ShellNodes& shell, std::size_t end) {
  return std::all_of(shell.node.begin(), shell.node.end(), [&](NodeIndex node) { return node.value < end; });
}

template <class Index>
bool all_differ(std::vector<Index> indices) {
  std::sort(indices.begin(), indices.end());
  return std::adjacent_find(indices.begin(), indices.end()) == indices.end();
}

/// A shell that was removed again has no nodes.
bool is_shell(const ShellNodes& shell, std::size_t nodes) { return !shell.node[0].valid() || all_below(shell, nodes); }

/// The used parents come first; behind them there is none.
bool comes_from(const NodeOrigin& origin, std::size_t nodes) {
  const int parents = origin.count();
  for (int p = 0; p < 4; ++p) {
    const auto at = static_cast<std::size_t>(p);
    if (p < parents ? origin.parent[at].value >= nodes || !(origin.weight[at] > 0 && origin.weight[at] <= 1) : origin.parent[at].valid())
      return false;
  }
  return parents > 0;
}

bool all_finite(const std::vector<Vec3>& points) {
  return std::all_of(points.begin(), points.end(), [](const Vec3& point) { return point.allFinite(); });
}

/// Whether they are ids that nothing has yet.
bool are_new(std::vector<std::int64_t> ids, const std::shared_ptr<const mesh::IdIndex>& taken) {
  std::sort(ids.begin(), ids.end());
  return (ids.empty() || ids.front() > 0) && std::adjacent_find(ids.begin(), ids.end()) == ids.end() &&
         std::none_of(ids.begin(), ids.end(), [&](std::int64_t id) { return taken->find(id) != mesh::IdIndex::kNotFound; });
}

/// Whether they are added nodes, ascending.
bool are_added(const std::vector<mesh::PlacedNode>& placed, std::size_t deck_nodes, std::size_t nodes) {
  std::size_t next = deck_nodes;
  for (const mesh::PlacedNode& each : placed) {
    if (each.node.value < next || each.node.value >= nodes || each.joins > mesh::kJoinsTies) return false;
    next = each.node.value + 1;
  }
  return true;
}

/// What is wrong with added elements of a class; empty: nothing.
std::string fault_of(const AddedElements& added, const mesh::ElementBlock* block, std::size_t parts, std::size_t nodes) {
  const std::size_t count = added.ids.size();
  if (count == 0 && added.first_node.size() <= 1 && added.nodes.empty() && added.parts.empty() && added.examples.empty()) return "";
  if (added.parts.size() != count || added.examples.size() != count || added.first_node.size() != count + 1 ||
      added.first_node.front() != 0 || added.first_node.back() != added.nodes.size() ||
      !std::is_sorted(added.first_node.begin(), added.first_node.end()))
    return "added elements lack ids, parts or nodes";
  if (!all_below(added.nodes, nodes)) return "an added element has a node that doesn't exist";
  for (std::size_t e = 0; e < count; ++e) {
    if (added.parts[e].valid() && added.parts[e].value >= parts) return "an added element has a part that doesn't exist";
    if (added.examples[e] != mesh::kNoExample && (block == nullptr || added.examples[e] >= block->size()))
      return "an added element is like one that doesn't exist";
  }
  std::vector<std::int64_t> ids = added.ids, taken = block != nullptr ? block->id : std::vector<std::int64_t>();
  std::sort(ids.begin(), ids.end());
  std::sort(taken.begin(), taken.end());
  if (ids.front() < 1 || std::adjacent_find(ids.begin(), ids.end()) != ids.end() ||
      std::any_of(ids.begin(), ids.end(), [&](std::int64_t id) { return std::binary_search(taken.begin(), taken.end(), id); }))
    return "something added has an id that isn't free";
  return "";
}

std::string fault_of(const std::vector<NewPart>& parts, const Model& original) {
  std::int64_t last = original.parts && !original.parts->empty() ? original.parts->back().id : 0;
  for (const NewPart& part : parts) {
    if (part.id <= last || part.cards.empty() || part.cards.back() != '\n') return "an added part has an id that isn't free, or no cards";
    last = part.id;
  }
  return "";
}

/// What doesn't fit the model; empty: all fits.
std::string fault_of(const ModelChange& change, const Model& original) {
  const std::size_t nodes = original.node_count() + change.node_ids.size(), shells = original.shell_count() + change.shell_ids.size();
  if (change.moved.size() != change.moved_to.size() || !all_below(change.moved, original.node_count()))
    return "a moved node isn't in the deck";
  if (change.node_ids.size() != change.node_positions.size() || change.node_ids.size() != change.node_origins.size())
    return "added nodes lack ids, places or origins";
  if (!all_finite(change.moved_to) || !all_finite(change.node_positions)) return "a node is nowhere";
  if (!are_new(change.node_ids, original.node_index) || !are_new(change.shell_ids, original.shell_index))
    return "something added has an id that isn't free";
  for (std::size_t n = 0; n < change.node_origins.size(); ++n)
    if (!comes_from(change.node_origins[n], original.node_count() + n)) return "an added node comes from none before it";
  if (change.shell_ids.size() != change.shell_nodes.size() || change.shell_ids.size() != change.shell_parents.size())
    return "added shells lack ids, nodes or parents";
  for (std::size_t s = 0; s < change.shell_nodes.size(); ++s)
    if (!is_shell(change.shell_nodes[s], nodes) || change.shell_parents[s].value >= original.shell_count() + s)
      return "an added shell has nodes or a parent that don't exist";
  if (change.reshaped.size() != change.reshaped_to.size() || !all_below(change.reshaped, original.shell_count()))
    return "a shell with other corners isn't in the deck";
  for (const ShellNodes& corners : change.reshaped_to)
    if (!all_below(corners, nodes)) return "a corner of a shell doesn't exist";
  if (!all_below(change.removed_shells, shells) || !all_differ(change.removed_shells) || !all_below(change.removed_nodes, nodes) ||
      !all_differ(change.removed_nodes))
    return "something is removed that doesn't exist, or twice";
  if (!are_added(change.placed, original.node_count(), nodes)) return "a placed node wasn't added";
  if (std::string fault = fault_of(change.parts, original); !fault.empty()) return fault;
  const std::size_t parts = (original.parts ? original.parts->size() : 0) + change.parts.size();
  for (std::size_t c = 1; c < change.elements.size(); ++c)
    if (std::string fault = fault_of(change.elements[c], original.elements[c].get(), parts, nodes); !fault.empty()) return fault;
  return "";
}

void apply(const ModelChange& change, Model& model) {
  for (std::size_t m = 0; m < change.moved.size(); ++m) model.positions.set(change.moved[m].value, change.moved_to[m]);
  auto placed = change.placed.begin();
  for (std::size_t n = 0; n < change.node_ids.size(); ++n) {
    if (placed != change.placed.end() && placed->node.value == model.node_count())
      mesh::add_placed_node(model, change.node_ids[n], change.node_positions[n], change.node_origins[n], (placed++)->joins);
    else
      mesh::add_node(model, change.node_ids[n], change.node_positions[n], change.node_origins[n]);
  }
  for (const NewPart& part : change.parts) {
    mesh::Part added;
    added.id = part.id;
    added.name = part.name;
    added.defined = true;
    mesh::add_part(model, std::move(added), {part.cards});
  }
  for (std::size_t c = 1; c < change.elements.size(); ++c) {
    const AddedElements& added = change.elements[c];
    for (std::size_t e = 0; e < added.ids.size(); ++e)
      mesh::add_element(model, static_cast<mesh::ElementClass>(c), added.ids[e], added.parts[e],
                        std::span(added.nodes).subspan(added.first_node[e], added.first_node[e + 1] - added.first_node[e]),
                        added.examples[e]);
  }
  for (std::size_t s = 0; s < change.shell_ids.size(); ++s)
    mesh::add_shell(model, change.shell_ids[s], change.shell_nodes[s], change.shell_parents[s]);
  for (std::size_t r = 0; r < change.reshaped.size(); ++r) mesh::set_shell_nodes(model, change.reshaped[r], change.reshaped_to[r]);
  for (const ShellIndex shell : change.removed_shells) mesh::remove_shell(model, shell);
  for (const NodeIndex node : change.removed_nodes) mesh::remove_node(model, node);
}

}  // namespace

std::vector<std::byte> write_model_change(const Model& original, const Model& model) {
  const ModelChange change = change_between(original, model);
  HandOverWriter counter;
  counter.number(kChangeMagic);
  describe_change(counter, change);
  std::vector<std::byte> bytes(counter.size());
  HandOverWriter writer(bytes);
  writer.number(kChangeMagic);
  describe_change(writer, change);
  return bytes;
}

Result<Model> read_model_change(std::span<const std::byte> bytes, const Model& original) {
  const auto refused = [](const std::string& fault) { return fail("what was edited", fault + "; nothing is written"); };
  HandOverReader from(bytes);
  std::uint64_t magic = 0;
  from.number(magic);
  if (magic != kChangeMagic) return refused("it doesn't begin as one, or is of another version");
  ModelChange change;
  describe_change(from, change);
  if (!from.ok()) return refused(from.fault());
  if (!from.at_end()) return refused("something follows its end");
  if (const std::string fault = fault_of(change, original); !fault.empty()) return refused(fault);
  Model model = original;
  apply(change, model);
  return model;
}

}  // namespace prismesh::ipc
