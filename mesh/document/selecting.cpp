#include "mesh/document/selecting.h"

#include <algorithm>
#include <iterator>

#include "mesh/model/adjacency.h"
#include "mesh/select/region.h"

namespace prismesh::mesh::document {

namespace {

/// Indices whose mark has `bit`, ascending.
template <class IndexType>
std::vector<IndexType> marked(const ChunkedArray<std::uint8_t>& marks, std::uint8_t bit, std::size_t expected) {
  std::vector<IndexType> set;
  if (expected == 0) return set;
  set.reserve(expected);
  const void* empty = nullptr;  // a chunk known to hold none: untouched chunks of marks all are one chunk
  for (std::size_t c = 0; c < marks.chunk_count(); ++c) {
    if (marks.chunk_owner(c).get() == empty) continue;
    const std::span<const std::uint8_t> chunk = marks.chunk(c);
    const std::size_t before = set.size();
    for (std::size_t i = 0; i < chunk.size(); ++i)
      if ((chunk[i] & bit) != 0) set.push_back(IndexType(c * kChunkSize + i));
    if (set.size() == before) empty = marks.chunk_owner(c).get();
    if (set.size() == expected) break;
  }
  return set;
}

template <class IndexType>
void put_marks(ChunkedArray<std::uint8_t>& marks, const std::vector<IndexType>& before, const std::vector<IndexType>& after,
               std::uint8_t bit) {
  std::vector<IndexType> changed;
  std::set_symmetric_difference(before.begin(), before.end(), after.begin(), after.end(), std::back_inserter(changed));
  for (std::size_t i = 0; i < changed.size();) {
    const std::size_t c = changed[i].value / kChunkSize;
    const std::span<std::uint8_t> chunk = marks.own_chunk(c);
    for (; i < changed.size() && changed[i].value / kChunkSize == c; ++i) {
      std::uint8_t& mark = chunk[changed[i].value % kChunkSize];
      mark = static_cast<std::uint8_t>(mark ^ bit);
    }
  }
}

bool in_sight(const Generation& generation, ShellIndex shell) {
  const PartIndex part = generation.model.shell_parts[shell.value];
  return !part.valid() || !(*generation.parts)[part.value].hidden;
}

}  // namespace

NodeSet selection(const Generation& generation) { return marked<NodeIndex>(generation.node_marks, kSelected, generation.selected_nodes); }

ShellSet selected_shells(const Generation& generation) {
  return marked<ShellIndex>(generation.shell_marks, kSelected, generation.selected_shells);
}

Picked picked(const Generation& generation) { return {selection(generation), selected_shells(generation), generation.selection_kind}; }

void put_selection(Generation& next, const Picked& before, const Picked& after) {
  put_marks(next.node_marks, before.nodes, after.nodes, kSelected);
  put_marks(next.shell_marks, before.shells, after.shells, kSelected);
  next.selection_kind = after.kind;
  next.selected_nodes = after.nodes.size();
  next.selected_shells = after.shells.size();
}

Result<NodeIndex> find_place(const Model& model, const Place& place) {
  if (model.node_count() == 0) return fail("", "the model has no nodes");
  if (const auto* point = std::get_if<std::array<double, 3>>(&place))
    return select::nearest_node(model, Vec3((*point)[0], (*point)[1], (*point)[2]));
  const std::int64_t id = std::get<std::int64_t>(place);
  const NodeIndex node = model.find_node(id);
  if (node.valid()) return node;
  const IdIndex& ids = *model.node_index;
  std::size_t rank = std::min(ids.lower_bound(id), ids.size() - 1);
  if (rank > 0 && ids.at(rank).first > id && id - ids.at(rank - 1).first <= ids.at(rank).first - id) --rank;
  return fail("", "there is no node " + std::to_string(id) + "; the nearest id is " + std::to_string(ids.at(rank).first));
}

Result<ShellSet> visible_region(const Generation& generation, const SelectRegion& recipe) {
  const Model& model = generation.model;
  const Result<NodeIndex> start = find_place(model, recipe.at);
  if (!start) return fail(start.error());
  const auto around = model.adjacency->shells_of(*start);
  if (std::none_of(around.begin(), around.end(), [&](ShellIndex shell) { return in_sight(generation, shell); }))
    return fail("", "node " + std::to_string(model.node_ids[start->value]) + " lies on no shell in sight, so there is no region around it");
  ShellSet shells = select::region(model, *start, recipe.angle);
  std::erase_if(shells, [&](ShellIndex shell) { return !in_sight(generation, shell); });
  return shells;
}

Result<NodeSet> visible_in_outline(const Generation& generation, const SelectLasso& recipe) {
  if (recipe.visible)
    return fail("",
                "select_lasso: \"visible\": true takes a picture of the model, which only a view has; leave it false to select through");
  NodeSet nodes = select::inside_outline(generation.model, recipe.view, recipe.outline);
  std::erase_if(nodes, [&](NodeIndex node) { return (generation.node_marks[node.value] & kHidden) != 0; });
  return nodes;
}

Result<NodeSet> nodes_at(const Generation& generation, const Where& where) {
  const Model& model = generation.model;
  const auto expression_nodes = [&](std::string_view expression, select::Kind kind) -> Result<NodeSet> {
    Result<select::Chosen> chosen = select::evaluate(model, expression, kind);
    if (!chosen) return fail(chosen.error());
    return std::move(chosen->nodes);
  };
  if (const auto* expression = std::get_if<std::string>(&where)) return expression_nodes(*expression, select::Kind::node);
  if (const auto* recipe = std::get_if<Select>(&where)) return expression_nodes(recipe->expr, recipe->kind);
  if (const auto* lasso = std::get_if<SelectLasso>(&where)) return visible_in_outline(generation, *lasso);
  const Result<ShellSet> shells = visible_region(generation, std::get<SelectRegion>(where));
  if (!shells) return fail(shells.error());
  return nodes_of(model, *shells);
}

namespace {

/// What a node's uses say; private bits above the marks'.
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

}  // namespace prismesh::mesh::document
