#include "mesh/select/expression.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "mesh/model/adjacency.h"
#include "mesh/model/topology_change.h"
#include "mesh/select/marking.h"
#include "mesh/select/parse.h"

namespace prismesh::mesh::select {

namespace {

/// Limits, since sets may contain sets and decks may be hostile.
constexpr int kMaxSetDepth = 32;
constexpr int kMaxSets = 10'000;  ///< that one expression evaluates
constexpr std::size_t kStepsBetweenReports = 64;
constexpr std::uint64_t kFewIds = 10'000;  ///< a smaller model counts as one of this size

ItemClass class_of(EntityKind kind) {
  switch (kind) {
    case EntityKind::node: return ItemClass::node;
    case EntityKind::element: return ItemClass::shell;
    case EntityKind::part: return ItemClass::part;
  }
  return ItemClass::node;
}

Referred set_of(EntityKind kind) {
  return kind == EntityKind::node ? Referred::node_set : kind == EntityKind::element ? Referred::shell_set : Referred::part_set;
}

/// The class of a card's number as items call it; in_hand for elements of any class and for sets.
ItemClass class_of(Referred referred) {
  switch (referred) {
    case Referred::node: return ItemClass::node;
    case Referred::shell: return ItemClass::shell;
    case Referred::beam: return ItemClass::beam;
    case Referred::solid: return ItemClass::solid;
    case Referred::tshell: return ItemClass::tshell;
    case Referred::discrete: return ItemClass::discrete;
    case Referred::mass: return ItemClass::mass;
    case Referred::sph: return ItemClass::sph;
    case Referred::other: return ItemClass::other;
    case Referred::part: return ItemClass::part;
    default: return ItemClass::in_hand;
  }
}

/// The kind of set that an item's class names; nothing where it can be any kind.
std::optional<Referred> wanted_kind(ItemClass item_class) {
  switch (item_class) {
    case ItemClass::node_set: return Referred::node_set;
    case ItemClass::shell_set: return Referred::shell_set;
    case ItemClass::beam_set: return Referred::beam_set;
    case ItemClass::solid_set: return Referred::solid_set;
    case ItemClass::tshell_set: return Referred::tshell_set;
    case ItemClass::discrete_set: return Referred::discrete_set;
    case ItemClass::part_set: return Referred::part_set;
    case ItemClass::segment_set: return Referred::segment_set;
    case ItemClass::element_set: return Referred::element_set;
    default: return std::nullopt;
  }
}

void combine(Marks& into, const Marks& other, Step::Action action) {
  std::uint8_t* a = into.data();
  const std::uint8_t* b = other.data();
  const std::size_t count = into.size();
  if (action == Step::Action::add)
    for (std::size_t i = 0; i < count; ++i) a[i] = static_cast<std::uint8_t>(a[i] | b[i]);
  else if (action == Step::Action::take)
    for (std::size_t i = 0; i < count; ++i) a[i] = static_cast<std::uint8_t>(a[i] & (b[i] ^ 1));
  else
    for (std::size_t i = 0; i < count; ++i) a[i] = static_cast<std::uint8_t>(a[i] & b[i]);
}

/// Executes an expression's steps on marks.
class Evaluator {
 public:
  Evaluator(const Model& model, EntityKind kind, const Names& names, const Progress& progress)
      : model_(model), names_(names), progress_(progress), marking_(model, kind) {}

  Result<Chosen> run(const Parsed& parsed) {
    for (std::size_t i = 0; i < parsed.steps.size(); ++i) {
      if (i > 0 && i % kStepsBetweenReports == 0 && progress_ &&
          !progress_(static_cast<double>(i) / static_cast<double>(parsed.steps.size())))
        return fail(cancelled());
      if (const Result<void> done = take(parsed.steps[i], parsed); !done) return fail(done.error());
    }
    Chosen chosen = marking_.chosen(stack_.back());
    chosen.of_surfaces = of_surfaces_;
    return chosen;
  }

 private:
  Result<void> take(const Step& step, const Parsed& parsed) {
    using Action = Step::Action;
    switch (step.action) {
      case Action::nothing: stack_.push_back(marking_.nothing()); return {};
      case Action::everything: stack_.push_back(marking_.everything()); return {};
      case Action::push: stack_.push_back(marking_.nothing()); return mark_item(parsed.items[step.item], stack_.back(), 1);
      case Action::add_item: return mark_item(parsed.items[step.item], stack_.back(), 1);
      case Action::take_item: return mark_item(parsed.items[step.item], stack_.back(), 0);
      case Action::add:
      case Action::take:
      case Action::meet:
        combine(stack_[stack_.size() - 2], stack_.back(), step.action);
        stack_.pop_back();
        return {};
      case Action::complement: {
        Marks others = marking_.everything();
        combine(others, stack_.back(), Action::take);
        stack_.back() = std::move(others);
        return {};
      }
    }
    return {};
  }

  static tl::unexpected<Error> error(const Item& item, std::string message) {
    return fail("expression", static_cast<long>(item.column), std::move(message));
  }

  Result<void> mark_item(const Item& item, Marks& marks, std::uint8_t value) {
    const ItemClass item_class = item.item_class == ItemClass::in_hand ? class_of(marking_.kind()) : item.item_class;
    if (is_set(item_class)) return mark_sets(item, marks, value);
    if (item_class != ItemClass::file)
      of_surfaces_ = of_surfaces_ && (item_class == ItemClass::shell || item_class == ItemClass::quad || item_class == ItemClass::tri ||
                                      item_class == ItemClass::part);
    if (item_class == ItemClass::file) return mark_file(item, marks, value);
    if (item.by == Item::By::name) return mark_parts_called(item, marks, value);
    if (block_class(item_class) && marking_.kind() == EntityKind::element)
      return error(item, "only shells can be selected as elements; select " + std::string(name(item_class)) + " nodes with kind node");
    const IdIndex& ids = marking_.ids_of(item_class);
    if (ids.size() == 0) return error(item, "there is no " + std::string(name(item_class)) + " in the model");
    const auto [min_id, max_id] = std::pair(ids.at(0).first, ids.at(ids.size() - 1).first);
    if (Result<void> counted = count_named(item, ids); !counted) return counted;
    bool found = false;
    if (item.by == Item::By::all) {
      found = marking_.mark_ids(marks, item_class, {min_id, max_id}, value);
    } else if (item.by == Item::By::other_ids) {
      if (item.first > min_id) found = marking_.mark_ids(marks, item_class, {min_id, item.first - 1}, value);
      if (item.first < max_id) found = marking_.mark_ids(marks, item_class, {item.first + 1, max_id}, value) || found;
    } else {
      found = marking_.mark_ids(marks, item_class, {item.first, item.last, item.step}, value);
    }
    if (!found) return names_nothing(item, item_class, ids);
    return {};
  }

  /// Limits the cost, which follows what an item names: a range over everything is short to write, also a million times.
  Result<void> count_named(const Item& item, const IdIndex& ids) {
    const bool some = item.by == Item::By::ids || item.by == Item::By::comparison;
    named_ += some ? ids.lower_bound(std::max(item.first, item.last)) - ids.lower_bound(item.first) + 1 : ids.size();
    if (named_ <= kMaxTimesNamed * std::max<std::uint64_t>(ids.size(), kFewIds)) return {};
    return error(item,
                 "the items up to here name the whole model more than " + std::to_string(kMaxTimesNamed) + " times; name each entity once");
  }

  static tl::unexpected<Error> names_nothing(const Item& item, ItemClass item_class, const IdIndex& ids) {
    const bool single = item.first == item.last;
    std::string message;
    if (item.by == Item::By::comparison || item.by == Item::By::other_ids) {
      message = "no " + std::string(name(item_class)) + " has such an id";
    } else {
      message = single ? "there is no " : "no ";
      message += name(item_class);
      message += single ? " " : " lies in ";
      message += std::to_string(item.first);
      if (!single) message += '-' + std::to_string(item.last);
      if (item.step > 1) message += ':' + std::to_string(item.step);
    }
    message += "; the nearest is ";
    message += name(item_class);
    message += ':' + std::to_string(nearest_id(ids, item));
    return error(item, std::move(message));
  }

  /// The existing id nearest to the item's ids; of two the lower.
  static std::int64_t nearest_id(const IdIndex& ids, const Item& item) {
    const std::size_t above = ids.lower_bound(item.first);
    if (above == ids.size()) return ids.at(above - 1).first;
    const std::int64_t high = ids.at(above).first;
    if (above == 0 || high <= item.last) return high;
    const std::int64_t low = ids.at(above - 1).first;
    // ids may be negative in some decks: unsigned differences can't overflow
    const auto below = static_cast<std::uint64_t>(item.first) - static_cast<std::uint64_t>(low);
    const auto over = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(item.last);
    return below <= over ? low : high;
  }

  Result<void> mark_parts_called(const Item& item, Marks& marks, std::uint8_t value) {
    const std::vector<PartIndex> found = parts_called(*model_.parts, item.name);
    if (found.empty()) return error(item, no_part_called(*model_.parts, item.name));
    for (const PartIndex part : found) marking_.mark(marks, ItemClass::part, part.value, value);
    return {};
  }

  // --- sets ----------------------------------------------------------------------------------------------------------

  const std::vector<NamedSet>& sets() {
    if (!sets_) sets_ = names_.references != nullptr ? find_sets(*names_.references) : std::vector<NamedSet>();
    return *sets_;
  }

  Result<void> mark_sets(const Item& item, Marks& marks, std::uint8_t value) {
    WantedSet wanted{wanted_kind(item.item_class), set_of(marking_.kind()), 0, item.name};
    const bool single = item.by == Item::By::ids && item.first == item.last;
    if (single && item.first == 0) return error(item, "sets are numbered from 1");
    if (single) wanted.id = item.first;
    if (single || item.by == Item::By::name) {
      const Result<bool> marked = mark_wanted(item, wanted, marks, value);
      if (!marked) return fail(marked.error());
      if (!*marked) return error(item, find_set(sets(), wanted).set->label() + " holds nothing that can be selected here");
      return {};
    }
    // several sets: each id once; of several kinds with one id the preferred one
    std::int64_t before = 0;
    bool found = false;
    std::vector<std::int64_t> ids;
    for (const NamedSet& set : sets())
      if (set.id > 0 && (!wanted.kind || set.kind == *wanted.kind) && is_among(item, set.id)) ids.push_back(set.id);
    std::sort(ids.begin(), ids.end());
    for (const std::int64_t id : ids) {
      if (id == before) continue;
      before = wanted.id = id;
      const Result<bool> marked = mark_wanted(item, wanted, marks, value);
      if (!marked) return fail(marked.error());
      found = found || *marked;
    }
    if (found) return {};
    if (item.by == Item::By::ids && ids.empty()) {
      wanted.id = std::max<std::int64_t>(item.first, 1);
      return error(item, find_set(sets(), wanted).problem);
    }
    return error(item, ids.empty() ? "no set has such an id" : "these sets hold nothing that can be selected here");
  }

  static bool is_among(const Item& item, std::int64_t id) {
    if (item.by == Item::By::all) return true;
    if (item.by == Item::By::other_ids) return id != item.first;
    return item.first <= id && id <= item.last && (item.step <= 1 || (id - item.first) % item.step == 0);
  }

  /// False: the set holds nothing.
  Result<bool> mark_wanted(const Item& item, const WantedSet& wanted, Marks& marks, std::uint8_t value) {
    const FoundSet found = find_set(sets(), wanted);
    if (found.set == nullptr) return error(item, found.problem);
    Result<Marks> members = marks_of(item, *found.set, 0);
    if (!members) return fail(members.error());
    combine(marks, *members, value != 0 ? Step::Action::add : Step::Action::take);
    return std::find(members->begin(), members->end(), 1) != members->end();
  }

  Result<Marks> marks_of(const Item& item, const NamedSet& set, int depth) {
    if (depth > kMaxSetDepth) return error(item, set.label() + " contains itself, or contains sets nested deeper than 32 levels");
    if (++sets_seen_ > kMaxSets) return error(item, set.label() + " contains too many sets");
    of_surfaces_ = of_surfaces_ && (set.kind == Referred::shell_set || set.kind == Referred::part_set);
    Marks marks = marking_.nothing();
    bool first = true;
    // a set that names both nodes and elements means one of them: the wanted kind decides
    const auto named = [&](Referred referred) {
      return std::any_of(set.members.begin(), set.members.end(), [&](const Reference& m) { return m.referred == referred; });
    };
    const bool both = set.kind == Referred::node_set && named(Referred::node) && named(Referred::any_element);
    for (const Reference& member : set.members) {
      if (both && (member.referred == Referred::any_element) != (marking_.kind() == EntityKind::element)) continue;
      if (!mesh::is_set(member.referred)) {
        mark_member(member, marks);
        continue;
      }
      for (const NamedSet* inner : sets_named(member)) {
        Result<Marks> of_inner = marks_of(item, *inner, depth + 1);
        if (!of_inner) return of_inner;
        const Step::Action action = member.takes_away          ? Step::Action::take
                                    : set.intersects && !first ? Step::Action::meet
                                                               : Step::Action::add;
        combine(marks, *of_inner, action);
        first = false;
      }
    }
    return marks;
  }

  std::vector<const NamedSet*> sets_named(const Reference& member) {
    std::vector<const NamedSet*> out;
    const std::vector<NamedSet>& all = sets();
    auto set = std::lower_bound(all.begin(), all.end(), std::pair(member.referred, member.first),
                                [](const NamedSet& s, const auto& key) { return std::pair(s.kind, s.id) < key; });
    for (; set != all.end() && set->kind == member.referred && set->id <= member.last; ++set)
      if (member.names(set->id)) out.push_back(&*set);
    return out;
  }

  void mark_member(const Reference& member, Marks& marks) {
    const std::uint8_t value = member.takes_away ? 0 : 1;
    const ItemClass entity = class_of(member.referred);
    if (entity != ItemClass::in_hand) {
      const ShellKind shells = names_.references->referrers()[member.referrer].shells;
      marking_.mark_ids(marks, entity, {member.first, member.last, member.step}, value, shells);
      return;
    }
    for (const ItemClass each : {ItemClass::shell, ItemClass::beam, ItemClass::solid, ItemClass::tshell, ItemClass::discrete,
                                 ItemClass::mass, ItemClass::sph, ItemClass::other})
      marking_.mark_ids(marks, each, {member.first, member.last, member.step}, value);
  }

  // --- files ---------------------------------------------------------------------------------------------------------

  Result<void> mark_file(const Item& item, Marks& marks, std::uint8_t value) {
    std::string problem;
    const std::optional<std::uint32_t> file = find_file(names_.files, item.name, problem);
    if (!file) return error(item, std::move(problem));
    bool found = false;
    const auto mark = [&](ItemClass entity, std::size_t index) {
      found = true;
      marking_.mark(marks, entity, static_cast<std::uint32_t>(index), value);
    };
    if (names_.file_of_shell)
      for (std::size_t s = 0; s < model_.shell_count(); ++s)
        if (names_.file_of_shell(deck_ancestor(model_, ShellIndex(s))) == *file && !model_.is_removed(ShellIndex(s)))
          mark(ItemClass::shell, s);
    if (marking_.kind() == EntityKind::node && names_.file_of_node)
      for (std::size_t n = 0; n < model_.node_count(); ++n)
        if (names_.file_of_node(first_ancestor(NodeIndex(n))) == *file && !model_.is_removed(NodeIndex(n))) mark(ItemClass::node, n);
    if (marking_.kind() == EntityKind::part) mark_lone_parts(*file, mark);
    if (found) return {};
    const std::string_view what = marking_.kind() == EntityKind::node      ? "node"
                                  : marking_.kind() == EntityKind::element ? "shell"
                                                                           : "part's mesh";
    return error(item, "no " + std::string(what) + " is in the file \"" + names_.files[*file] + "\"");
  }

  /// The first node of the deck that a node comes from.
  NodeIndex first_ancestor(NodeIndex node) const {
    while (is_added(model_, node)) node = origin_of(model_, node).parent[0];
    return node;
  }

  /// A part without shells is in the file that holds all nodes of one of its elements.
  template <class Mark>
  void mark_lone_parts(std::uint32_t file, const Mark& mark) {
    if (!names_.file_of_node) return;
    std::vector<std::uint8_t> has_shells(model_.parts->size(), 0);
    for (std::size_t s = 0; s < model_.shell_count(); ++s)
      if (const PartIndex part = model_.shell_parts[s]; part.valid()) has_shells[part.value] = 1;
    for (const auto& block : model_.elements) {
      if (!block) continue;
      for (std::size_t e = 0; e < block->size(); ++e) {
        const PartIndex part = block->part[e];
        if (!part.valid() || has_shells[part.value] != 0) continue;
        const auto stands_there = [&](NodeIndex node) { return node.valid() && names_.file_of_node(node) == file; };
        const auto first = block->nodes.begin() + block->first_node[e], last = block->nodes.begin() + block->first_node[e + 1];
        if (first != last && std::all_of(first, last, stands_there)) mark(ItemClass::part, part.value);
      }
    }
  }

  const Model& model_;
  const Names& names_;
  const Progress& progress_;
  std::uint64_t named_ = 0;  ///< ids that the items so far named, repeated ones too
  Marking marking_;
  std::vector<Marks> stack_;
  std::optional<std::vector<NamedSet>> sets_;
  int sets_seen_ = 0;
  bool of_surfaces_ = true;
};

}  // namespace

Result<Chosen> evaluate(const Model& model, std::string_view expression, EntityKind kind, const Names& names, const Progress& progress) {
  const Result<Parsed> parsed = parse(expression);
  if (!parsed) return fail(parsed.error());
  return Evaluator(model, kind, names, progress).run(*parsed);
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
