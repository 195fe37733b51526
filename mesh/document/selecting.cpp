#include "mesh/document/selecting.h"

#include <algorithm>
#include <iterator>

#include "mesh/document/surroundings.h"
#include "mesh/model/adjacency.h"
#include "mesh/select/loops.h"
#include "mesh/select/outline.h"
#include "mesh/select/region.h"
#include "mesh/select/visible.h"

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

/// What a region begins with. Errors: no such node, no shell in sight.
Result<ShellSet> region_start(const Model& model, const Place& place, select::OutOfSight hidden) {
  if (const auto* point = std::get_if<std::array<double, 3>>(&place)) {
    ShellSet near = select::shells_near(model, Vec3((*point)[0], (*point)[1], (*point)[2]), hidden);
    if (near.empty()) return fail("", "no shell is in sight, so there is no region");
    return near;
  }
  const Result<NodeIndex> node = find_place(model, place);
  if (!node) return fail(node.error());
  ShellSet around = select::shells_at(model, *node, hidden);
  if (around.empty())
    return fail("", "node " + std::to_string(model.node_ids[node->value]) + " lies on no shell in sight, so there is no region around it");
  return around;
}

/// Errors: no free edge there.
Result<Picked> loop_at(const Generation& generation, const SelectRegion& recipe, const ShellSet& start, select::OutOfSight hidden) {
  const Model& model = generation.model;
  if (recipe.across_welds)
    return fail("", "select_region: a loop of free edges ends with its sheet, so \"across_welds\" doesn't go with \"by\": \"free_edge\"");
  Vec3 place;
  if (const auto* point = std::get_if<std::array<double, 3>>(&recipe.at))
    place = Vec3((*point)[0], (*point)[1], (*point)[2]);
  else
    place = model.position(model.find_node(std::get<std::int64_t>(recipe.at)));
  Picked loop{select::free_edge_loop(model, start, place, hidden), {}, select::Kind::node};
  if (loop.nodes.empty())
    return fail("", "the sheet at shell " + std::to_string(model.shell_ids[start.front().value]) + " has no free edge in sight");
  return loop;
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

std::vector<std::uint8_t> hidden_parts(const Generation& generation) {
  const std::vector<PartState>& states = *generation.parts;
  if (std::none_of(states.begin(), states.end(), [](const PartState& state) { return state.hidden; })) return {};
  std::vector<std::uint8_t> hidden(states.size());
  for (std::size_t part = 0; part < states.size(); ++part) hidden[part] = states[part].hidden ? 1 : 0;
  return hidden;
}

Result<Picked> region_at(const Generation& generation, const SelectRegion& recipe) {
  const Model& model = generation.model;
  const std::vector<std::uint8_t> hidden = hidden_parts(generation);
  const Result<ShellSet> start = region_start(model, recipe.at, hidden);
  if (!start) return fail(start.error());
  if (recipe.by == RegionBy::free_edge) return loop_at(generation, recipe, *start, hidden);
  select::RegionOptions options{select::RegionBound::features, recipe.angle, hidden, nullptr};
  if (recipe.by == RegionBy::part) options.bound = select::RegionBound::part;
  if (recipe.by == RegionBy::piece) options.bound = select::RegionBound::piece;
  select::WeldedShells welds;
  if (recipe.across_welds) {
    const auto& deck = generation.around->deck;
    welds = select::find_welds(model, deck ? deck->references.get() : nullptr, hidden);
    options.across = &welds;
  }
  ShellSet shells = select::region(model, *start, options);
  NodeSet nodes = nodes_of(model, shells);
  return Picked{std::move(nodes), std::move(shells), select::Kind::element};
}

Result<NodeSet> nodes_in_outline(const Generation& generation, const SelectLasso& recipe) {
  NodeSet nodes = select::inside_outline(generation.model, recipe.view, recipe.outline);
  std::erase_if(nodes, [&](NodeIndex node) { return (generation.node_marks[node.value] & kHidden) != 0; });
  if (!recipe.visible) return nodes;
  Result<NodeSet> visible = select::visible_nodes(generation.model, recipe.view, nodes, hidden_parts(generation));
  if (!visible) return fail("", "select_lasso: " + visible.error().message);
  return visible;
}

Result<NodeSet> nodes_at(const Generation& generation, const Where& where) {
  const Model& model = generation.model;
  const auto expression_nodes = [&](std::string_view expression, select::Kind kind) -> Result<NodeSet> {
    Result<select::Chosen> chosen = select::evaluate(model, expression, kind, generation.around->names);
    if (!chosen) return fail(chosen.error());
    return std::move(chosen->nodes);
  };
  if (const auto* expression = std::get_if<std::string>(&where)) return expression_nodes(*expression, select::Kind::node);
  if (const auto* recipe = std::get_if<Select>(&where)) return expression_nodes(recipe->expr, recipe->kind);
  if (const auto* lasso = std::get_if<SelectLasso>(&where)) return nodes_in_outline(generation, *lasso);
  Result<Picked> region = region_at(generation, std::get<SelectRegion>(where));
  if (!region) return fail(region.error());
  return std::move(region->nodes);
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
