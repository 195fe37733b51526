#include "mesh/document/node_cards.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "base/letter_case.h"
#include "mesh/select/names.h"

namespace prismesh::mesh::document {

namespace {

/// Rigid bodies of up to this many nodes count as joints: a bolt in two holes of eight nodes each.
constexpr std::size_t kMaxNodesOfAJoint = 16;

bool has(std::string_view text, std::string_view word) { return text.find(word) != std::string_view::npos; }

/// Keywords of cards that are wrong if only some of their nodes move.
bool joins_nodes(std::string_view keyword) {
  if (!keyword.empty() && (keyword.front() == '/' || keyword.front() == '*')) keyword.remove_prefix(1);
  if (has(keyword, "CONSTRAINED_")) return !has(keyword, "GLOBAL") && !has(keyword, "_IN_SOLID");
  constexpr std::string_view kWhole[] = {"RBAR",    "RBAR1", "RBE1",  "RBE2",  "RBE3",  "RROD",      "RTRPLT", "RTRPLT1",
                                         "RSPLINE", "MPC",   "CWELD", "CFAST", "RBODY", "CYL_JOINT", "RLINK",  "EQUATION"};
  const std::string_view first = keyword.substr(0, keyword.find('/'));
  return std::find(std::begin(kWhole), std::end(kWhole), first) != std::end(kWhole);
}

bool starts_with_any(std::string_view keyword, std::span<const std::string_view> words) {
  if (!keyword.empty() && (keyword.front() == '/' || keyword.front() == '*')) keyword.remove_prefix(1);
  return std::any_of(words.begin(), words.end(), [&](std::string_view word) { return keyword.starts_with(word); });
}

/// Whether a card holds the sheets at its nodes together: a weld, a rivet, or a rigid body. Joints and equations let sheets move; rigid
/// bodies of many nodes are parts or barriers.
bool joins_sheets(std::string_view keyword, std::size_t nodes) {
  constexpr std::string_view kWelds[] = {"CONSTRAINED_SPOTWELD", "CONSTRAINED_GENERALIZED_WELD", "CONSTRAINED_RIVET"};
  constexpr std::string_view kRigid[] = {"CONSTRAINED_NODAL_RIGID_BODY", "CONSTRAINED_NODE_SET", "RBAR", "RBE1", "RBE2", "RBODY"};
  return starts_with_any(keyword, kWelds) || (nodes <= kMaxNodesOfAJoint && starts_with_any(keyword, kRigid));
}

/// Collects nodes that cards name, also by their sets.
class CardNodes {
 public:
  CardNodes(const References& references, const Model& model) : references_(references), model_(model) {}

  void add(const Reference& reference, NodeSet& nodes) {
    if (reference.referred == Referred::node) return add_range(reference, nodes);
    if (reference.referred != Referred::node_set) return;
    if (sets_.empty()) sets_ = select::find_sets(references_);
    for (const select::NamedSet& set : sets_)
      if (set.kind == Referred::node_set && reference.names(set.id))
        for (const Reference& member : set.members)
          if (member.referred == Referred::node && !member.takes_away) add_range(member, nodes);
  }

 private:
  void add_range(const Reference& reference, NodeSet& nodes) const {
    const IdIndex& ids = *model_.node_index;
    for (std::size_t rank = ids.lower_bound(reference.first); rank < ids.size(); ++rank) {
      const auto [id, index] = ids.at(rank);
      if (id > reference.last) break;
      if (reference.names(id)) nodes.emplace_back(index);
    }
  }

  const References& references_;
  const Model& model_;
  std::vector<select::NamedSet> sets_;  ///< found when a card names one
};

}  // namespace

NodeCards find_node_cards(const References& references, const Model& model) {
  NodeCards cards;
  const std::span<const Referrer> referrers = references.referrers();
  enum class Card : std::uint8_t { other, tied, join };
  std::vector<Card> cards_are(referrers.size(), Card::other);
  for (std::size_t r = 0; r < referrers.size(); ++r) {
    const std::string keyword = upper(referrers[r].keyword);
    if (has(keyword, "TIED") && has(keyword, "CONTACT"))
      cards_are[r] = Card::tied;
    else if (joins_nodes(keyword))
      cards_are[r] = Card::join;
  }
  // If a keyword's cards have no ids, each line joins its own nodes.
  std::map<std::pair<std::uint32_t, std::uint64_t>, std::uint32_t> join_of;
  CardNodes nodes(references, model);
  for (const Reference& reference : references.all()) {
    if (reference.referred != Referred::node && reference.referred != Referred::node_set) continue;
    const Card card = cards_are[reference.referrer];
    if (card == Card::tied) {
      NodeSet slaves;
      nodes.add(reference, slaves);
      for (const NodeIndex node : slaves) cards.tied.emplace_back(node, reference.referrer);
    } else if (card == Card::join) {
      const std::uint64_t line = referrers[reference.referrer].id > 0 ? 0 : reference.card;
      const auto [join, is_new] = join_of.emplace(std::pair(reference.referrer, line), static_cast<std::uint32_t>(cards.joining.size()));
      if (is_new) cards.joining.push_back({reference.referrer, {}, false});
      nodes.add(reference, cards.joining[join->second].nodes);
    }
  }
  for (JoiningCard& join : cards.joining) {
    std::sort(join.nodes.begin(), join.nodes.end());
    join.nodes.erase(std::unique(join.nodes.begin(), join.nodes.end()), join.nodes.end());
    join.joins_sheets = joins_sheets(upper(referrers[join.referrer].keyword), join.nodes.size());
  }
  return cards;
}

}  // namespace prismesh::mesh::document
