#include <algorithm>
#include <memory>
#include <mutex>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "mesh/deck/editing/ancestors.h"
#include "mesh/deck/editing/edit_checks.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/restructure.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::document {

namespace {

constexpr std::uint8_t kAllNodeRules = repair::kStays | repair::kNeeded;
constexpr std::uint8_t kAllShellRules = repair::kKeepsNodes | repair::kIndivisible | repair::kLasting | repair::kNoTriangle;

/// Answers the rules' questions, on any thread; each is computed once.
class Rulebook {
 public:
  Rulebook(const Document& document, const Generation& generation)
      : deck_(*document.deck),
        generation_(generation),
        deletion_(*document.deck),
        division_(*document.deck),
        kind_(*document.deck, document.opened->model) {
    for (const NodeOnSheet& each : generation.relations->dependents.on_sheets)
      (each.tied ? tied_shells_ : welded_shells_).push_back(each.shell);
    sort_unique(welded_shells_);
    sort_unique(tied_shells_);
    if (generation.model.midside)
      for (const MidsideNodes& midside : *generation.model.midside) {
        middled_shells_.push_back(midside.shell);
        for (const NodeIndex node : midside.node)
          if (node.valid()) middle_nodes_.push_back(node);
      }
    sort_unique(middle_nodes_);
  }

  std::uint8_t node(NodeIndex node) {
    const std::scoped_lock lock(mutex_);
    const auto [known, is_new] = nodes_.try_emplace(node, std::uint8_t{0});
    if (is_new) known->second = find_node(node);
    return known->second;
  }
  std::uint8_t shell(ShellIndex shell) {
    const std::scoped_lock lock(mutex_);
    const auto [known, is_new] = shells_.try_emplace(shell, std::uint8_t{0});
    if (is_new) known->second = find_shell(shell);
    return known->second;
  }
  bool may_divide(NodeIndex a, NodeIndex b) {
    if (of_held_file(a) && of_held_file(b)) return false;
    if (!may_be_between(a, b)) return false;
    const auto of_a = uses_of(a), of_b = uses_of(b);
    return std::none_of(of_a.begin(), of_a.end(), [&](const ElementUse& use) {
      return std::any_of(of_b.begin(), of_b.end(),
                         [&](const ElementUse& other) { return use.element_class == other.element_class && use.element == other.element; });
    });
  }
  bool may_exchange(ShellIndex a, ShellIndex b) { return !deck_.references || sets_of(a) == sets_of(b); }

 private:
  /// A set by its id, else by its name, else as a card by itself. Groups of quads and of triangles that have one id are one set.
  using SetKey = std::tuple<std::int64_t, std::string, std::uint32_t>;
  const std::vector<SetKey>& sets_of(ShellIndex shell) {
    const std::scoped_lock lock(mutex_);
    const auto [known, is_new] = sets_.try_emplace(shell);
    if (is_new) known->second = find_sets(shell);
    return known->second;
  }
  std::vector<SetKey> find_sets(ShellIndex shell) const {
    std::vector<SetKey> sets;
    const std::int64_t id = model().shell_ids[deck_ancestor(model(), shell).value];
    for (const Reference& reference : deck_.references->naming(Referred::shell, id)) {
      if (reference.takes_away || (reference.role != ReferenceRole::list && reference.role != ReferenceRole::range)) continue;
      const Referrer& card = deck_.references->referrers()[reference.referrer];
      const bool is_alone = card.id == 0 && card.group.empty();
      sets.emplace_back(card.id, card.group, is_alone ? reference.referrer : 0U);
    }
    sort_unique(sets);
    return sets;
  }

  template <class Value>
  static void sort_unique(std::vector<Value>& set) {
    std::sort(set.begin(), set.end());
    set.erase(std::unique(set.begin(), set.end()), set.end());
  }
  template <class IndexType>
  static bool contains(const std::vector<IndexType>& set, IndexType index) {
    return std::binary_search(set.begin(), set.end(), index);
  }
  const Model& model() const { return generation_.model; }

  /// Added nodes have cards of their own in files that may be written to.
  bool of_held_file(NodeIndex node) const {
    return node.value < deck_.node_line.size() && !deck_.node_runs.empty() && deck_.is_held(deck_.run_of(node).file);
  }
  std::span<const ElementUse> uses_of(NodeIndex node) const { return uses_at(*generation_.relations, node); }
  bool may_be_deleted(Referred referred, std::int64_t id) {
    return !deck_.references || deletion_.may_be_deleted(referred, id).has_value();
  }
  bool may_be_between(NodeIndex a, NodeIndex b) {
    if (!deck_.references || deck_.references->unread().empty()) return true;
    std::vector<std::int64_t> ids;
    for (const NodeIndex end : {a, b})
      for (const NodeIndex of_deck : deck::deck_ancestors(model(), end)) ids.push_back(model().node_ids[of_deck.value]);
    const std::scoped_lock lock(mutex_);
    return division_.may_be_between(ids).has_value();
  }
  bool may_be_divided(ShellIndex shell) {
    return !deck_.references || division_.may_be_divided(model().shell_ids[deck_ancestor(model(), shell).value]).has_value();
  }
  bool may_change_kind(ShellIndex shell) {
    return !deck_.references || deck_.shell_runs.empty() || kind_.may_change_kind(deck_ancestor(model(), shell)).has_value();
  }
  bool is_middled(ShellIndex shell) const { return contains(middled_shells_, shell); }

  std::uint8_t find_node(NodeIndex node) {
    if (node.value >= model().node_count()) return 0;
    if ((generation_.node_marks[node.value] & kLocked) != 0 || model().node_holds[node.value] != 0 || !uses_of(node).empty() ||
        is_joined(*generation_.relations, node) || contains(middle_nodes_, node))
      return kAllNodeRules;
    for (const ShellIndex shell : model().adjacency->shells_of(node))
      if (is_middled(shell)) return kAllNodeRules;
    if (!hidden_at(*generation_.relations, node).empty()) return repair::kNeeded;
    return may_be_deleted(Referred::node, model().node_ids[node.value]) ? std::uint8_t{0} : std::uint8_t{repair::kNeeded};
  }

  /// Whether two of its corners belong to one element that the model leaves out: its edges there are that element's too.
  bool meets_hidden_edge(ShellIndex shell) const {
    if (generation_.relations->hidden_uses.empty()) return false;
    const ShellNodes& nodes = model().shell(shell);
    std::vector<std::uint32_t> met;
    for (int c = 0; c < nodes.corners(); ++c)
      for (const HiddenUse& use : hidden_at(*generation_.relations, nodes.node[static_cast<std::size_t>(c)])) {
        if (std::find(met.begin(), met.end(), use.element) != met.end()) return true;
        met.push_back(use.element);
      }
    return false;
  }

  std::uint8_t find_shell(ShellIndex shell) {
    if (shell.value >= model().shell_count()) return 0;
    if (const PartIndex part = model().shell_parts[shell.value]; part.valid() && (*generation_.parts)[part.value].locked)
      return kAllShellRules;
    if (is_middled(shell) || contains(welded_shells_, shell) || meets_hidden_edge(shell)) return kAllShellRules;
    if (!deck_.shell_runs.empty() && deck_.is_held(deck_.run_of(deck_ancestor(model(), shell)).file)) return kAllShellRules;
    const bool lasts = contains(tied_shells_, shell) || !may_be_deleted(Referred::shell, model().shell_ids[shell.value]);
    return static_cast<std::uint8_t>((lasts ? repair::kLasting : 0) | (may_be_divided(shell) ? 0 : repair::kIndivisible) |
                                     (may_change_kind(shell) ? 0 : repair::kNoTriangle));
  }

  const deck::Deck& deck_;
  const Generation& generation_;
  deck::DeletionCheck deletion_;
  deck::DivisionCheck division_;
  deck::KindCheck kind_;
  ShellSet welded_shells_;   ///< a weld lies on them and follows their corners
  ShellSet tied_shells_;     ///< a tied node lies on them
  ShellSet middled_shells_;  ///< with mid-side nodes
  NodeSet middle_nodes_;
  std::mutex mutex_;
  std::unordered_map<NodeIndex, std::uint8_t> nodes_;
  std::unordered_map<ShellIndex, std::uint8_t> shells_;
  std::unordered_map<ShellIndex, std::vector<SetKey>> sets_;
};

}  // namespace

repair::Rules rules_for(const Document& document, const Generation& generation) {
  const auto book = std::make_shared<Rulebook>(document, generation);
  repair::Rules rules;
  rules.node = [book](NodeIndex node) { return book->node(node); };
  rules.shell = [book](ShellIndex shell) { return book->shell(shell); };
  rules.may_exchange = [book](ShellIndex a, ShellIndex b) { return book->may_exchange(a, b); };
  rules.may_divide = [book](NodeIndex a, NodeIndex b) { return book->may_divide(a, b); };
  return rules;
}

}  // namespace prismesh::mesh::document
