#include "mesh/select/expression.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "mesh/model/adjacency.h"
#include "mesh/select/parse.h"

namespace prismesh::mesh::select {

namespace {

ItemClass class_of(Kind kind) {
  switch (kind) {
    case Kind::node: return ItemClass::node;
    case Kind::element: return ItemClass::shell;
    case Kind::part: return ItemClass::part;
  }
  return ItemClass::node;
}

/// The class of elements kept in Model::elements, or nothing for nodes, parts and shells.
std::optional<ElementClass> block_class(ItemClass item_class) {
  switch (item_class) {
    case ItemClass::beam: return ElementClass::beam;
    case ItemClass::solid: return ElementClass::solid;
    case ItemClass::tshell: return ElementClass::tshell;
    case ItemClass::discrete: return ElementClass::discrete;
    case ItemClass::mass: return ElementClass::mass;
    case ItemClass::sph: return ElementClass::sph;
    default: return std::nullopt;
  }
}

/// Marks what the items name, one after the other.
class Evaluator {
 public:
  Evaluator(const Model& model, Kind kind) : model_(model), kind_(kind) {
    const std::size_t count = kind == Kind::node ? model.node_count() : kind == Kind::element ? model.shell_count() : model.parts->size();
    marks_.assign(count, 0);
  }

  Result<void> take(const Item& item) {
    const ItemClass item_class = item.item_class == ItemClass::in_hand ? class_of(kind_) : item.item_class;
    if (block_class(item_class) && kind_ == Kind::element)
      return error(item, "only shells can be selected as elements; select " + std::string(name(item_class)) + " nodes with kind node");
    const IdIndex& ids = ids_of(item_class);
    if (ids.size() == 0) return error(item, "there is no " + std::string(name(item_class)) + " in the model");
    std::size_t rank = item.all ? 0 : ids.lower_bound(item.first);
    bool found = false;
    for (; rank < ids.size(); ++rank) {
      const auto [id, index] = ids.at(rank);
      if (!item.all && id > item.last) break;
      if (!item.all && (id - item.first) % item.step != 0) continue;
      found = true;
      mark_entity(item_class, index, item.remove ? 0 : 1);
    }
    if (!found) return names_nothing(item, item_class, ids);
    return {};
  }

  Chosen finish() const {
    Chosen chosen;
    switch (kind_) {
      case Kind::node: chosen.nodes = marked<NodeIndex>(marks_); break;
      case Kind::element:
        chosen.shells = marked<ShellIndex>(marks_);
        chosen.nodes = nodes_of(model_, chosen.shells);
        break;
      case Kind::part: {
        chosen.parts = marked<PartIndex>(marks_);
        std::vector<std::uint8_t> nodes(model_.node_count(), 0);
        each_shell([&](std::size_t shell, PartIndex part) {
          if (part.value < marks_.size() && marks_[part.value] != 0) chosen.shells.push_back(ShellIndex(shell));
        });
        for (const NodeIndex node : nodes_of(model_, chosen.shells)) nodes[node.value] = 1;
        for (const PartIndex part : chosen.parts) mark_part_blocks(part, nodes, 1);
        chosen.nodes = marked<NodeIndex>(nodes);
        break;
      }
    }
    return chosen;
  }

 private:
  template <class Index>
  static std::vector<Index> marked(const std::vector<std::uint8_t>& marks) {
    std::vector<Index> set;
    set.reserve(static_cast<std::size_t>(std::count(marks.begin(), marks.end(), 1)));
    for (std::size_t i = 0; i < marks.size(); ++i)
      if (marks[i] != 0) set.push_back(Index(i));
    return set;
  }

  template <class Body>
  void each_shell(const Body& body) const {
    std::size_t shell = 0;
    for (std::size_t c = 0; c < model_.shell_parts.chunk_count(); ++c)
      for (const PartIndex part : model_.shell_parts.chunk(c)) body(shell++, part);
  }

  tl::unexpected<Error> error(const Item& item, std::string message) const {
    return fail("expression", static_cast<long>(item.column), std::move(message));
  }

  tl::unexpected<Error> names_nothing(const Item& item, ItemClass item_class, const IdIndex& ids) const {
    const bool single = item.first == item.last;
    std::string message = single ? "there is no " : "no ";
    message += name(item_class);
    message += single ? " " : " lies in ";
    message += std::to_string(item.first);
    if (!single) message += '-' + std::to_string(item.last);
    if (item.step > 1) message += ':' + std::to_string(item.step);
    message += "; the nearest is ";
    message += name(item_class);
    message += ':' + std::to_string(nearest_id(ids, item));
    return error(item, std::move(message));
  }

  /// The existing id at the least distance from the item's ids; of two the lower.
  static std::int64_t nearest_id(const IdIndex& ids, const Item& item) {
    const std::size_t above = ids.lower_bound(item.first);
    if (above == ids.size()) return ids.at(above - 1).first;
    const std::int64_t high = ids.at(above).first;
    if (above == 0 || high <= item.last) return high;
    const std::int64_t low = ids.at(above - 1).first;
    // ids of a deck may be negative where a reader lets them: unsigned differences can't overflow
    const auto below = static_cast<std::uint64_t>(item.first) - static_cast<std::uint64_t>(low);
    const auto over = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(item.last);
    return below <= over ? low : high;
  }

  /// Ids of a class; those without an index in the model get one here, once.
  const IdIndex& ids_of(ItemClass item_class) {
    if (item_class == ItemClass::node) return *model_.node_index;
    if (item_class == ItemClass::shell) return *model_.shell_index;
    std::unique_ptr<IdIndex>& index = indices_[static_cast<std::size_t>(item_class)];
    if (index) return *index;
    std::vector<std::int64_t> ids;
    if (const auto element_class = block_class(item_class)) {
      if (const auto& block = model_.elements[static_cast<std::size_t>(*element_class)]) ids = block->id;
    } else {
      for (const Part& part : *model_.parts) ids.push_back(part.id);
    }
    index = std::make_unique<IdIndex>(ids);
    return *index;
  }

  void mark_entity(ItemClass item_class, std::uint32_t index, std::uint8_t value) {
    switch (kind_) {
      case Kind::node: mark_nodes(item_class, index, value); break;
      case Kind::element: mark_shells(item_class, index, value); break;
      case Kind::part: mark_parts(item_class, index, value); break;
    }
  }

  void mark_nodes(ItemClass item_class, std::uint32_t index, std::uint8_t value) {
    if (item_class == ItemClass::node) {
      marks_[index] = value;
    } else if (item_class == ItemClass::shell) {
      for (const NodeIndex node : model_.shell(ShellIndex(index)).node) marks_[node.value] = value;
      mark_midside(index, value);
    } else if (item_class == ItemClass::part) {
      mark_part_shells(PartIndex(index), value);
      mark_part_blocks(PartIndex(index), marks_, value);
    } else {
      const ElementBlock& block = *model_.elements[static_cast<std::size_t>(*block_class(item_class))];
      for (std::uint32_t n = block.first_node[index]; n < block.first_node[index + 1]; ++n) marks_[block.nodes[n].value] = value;
    }
  }

  void mark_midside(std::uint32_t shell, std::uint8_t value) {
    if (!model_.midside || model_.midside->empty()) return;
    const auto& all = *model_.midside;
    auto entry =
        std::lower_bound(all.begin(), all.end(), ShellIndex(shell), [](const MidsideNodes& m, ShellIndex s) { return m.shell < s; });
    if (entry == all.end() || entry->shell != ShellIndex(shell)) return;
    for (const NodeIndex node : entry->node)
      if (node.valid()) marks_[node.value] = value;
  }

  void mark_part_shells(PartIndex part, std::uint8_t value) {
    for (const std::uint32_t shell : shells_of(part)) {
      for (const NodeIndex node : model_.shell(ShellIndex(shell)).node) marks_[node.value] = value;
      mark_midside(shell, value);
    }
  }

  /// Nodes of a part's elements other than shells.
  void mark_part_blocks(PartIndex part, std::vector<std::uint8_t>& marks, std::uint8_t value) const {
    for (const auto& block : model_.elements) {
      if (!block) continue;
      for (std::size_t e = 0; e < block->size(); ++e)
        if (block->part[e] == part)
          for (std::uint32_t n = block->first_node[e]; n < block->first_node[e + 1]; ++n) marks[block->nodes[n].value] = value;
    }
  }

  void mark_shells(ItemClass item_class, std::uint32_t index, std::uint8_t value) {
    if (item_class == ItemClass::shell) {
      marks_[index] = value;
    } else if (item_class == ItemClass::node) {
      for (const ShellIndex shell : model_.adjacency->shells_of(NodeIndex(index))) marks_[shell.value] = value;
    } else {
      for (const std::uint32_t shell : shells_of(PartIndex(index))) marks_[shell] = value;
    }
  }

  void mark_parts(ItemClass item_class, std::uint32_t index, std::uint8_t value) {
    const auto mark = [&](PartIndex part) {
      if (part.value < marks_.size()) marks_[part.value] = value;
    };
    if (item_class == ItemClass::part) {
      marks_[index] = value;
    } else if (item_class == ItemClass::shell) {
      mark(model_.shell_parts[index]);
    } else if (item_class == ItemClass::node) {
      for (const ShellIndex shell : model_.adjacency->shells_of(NodeIndex(index))) mark(model_.shell_parts[shell.value]);
    } else {
      mark(model_.elements[static_cast<std::size_t>(*block_class(item_class))]->part[index]);
    }
  }

  /// Shells of a part; the lists of all parts are made at the first call, so that `part:1-1000` costs one pass.
  std::span<const std::uint32_t> shells_of(PartIndex part) {
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

  const Model& model_;
  Kind kind_;
  std::vector<std::uint8_t> marks_;  ///< of the kind's entities
  std::array<std::unique_ptr<IdIndex>, 10> indices_;
  std::vector<std::uint32_t> part_first_;
  std::vector<std::uint32_t> part_shells_;
};

}  // namespace

Result<Chosen> evaluate(const Model& model, std::string_view expression, Kind kind) {
  const Result<std::vector<Item>> items = parse(expression);
  if (!items) return fail(items.error());
  Evaluator evaluator(model, kind);
  for (const Item& item : *items)
    if (const Result<void> taken = evaluator.take(item); !taken) return fail(taken.error());
  return evaluator.finish();
}

std::string to_expression(std::vector<std::int64_t> ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  std::string text;
  for (std::size_t i = 0; i < ids.size();) {
    std::size_t last = i;
    while (last + 1 < ids.size() && ids[last + 1] - 1 == ids[last]) ++last;
    if (!text.empty()) text += ',';
    text += std::to_string(ids[i]);
    if (last > i) text += '-' + std::to_string(ids[last]);
    i = last + 1;
  }
  return text;
}

}  // namespace prismesh::mesh::select
