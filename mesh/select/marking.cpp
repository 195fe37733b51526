#include "mesh/select/marking.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "mesh/model/adjacency.h"

namespace prismesh::mesh::select {

namespace {

template <class Index>
std::vector<Index> marked(const Marks& marks) {
  std::vector<Index> set;
  set.reserve(static_cast<std::size_t>(std::count(marks.begin(), marks.end(), 1)));
  for (std::size_t i = 0; i < marks.size(); ++i)
    if (marks[i] != 0) set.push_back(Index(i));
  return set;
}

}  // namespace

std::optional<ElementClass> block_class(ItemClass item_class) {
  switch (item_class) {
    case ItemClass::beam: return ElementClass::beam;
    case ItemClass::solid: return ElementClass::solid;
    case ItemClass::tshell: return ElementClass::tshell;
    case ItemClass::discrete: return ElementClass::discrete;
    case ItemClass::mass: return ElementClass::mass;
    case ItemClass::sph: return ElementClass::sph;
    case ItemClass::other: return ElementClass::other;
    default: return std::nullopt;
  }
}

/// Visits the shells that exist, with their parts.
template <class Body>
void Marking::each_shell(const Body& body) const {
  std::size_t shell = 0;
  for (std::size_t c = 0; c < model_.shell_parts.chunk_count(); ++c)
    for (const PartIndex part : model_.shell_parts.chunk(c)) {
      if (!model_.topology_change || !model_.is_removed(ShellIndex(shell))) body(shell, part);
      ++shell;
    }
}

Marks Marking::nothing() const {
  return Marks(kind_ == EntityKind::node      ? model_.node_count()
               : kind_ == EntityKind::element ? model_.shell_count()
                                              : model_.parts->size(),
               0);
}

Marks Marking::everything() const {
  Marks marks = nothing();
  std::fill(marks.begin(), marks.end(), std::uint8_t{1});
  if (!model_.topology_change || kind_ == EntityKind::part) return marks;
  for (std::size_t i = 0; i < marks.size(); ++i)
    if (kind_ == EntityKind::node ? model_.is_removed(NodeIndex(i)) : model_.is_removed(ShellIndex(i))) marks[i] = 0;
  return marks;
}

/// The ids of the shells with so many corners; their indices go to shells_.
std::vector<std::int64_t> Marking::ids_with_corners(ItemClass entity) {
  std::vector<std::int64_t> ids;
  std::vector<std::uint32_t>& shells = shells_[static_cast<std::size_t>(entity)];
  each_shell([&](std::size_t shell, PartIndex) {
    if (model_.shell(ShellIndex(shell)).is_triangle() != (entity == ItemClass::tri)) return;
    ids.push_back(model_.shell_ids[shell]);
    shells.push_back(static_cast<std::uint32_t>(shell));
  });
  return ids;
}

/// Classes without an index in the model get one here, once.
const IdIndex& Marking::ids_of(ItemClass entity) {
  if (entity == ItemClass::node) return *model_.node_index;
  if (entity == ItemClass::shell) return *model_.shell_index;
  std::unique_ptr<IdIndex>& index = indices_[static_cast<std::size_t>(entity)];
  if (index) return *index;
  std::vector<std::int64_t> ids;
  if (entity == ItemClass::quad || entity == ItemClass::tri) {
    ids = ids_with_corners(entity);
  } else if (const auto element_class = block_class(entity)) {
    if (const auto& block = model_.elements[static_cast<std::size_t>(*element_class)]) ids = block->id;
  } else {
    for (const Part& part : *model_.parts) ids.push_back(part.id);
  }
  index = std::make_unique<IdIndex>(ids);
  return *index;
}

bool Marking::mark_ids(Marks& marks, ItemClass entity, const SteppedIdRange& range, std::uint8_t value, ShellKind of_shared) {
  if (entity == ItemClass::shell && model_.second_shells) return mark_shell_ids(marks, range, value, of_shared);
  const IdIndex& ids = ids_of(entity);
  const bool by_corners = entity == ItemClass::quad || entity == ItemClass::tri;
  bool found = false;
  for (std::size_t rank = ids.lower_bound(range.first); rank < ids.size(); ++rank) {
    const auto [id, index] = ids.at(rank);
    if (id > range.last) break;
    if (range.step > 1 && (id - range.first) % range.step != 0) continue;
    found = true;
    if (by_corners)
      mark(marks, ItemClass::shell, shells_[static_cast<std::size_t>(entity)][index], value);
    else
      mark(marks, entity, index, value);
  }
  return found;
}

/// Where two shells may have one id.
bool Marking::mark_shell_ids(Marks& marks, const SteppedIdRange& range, std::uint8_t value, ShellKind of_shared) {
  const std::vector<ShellIndex>& second = *model_.second_shells;
  const IdIndex& ids = *model_.shell_index;
  auto other = std::lower_bound(second.begin(), second.end(), range.first,
                                [&](ShellIndex shell, std::int64_t id) { return model_.shell_ids[shell.value] < id; });
  bool found = false;
  for (std::size_t rank = ids.lower_bound(range.first); rank < ids.size(); ++rank) {
    const auto [id, index] = ids.at(rank);
    if (id > range.last) break;
    std::vector<ShellIndex> shells{ShellIndex(index)};
    for (; other != second.end() && model_.shell_ids[other->value] == id; ++other) shells.push_back(*other);
    if (range.step > 1 && (id - range.first) % range.step != 0) continue;
    found = true;
    for (const ShellIndex shell : shells) {
      const bool is_triangle = model_.shell(shell).is_triangle();
      if (shells.size() > 1 && of_shared != ShellKind::any && is_triangle != (of_shared == ShellKind::triangles)) continue;
      mark(marks, ItemClass::shell, shell.value, value);
    }
  }
  return found;
}

void Marking::mark(Marks& marks, ItemClass entity, std::uint32_t index, std::uint8_t value) {
  switch (kind_) {
    case EntityKind::node: mark_nodes(marks, entity, index, value); break;
    case EntityKind::element: mark_shells(marks, entity, index, value); break;
    case EntityKind::part: mark_parts(marks, entity, index, value); break;
  }
}

void Marking::mark_nodes(Marks& marks, ItemClass entity, std::uint32_t index, std::uint8_t value) {
  if (entity == ItemClass::node) {
    marks[index] = value;
  } else if (entity == ItemClass::shell) {
    mark_shell_nodes(marks, index, value);
  } else if (entity == ItemClass::part) {
    for (const std::uint32_t shell : shells_of(PartIndex(index))) mark_shell_nodes(marks, shell, value);
    mark_part_blocks(PartIndex(index), marks, value);
  } else {
    const ElementBlock& block = *model_.elements[static_cast<std::size_t>(*block_class(entity))];
    for (std::uint32_t n = block.first_node[index]; n < block.first_node[index + 1]; ++n) marks[block.nodes[n].value] = value;
  }
}

/// Corners and mid-side nodes.
void Marking::mark_shell_nodes(Marks& marks, std::uint32_t shell, std::uint8_t value) {
  for (const NodeIndex node : model_.shell(ShellIndex(shell)).node) marks[node.value] = value;
  if (!model_.midside || model_.midside->empty()) return;
  const auto& all = *model_.midside;
  auto entry = std::lower_bound(all.begin(), all.end(), ShellIndex(shell), [](const MidsideNodes& m, ShellIndex s) { return m.shell < s; });
  if (entry == all.end() || entry->shell != ShellIndex(shell)) return;
  for (const NodeIndex node : entry->node)
    if (node.valid()) marks[node.value] = value;
}

/// Nodes of a part's elements other than shells.
void Marking::mark_part_blocks(PartIndex part, Marks& marks, std::uint8_t value) const {
  for (const auto& block : model_.elements) {
    if (!block) continue;
    for (std::size_t e = 0; e < block->size(); ++e)
      if (block->part[e] == part)
        for (std::uint32_t n = block->first_node[e]; n < block->first_node[e + 1]; ++n) marks[block->nodes[n].value] = value;
  }
}

void Marking::mark_shells(Marks& marks, ItemClass entity, std::uint32_t index, std::uint8_t value) {
  if (entity == ItemClass::shell) {
    marks[index] = value;
  } else if (entity == ItemClass::node) {
    for (const ShellIndex shell : model_.adjacency->shells_of(NodeIndex(index))) marks[shell.value] = value;
  } else if (entity == ItemClass::part) {
    for (const std::uint32_t shell : shells_of(PartIndex(index))) marks[shell] = value;
  }
}

void Marking::mark_parts(Marks& marks, ItemClass entity, std::uint32_t index, std::uint8_t value) {
  const auto mark = [&](PartIndex part) {
    if (part.value < marks.size()) marks[part.value] = value;
  };
  if (entity == ItemClass::part) {
    marks[index] = value;
  } else if (entity == ItemClass::shell) {
    mark(model_.shell_parts[index]);
  } else if (entity == ItemClass::node) {
    for (const ShellIndex shell : model_.adjacency->shells_of(NodeIndex(index))) mark(model_.shell_parts[shell.value]);
  } else {
    mark(model_.elements[static_cast<std::size_t>(*block_class(entity))]->part[index]);
  }
}

/// Shells of a part. The first call makes the lists of all parts, so that `part:1-1000` costs one pass.
std::span<const std::uint32_t> Marking::shells_of(PartIndex part) {
  if (part_first_.empty()) {
    part_first_.assign(model_.parts->size() + 2, 0);
    const std::size_t parts = model_.parts->size();
    each_shell([&](std::size_t, PartIndex p) {
      if (p.value < parts) ++part_first_[p.value + 2];
    });
    for (std::size_t i = 2; i < part_first_.size(); ++i) part_first_[i] += part_first_[i - 1];
    part_shells_.resize(part_first_.back());
    each_shell([&](std::size_t shell, PartIndex p) {
      if (p.value < parts) part_shells_[part_first_[p.value + 1]++] = static_cast<std::uint32_t>(shell);
    });
  }
  return std::span(part_shells_).subspan(part_first_[part.value], part_first_[part.value + 1] - part_first_[part.value]);
}

Chosen Marking::chosen(const Marks& marks) const {
  Chosen chosen;
  switch (kind_) {
    case EntityKind::node: chosen.nodes = marked<NodeIndex>(marks); break;
    case EntityKind::element:
      chosen.shells = marked<ShellIndex>(marks);
      chosen.nodes = nodes_of(model_, chosen.shells);
      break;
    case EntityKind::part: {
      chosen.parts = marked<PartIndex>(marks);
      Marks nodes(model_.node_count(), 0);
      each_shell([&](std::size_t shell, PartIndex part) {
        if (part.value < marks.size() && marks[part.value] != 0) chosen.shells.push_back(ShellIndex(shell));
      });
      for (const NodeIndex node : nodes_of(model_, chosen.shells)) nodes[node.value] = 1;
      for (const PartIndex part : chosen.parts) mark_part_blocks(part, nodes, 1);
      chosen.nodes = marked<NodeIndex>(nodes);
      break;
    }
  }
  return chosen;
}

}  // namespace prismesh::mesh::select
