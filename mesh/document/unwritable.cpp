#include "mesh/document/unwritable.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <unordered_map>
#include <utility>

#include "base/counted.h"
#include "mesh/deck/editing/text_place.h"
#include "mesh/document/restructure.h"

namespace prismesh::mesh::document {

namespace {

constexpr int kMaxTrials = 400;
constexpr int kFineSearches = 2;  ///< searches that look for single shells

/// Numbers the groups of a change: entities that share a node belong to one group.
class Groups {
 public:
  Groups(const Model& model, const repair::Restructuring& change) : model_(model), change_(change) {
    for (std::size_t i = 0; i < change.new_nodes.size(); ++i) {
      const NodeOrigin& origin = change.new_nodes[i].origin;
      for (int p = 0; p < origin.count(); ++p) join(new_node(i), origin.parent[static_cast<std::size_t>(p)]);
    }
    for (const repair::NewShell& shell : change.new_shells) {
      join_corners(shell.nodes);
      join(shell.nodes.node[0], model.shell(shell.parent).node[0]);
      join_corners(model.shell(shell.parent));
    }
    for (const auto& [shell, nodes] : change.reshaped) {
      join_corners(nodes);
      join(nodes.node[0], model.shell(shell).node[0]);
      join_corners(model.shell(shell));
    }
    for (const ShellIndex shell : change.removed_shells) join_corners(model.shell(shell));
  }

  NodeIndex new_node(std::size_t i) const { return NodeIndex(model_.node_count() + i); }
  std::uint32_t of(NodeIndex node) { return root(node.value); }
  std::uint32_t of_shell(ShellIndex shell) { return of(model_.shell(shell).node[0]); }

  /// One node of each group, ascending.
  std::vector<std::uint32_t> all() {
    std::vector<std::uint32_t> groups;
    for (const auto& shell : change_.new_shells) groups.push_back(of_shell(shell.parent));
    for (const auto& shell : change_.reshaped) groups.push_back(of_shell(shell.first));
    for (const ShellIndex shell : change_.removed_shells) groups.push_back(of_shell(shell));
    std::sort(groups.begin(), groups.end());
    groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
    return groups;
  }

 private:
  std::uint32_t root(std::uint32_t node) {
    std::uint32_t at = node;
    for (auto up = up_.find(at); up != up_.end(); up = up_.find(at)) at = up->second;
    while (node != at) node = std::exchange(up_[node], at);
    return at;
  }
  /// The lower one stands for both, so that the numbers don't depend on the order.
  void join(NodeIndex a, NodeIndex b) {
    const std::uint32_t one = root(a.value), other = root(b.value);
    if (one != other) up_[std::max(one, other)] = std::min(one, other);
  }
  void join_corners(const ShellNodes& nodes) {
    for (const NodeIndex node : nodes.node) join(nodes.node[0], node);
  }

  const Model& model_;
  const repair::Restructuring& change_;
  std::unordered_map<std::uint32_t, std::uint32_t> up_;
};

/// What of a change is wanted.
struct Wanted {
  std::function<bool(std::size_t)> new_node;  ///< by its number in the change
  std::function<bool(ShellIndex)> shell;      ///< a shell of the model, with all that becomes of it
  std::function<bool(NodeIndex)> removed_node;
};

/// The wanted part of a change, without nodes that only move.
repair::Restructuring part_of(const Model& model, const repair::Restructuring& change, const Wanted& wanted) {
  repair::Restructuring part;
  std::vector<NodeIndex> now(change.new_nodes.size());
  const auto renamed = [&](NodeIndex& node) {
    if (node.valid() && node.value >= model.node_count()) node = now[node.value - model.node_count()];
  };
  for (std::size_t i = 0; i < change.new_nodes.size(); ++i) {
    if (!wanted.new_node(i)) continue;
    now[i] = NodeIndex(model.node_count() + part.new_nodes.size());
    part.new_nodes.push_back(change.new_nodes[i]);
    for (NodeIndex& parent : part.new_nodes.back().origin.parent) renamed(parent);
  }
  for (repair::NewShell shell : change.new_shells) {
    if (!wanted.shell(shell.parent)) continue;
    for (NodeIndex& node : shell.nodes.node) renamed(node);
    part.new_shells.push_back(shell);
  }
  for (auto [shell, nodes] : change.reshaped) {
    if (!wanted.shell(shell)) continue;
    for (NodeIndex& node : nodes.node) renamed(node);
    part.reshaped.emplace_back(shell, nodes);
  }
  for (const ShellIndex shell : change.removed_shells)
    if (wanted.shell(shell)) part.removed_shells.push_back(shell);
  for (const NodeIndex node : change.removed_nodes)
    if (wanted.removed_node(node)) part.removed_nodes.push_back(node);
  return part;
}

repair::Restructuring part_of_groups(const Model& model, const repair::Restructuring& change, Groups& groups,
                                     std::span<const std::uint32_t> wanted) {
  const auto is_wanted = [&](std::uint32_t group) { return std::binary_search(wanted.begin(), wanted.end(), group); };
  return part_of(
      model, change,
      {[&](std::size_t i) { return is_wanted(groups.of(groups.new_node(i))); },
       [&](ShellIndex shell) { return is_wanted(groups.of_shell(shell)); }, [&](NodeIndex node) { return is_wanted(groups.of(node)); }});
}

/// The shells of a change, each with all that becomes of it; no node is removed. The part isn't a mesh that holds together, but what
/// prevents saving a single shell prevents saving the part.
repair::Restructuring part_of_shells(const Model& model, const repair::Restructuring& change, std::span<const std::uint32_t> shells) {
  const auto is_wanted = [&](ShellIndex shell) { return std::binary_search(shells.begin(), shells.end(), shell.value); };
  std::vector<bool> needed(change.new_nodes.size(), false);
  const auto need = [&](NodeIndex node) {
    if (node.valid() && node.value >= model.node_count()) needed[node.value - model.node_count()] = true;
  };
  for (const repair::NewShell& shell : change.new_shells)
    if (is_wanted(shell.parent)) std::for_each(shell.nodes.node.begin(), shell.nodes.node.end(), need);
  for (const auto& [shell, nodes] : change.reshaped)
    if (is_wanted(shell)) std::for_each(nodes.node.begin(), nodes.node.end(), need);
  // A new node comes from earlier ones.
  for (std::size_t i = change.new_nodes.size(); i-- > 0;)
    if (needed[i]) std::for_each(change.new_nodes[i].origin.parent.begin(), change.new_nodes[i].origin.parent.end(), need);
  return part_of(model, change, {[&](std::size_t i) { return needed[i]; }, is_wanted, [](NodeIndex) { return false; }});
}

/// The shells of the model that a change touches, ascending.
std::vector<std::uint32_t> shells_of(const repair::Restructuring& change) {
  std::vector<std::uint32_t> shells;
  for (const auto& shell : change.new_shells) shells.push_back(shell.parent.value);
  for (const auto& shell : change.reshaped) shells.push_back(shell.first.value);
  for (const ShellIndex shell : change.removed_shells) shells.push_back(shell.value);
  std::sort(shells.begin(), shells.end());
  shells.erase(std::unique(shells.begin(), shells.end()), shells.end());
  return shells;
}

/// The rule that forbids what a change does to its only shell.
std::uint8_t rule_against(const Model& model, const repair::Restructuring& change, ShellIndex shell) {
  const bool was_triangle = model.shell(shell).is_triangle();
  const auto changes_kind = [&](const ShellNodes& nodes) { return nodes.is_triangle() != was_triangle; };
  for (const repair::NewShell& piece : change.new_shells)
    if (changes_kind(piece.nodes)) return repair::kNoTriangle;
  for (const auto& [reshaped, nodes] : change.reshaped)
    if (changes_kind(nodes)) return repair::kNoTriangle;
  if (!change.removed_shells.empty()) return repair::kLasting;
  return change.new_shells.empty() ? repair::kKeepsNodes : repair::kIndivisible;
}

class Search {
 public:
  Search(const Document& document, const Model& model, const repair::Restructuring& change, Frozen& frozen, const Progress& progress)
      : document_(document), model_(model), change_(change), groups_(model, change), frozen_(frozen), progress_(progress) {}

  Result<std::size_t> run() {
    ++frozen_.searches;
    const std::vector<std::uint32_t> all = groups_.all();
    look(
        all, {}, [&](Units units) { return part_of_groups(model_, change_, groups_, units); },
        [&](std::uint32_t group, const std::string& why) { freeze_group(group, why); });
    if (stopped_) return fail(cancelled());
    return found_;
  }

 private:
  using Units = std::span<const std::uint32_t>;  ///< ascending
  using PartOf = std::function<repair::Restructuring(Units)>;
  using Find = std::function<void(std::uint32_t, const std::string&)>;

  bool is_over() const { return stopped_ || trials_ > kMaxTrials; }
  /// Why these units can't be written; nothing: they can, or the search is over.
  std::optional<std::string> refusal(Units units, const PartOf& part_of_units) {
    if (units.empty() || stopped_ || ++trials_ > kMaxTrials) return std::nullopt;
    const auto words = [] { return std::string("finding what the deck can't hold"); };
    stopped_ = progress_ && !progress_(static_cast<double>(trials_ - 1) / kMaxTrials, words);
    if (stopped_) return std::nullopt;
    Model trial = model_;
    const Result<void> possible = carry_out(document_, part_of_units(units), trial);
    if (possible) return std::nullopt;
    return deck::reason_of(possible.error());
  }

  /// Reports the units that can't be written, alone or with those before them. `known`: why all of them together can't, if that is known.
  /// Returns whether there are any.
  bool look(Units units, const std::optional<std::string>& known, const PartOf& part_of_units, const Find& report) {
    const std::optional<std::string> why = known ? known : refusal(units, part_of_units);
    if (!why) return false;
    if (units.size() == 1) {
      report(units[0], *why);
      return true;
    }
    const std::size_t half = units.size() / 2;
    const bool in_first = look(units.first(half), {}, part_of_units, report);
    const bool in_second = look(units.subspan(half), {}, part_of_units, report);
    return in_first || in_second || look_together(units, half, *why, part_of_units, report);
  }
  /// The first `fine` units can be written, and all of them can't: reports the first one that can't be written with those before it.
  bool look_together(Units units, std::size_t fine, std::string why, const PartOf& part_of_units, const Find& report) {
    if (is_over()) return false;
    std::size_t refused = units.size();
    while (refused - fine > 1) {
      const std::size_t middle = fine + (refused - fine) / 2;
      std::optional<std::string> reason = refusal(units.first(middle), part_of_units);
      if (is_over()) return false;
      (reason ? refused : fine) = middle;
      if (reason) why = std::move(*reason);
    }
    report(units[refused - 1], why);
    return true;
  }

  void freeze_group(std::uint32_t group, const std::string& why) {
    const repair::Restructuring part = part_of_groups(model_, change_, groups_, Units(&group, 1));
    const std::vector<std::uint32_t> shells = shells_of(part);
    const auto part_of_units = [&](Units units) { return part_of_shells(model_, part, units); };
    const auto freeze_one = [&](std::uint32_t shell, const std::string& reason) {
      freeze_shell(ShellIndex(shell), rule_against(model_, part_of_units(Units(&shell, 1)), ShellIndex(shell)), reason);
    };
    const auto known = shells.size() == 1 ? std::optional(why) : std::nullopt;
    if (frozen_.searches <= kFineSearches && look(shells, known, part_of_units, freeze_one)) return;
    if (stopped_) return;
    ++found_;
    for (const std::uint32_t shell : shells) frozen_.shells[ShellIndex(shell)] = {repair::kStaysAsItIs, why};
    for (const NodeIndex node : part.removed_nodes) frozen_.nodes.emplace(node, why);
  }
  void freeze_shell(ShellIndex shell, std::uint8_t rules, const std::string& why) {
    ++found_;
    const auto [known, is_new] = frozen_.shells.try_emplace(shell, FrozenShell{rules, why});
    if (!is_new) known->second = {repair::kStaysAsItIs, why};
  }

  const Document& document_;
  const Model& model_;
  const repair::Restructuring& change_;
  Groups groups_;
  Frozen& frozen_;
  const Progress& progress_;
  int trials_ = 0;
  bool stopped_ = false;
  std::size_t found_ = 0;
};

}  // namespace

Result<std::size_t> find_unwritable(const Document& document, const Model& model, const repair::Restructuring& change, Frozen& frozen,
                                    const Progress& progress) {
  return Search(document, model, change, frozen, progress).run();
}

repair::Rules with_frozen(const repair::Rules& rules, const Frozen& frozen) {
  repair::Rules out = rules;
  out.node = [ask = rules.node, &frozen](NodeIndex node) {
    return static_cast<std::uint8_t>(ask(node) | (frozen.nodes.contains(node) ? repair::kNeeded : 0));
  };
  out.shell = [ask = rules.shell, &frozen](ShellIndex shell) {
    const auto known = frozen.shells.find(shell);
    return static_cast<std::uint8_t>(ask(shell) | (known == frozen.shells.end() ? 0 : known->second.rules));
  };
  return out;
}

std::vector<std::string> notes_of(const Frozen& frozen) {
  std::vector<std::string> notes;
  for (const bool whole : {true, false}) {
    const std::string* why = nullptr;
    std::size_t count = 0;
    for (const auto& [shell, held] : frozen.shells) {
      if ((held.rules == repair::kStaysAsItIs) != whole) continue;
      ++count;
      if (why == nullptr) why = &held.why;
    }
    if (why == nullptr) continue;
    const std::string what = whole ? " left as they are" : " not divided or reshaped as needed";
    notes.push_back(counted(count, "element") + what + ", since the deck can't be written otherwise: " + *why);
  }
  return notes;
}

}  // namespace prismesh::mesh::document
