#include "mesh/document/unwritable.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "mesh/document/restructure.h"

namespace prismesh::mesh::document {

namespace {

constexpr int kMaxTrials = 400;

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

/// The part of a change that belongs to some groups, without nodes that only move.
repair::Restructuring part_of(const Model& model, const repair::Restructuring& change, Groups& groups,
                              std::span<const std::uint32_t> wanted) {
  const auto is_wanted = [&](std::uint32_t group) { return std::binary_search(wanted.begin(), wanted.end(), group); };
  repair::Restructuring part;
  std::vector<NodeIndex> now(change.new_nodes.size());
  const auto renamed = [&](NodeIndex& node) {
    if (node.valid() && node.value >= model.node_count()) node = now[node.value - model.node_count()];
  };
  for (std::size_t i = 0; i < change.new_nodes.size(); ++i) {
    if (!is_wanted(groups.of(groups.new_node(i)))) continue;
    now[i] = NodeIndex(model.node_count() + part.new_nodes.size());
    part.new_nodes.push_back(change.new_nodes[i]);
    for (NodeIndex& parent : part.new_nodes.back().origin.parent) renamed(parent);
  }
  for (repair::NewShell shell : change.new_shells) {
    if (!is_wanted(groups.of_shell(shell.parent))) continue;
    for (NodeIndex& node : shell.nodes.node) renamed(node);
    part.new_shells.push_back(shell);
  }
  for (auto [shell, nodes] : change.reshaped) {
    if (!is_wanted(groups.of_shell(shell))) continue;
    for (NodeIndex& node : nodes.node) renamed(node);
    part.reshaped.emplace_back(shell, nodes);
  }
  for (const ShellIndex shell : change.removed_shells)
    if (is_wanted(groups.of_shell(shell))) part.removed_shells.push_back(shell);
  for (const NodeIndex node : change.removed_nodes)
    if (is_wanted(groups.of(node))) part.removed_nodes.push_back(node);
  return part;
}

class Search {
 public:
  Search(const Document& document, const Model& model, const repair::Restructuring& change, Frozen& frozen, const Progress& progress)
      : document_(document), model_(model), change_(change), groups_(model, change), frozen_(frozen), progress_(progress) {}

  Result<std::size_t> run() {
    const std::vector<std::uint32_t> all = groups_.all();
    look(all);
    if (stopped_) return fail(cancelled());
    return found_;
  }

 private:
  void look(std::span<const std::uint32_t> groups) {
    if (groups.empty() || stopped_ || ++trials_ > kMaxTrials) return;
    stopped_ = progress_ && !progress_(static_cast<double>(trials_ - 1) / kMaxTrials);
    if (stopped_) return;
    const repair::Restructuring part = part_of(model_, change_, groups_, groups);
    Model trial = model_;
    const Result<void> possible = carry_out(document_, part, trial);
    if (possible) return;
    if (groups.size() == 1) return freeze(part, possible.error().text());
    look(groups.first(groups.size() / 2));
    look(groups.subspan(groups.size() / 2));
  }
  void freeze(const repair::Restructuring& part, const std::string& why) {
    ++found_;
    for (const repair::NewShell& shell : part.new_shells) frozen_.shells.emplace(shell.parent, why);
    for (const auto& [shell, nodes] : part.reshaped) frozen_.shells.emplace(shell, why);
    for (const ShellIndex shell : part.removed_shells) frozen_.shells.emplace(shell, why);
    for (const NodeIndex node : part.removed_nodes) frozen_.nodes.emplace(node, why);
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
    constexpr int kAll = repair::kKeepsNodes | repair::kIndivisible | repair::kLasting | repair::kNoTriangle;
    return static_cast<std::uint8_t>(ask(shell) | (frozen.shells.contains(shell) ? kAll : 0));
  };
  return out;
}

}  // namespace prismesh::mesh::document
