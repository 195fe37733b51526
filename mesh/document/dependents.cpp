#include "mesh/document/dependents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "base/letter_case.h"
#include "base/parallel_for.h"
#include "mesh/document/motion.h"
#include "mesh/document/surroundings.h"
#include "mesh/model/adjacency.h"
#include "mesh/quality/judging.h"
#include "mesh/select/names.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::document {

namespace {

/// Beams, springs and solids that hang together count as one weld up to this many: sixteen solids make the largest nuggets.
constexpr std::size_t kMaxOfAWeld = 16;
constexpr double kReachOfSize = 0.25;  ///< how far from a shell a node still lies on it, as a share of the shell's size
constexpr double kReachOfTied = 0.5;   ///< the same for tied nodes, which are offset by half of both thicknesses
constexpr std::size_t kSearchGrain = 16384;
constexpr double kMaxCells = 64;  ///< a shell over more cells than this is looked at more closely at once

bool has(std::string_view text, std::string_view word) { return text.find(word) != std::string_view::npos; }

/// Decks write their keywords in either case.
/// Cards that are wrong when only some of their nodes move.
bool joins_nodes(std::string_view keyword) {
  if (!keyword.empty() && (keyword.front() == '/' || keyword.front() == '*')) keyword.remove_prefix(1);
  if (has(keyword, "CONSTRAINED_")) return !has(keyword, "GLOBAL") && !has(keyword, "_IN_SOLID");
  constexpr std::string_view kWhole[] = {"RBAR",    "RBAR1", "RBE1",  "RBE2",  "RBE3",  "RROD",      "RTRPLT", "RTRPLT1",
                                         "RSPLINE", "MPC",   "CWELD", "CFAST", "RBODY", "CYL_JOINT", "RLINK",  "EQUATION"};
  const std::string_view first = keyword.substr(0, keyword.find('/'));
  return std::find(std::begin(kWhole), std::end(kWhole), first) != std::end(kWhole);
}

// --- cards -----------------------------------------------------------------------------------------------------------

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

struct Cards {
  std::vector<Dependents::Join> joins;
  std::vector<std::pair<NodeIndex, std::uint32_t>> tied;  ///< with the contact's referrer
};

Cards find_cards(const References& references, const Model& model) {
  Cards cards;
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
  // where a keyword's cards have no ids, each line joins its own nodes
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
      const auto [join, is_new] = join_of.emplace(std::pair(reference.referrer, line), static_cast<std::uint32_t>(cards.joins.size()));
      if (is_new) cards.joins.push_back({reference.referrer, {}});
      nodes.add(reference, cards.joins[join->second].nodes);
    }
  }
  for (Dependents::Join& join : cards.joins) {
    std::sort(join.nodes.begin(), join.nodes.end());
    join.nodes.erase(std::unique(join.nodes.begin(), join.nodes.end()), join.nodes.end());
  }
  return cards;
}

// --- what may lie on shells ------------------------------------------------------------------------------------------

bool may_be_weld(ElementClass element_class) {
  return element_class == ElementClass::beam || element_class == ElementClass::solid || element_class == ElementClass::discrete ||
         element_class == ElementClass::tshell;
}

/// Nodes that no shell uses, of elements that hang together with few others over such nodes.
std::vector<Dependents::Rest> weld_nodes(const Model& model, const Attached& attached, const std::vector<std::uint8_t>& is_middle) {
  std::array<std::vector<std::uint32_t>, kElementClassCount> number;  // of each element, from 0 over all classes
  std::uint32_t count = 0;
  for (std::size_t c = 0; c < model.elements.size(); ++c)
    if (model.elements[c]) {
      number[c].resize(model.elements[c]->size());
      std::iota(number[c].begin(), number[c].end(), count);
      count += static_cast<std::uint32_t>(number[c].size());
    }
  std::vector<std::uint32_t> parent(count), size(count, 1);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t e) {
    while (parent[e] != e) e = parent[e] = parent[parent[e]];
    return e;
  };
  const auto number_of = [&](const Attached::Use& use) { return number[static_cast<std::size_t>(use.element_class)][use.element]; };
  const auto lone = [&](NodeIndex node) { return model.adjacency->shells_of(node).empty() && is_middle[node.value] == 0; };
  for (std::size_t u = 1; u < attached.uses.size(); ++u) {
    const auto &a = attached.uses[u - 1], &b = attached.uses[u];
    if (a.node != b.node || !lone(a.node)) continue;
    const std::uint32_t x = root(number_of(a)), y = root(number_of(b));
    if (x == y) continue;
    parent[y] = x;
    size[x] += size[y];
  }
  std::vector<Dependents::Rest> nodes;
  for (const Attached::Use& use : attached.uses) {
    if (!may_be_weld(use.element_class) || !lone(use.node) || size[root(number_of(use))] > kMaxOfAWeld) continue;
    if (!nodes.empty() && nodes.back().node == use.node) continue;
    Dependents::Rest rest;
    rest.node = use.node;
    rest.element_class = use.element_class;
    rest.of = use.element;
    nodes.push_back(rest);
  }
  return nodes;
}

// --- where they lie --------------------------------------------------------------------------------------------------

double size_of(const Model& model, ShellIndex shell) {
  const ShellNodes& nodes = model.shell(shell);
  double around = 0;
  const int corners = nodes.corners();
  for (int i = 0; i < corners; ++i) around += (model.position(nodes.node[(i + 1) % corners]) - model.position(nodes.node[i])).norm();
  return around / corners;
}

double reach_of(const Model& model, ShellIndex shell, bool tied) {
  const double thickness = quality::thickness_of(model, shell.value);
  return std::max((tied ? kReachOfTied : kReachOfSize) * size_of(model, shell), thickness > 0 ? (tied ? 1.2 : 1.0) * thickness : 0.0);
}

using Cell = std::array<std::int64_t, 3>;

/// Which cells of a grid hold a point, by a table of bits that may say yes too often.
class CellTable {
 public:
  CellTable(const Model& model, const std::vector<Dependents::Rest>& points, double width) : width_(width), bits_(kBits, 0) {
    for (const Dependents::Rest& point : points) bits_[slot(cell_of(model.position(point.node)))] = 1;
  }
  Cell cell_of(const Vec3& point) const {
    Cell cell;
    for (int i = 0; i < 3; ++i)
      cell[static_cast<std::size_t>(i)] = static_cast<std::int64_t>(std::floor(std::clamp(point[i] / width_, -1e15, 1e15)));
    return cell;
  }
  bool may_hold_any(const Vec3& low, const Vec3& high) const {
    const Cell a = cell_of(low), b = cell_of(high);
    double cells = 1;
    for (std::size_t i = 0; i < 3; ++i) cells *= static_cast<double>(b[i] - a[i] + 1);
    if (cells > kMaxCells) return true;
    for (std::int64_t x = a[0]; x <= b[0]; ++x)
      for (std::int64_t y = a[1]; y <= b[1]; ++y)
        for (std::int64_t z = a[2]; z <= b[2]; ++z)
          if (bits_[slot({x, y, z})] != 0) return true;
    return false;
  }

 private:
  static constexpr std::size_t kBits = std::size_t{1} << 20;
  static std::size_t slot(const Cell& cell) {
    const auto mixed = static_cast<std::uint64_t>(cell[0]) * 0x9e3779b97f4a7c15u ^
                       static_cast<std::uint64_t>(cell[1]) * 0xc2b2ae3d27d4eb4fu ^
                       static_cast<std::uint64_t>(cell[2]) * 0x165667b19e3779f9u;
    return static_cast<std::size_t>(mixed >> 44);
  }
  double width_;
  std::vector<std::uint8_t> bits_;
};

/// Shells within whose reach a point may be.
ShellSet shells_near(const Model& model, const std::vector<Dependents::Rest>& points) {
  double sum = 0;
  std::size_t asked = 0;
  for (std::size_t s = 0; s < model.shell_count(); s += 64)
    if (!model.is_removed(ShellIndex(s))) sum += size_of(model, ShellIndex(s)), ++asked;
  const double width = asked > 0 && sum > 0 && std::isfinite(sum) ? 2 * sum / static_cast<double>(asked) : 1.0;
  const CellTable table(model, points, width);
  std::vector<ShellSet> found((model.shell_count() + kSearchGrain - 1) / kSearchGrain);
  parallel_for(model.shell_count(), kSearchGrain, [&](std::size_t begin, std::size_t end) {
    ShellSet& near = found[begin / kSearchGrain];
    for (std::size_t s = begin; s < end; ++s) {
      const ShellIndex shell(s);
      if (model.is_removed(shell)) continue;
      Vec3 low = model.position(model.shell(shell).node[0]), high = low;
      for (const NodeIndex node : model.shell(shell).node) {
        low = low.cwiseMin(model.position(node));
        high = high.cwiseMax(model.position(node));
      }
      const Vec3 reach = Vec3::Constant(reach_of(model, shell, true));
      if (table.may_hold_any(low - reach, high + reach)) near.push_back(shell);
    }
  });
  ShellSet all;
  for (const ShellSet& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// The nearest shell that the node isn't a corner of; for a tied node none of its own parts.
std::optional<spatial::SurfacePoint> sheet_under(const Model& model, const spatial::ShellTree& tree, const Dependents::Rest& rest,
                                                 double far) {
  const Vec3& point = model.position(rest.node);
  if (!rest.tied) return tree.closest(point);
  std::optional<spatial::SurfacePoint> best;
  const auto own = model.adjacency->shells_of(rest.node);
  for (const spatial::SurfacePoint& on : tree.within(point, far)) {
    const PartIndex part = model.shell_parts[on.shell.value];
    const bool is_own = std::any_of(own.begin(), own.end(), [&](ShellIndex shell) { return model.shell_parts[shell.value] == part; });
    if (!is_own && (!best || on.distance < best->distance)) best = on;
  }
  return best;
}

void find_rests(const Model& model, std::vector<Dependents::Rest> points, Dependents& dependents) {
  if (points.empty() || model.shell_count() == 0) return;
  const ShellSet near = shells_near(model, points);
  const spatial::ShellTree tree(model, near);
  if (tree.empty()) return;
  double far = 0;
  for (const ShellIndex shell : near) far += reach_of(model, shell, true);
  far = near.empty() ? 0 : 2 * far / static_cast<double>(near.size());
  std::vector<std::uint8_t> lies(points.size(), 0);
  parallel_for(points.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto on = sheet_under(model, tree, points[i], far);
      if (!on) continue;
      points[i].shell = on->shell;
      points[i].reach = reach_of(model, on->shell, points[i].tied);
      lies[i] = on->distance <= points[i].reach ? 1 : 0;
    }
  });
  for (std::size_t i = 0; i < points.size(); ++i)
    if (lies[i] != 0) dependents.rests.push_back(points[i]);
}

}  // namespace

Dependents find_dependents(const deck::Deck& deck, const Model& model, const Attached& attached) {
  Dependents dependents;
  Cards cards;
  if (deck.references) cards = find_cards(*deck.references, model);
  dependents.joins = std::move(cards.joins);
  for (std::size_t j = 0; j < dependents.joins.size(); ++j)
    for (const NodeIndex node : dependents.joins[j].nodes) dependents.joined.push_back({node, static_cast<std::uint32_t>(j)});
  std::sort(dependents.joined.begin(), dependents.joined.end());

  std::vector<std::uint8_t> is_middle(model.node_count(), 0);
  if (model.midside)
    for (const MidsideNodes& midside : *model.midside)
      for (const NodeIndex node : midside.node)
        if (node.valid()) is_middle[node.value] = 1;
  std::vector<Dependents::Rest> points = weld_nodes(model, attached, is_middle);
  for (const auto& [node, referrer] : cards.tied) {
    if (model.adjacency->shells_of(node).empty()) continue;
    Dependents::Rest rest;
    rest.node = node;
    rest.tied = true;
    rest.of = referrer;
    points.push_back(rest);
  }
  const auto by_node = [](const Dependents::Rest& a, const Dependents::Rest& b) { return a.node < b.node; };
  std::stable_sort(points.begin(), points.end(), by_node);
  points.erase(std::unique(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.node == b.node; }), points.end());
  find_rests(model, std::move(points), dependents);
  dependents.rests_by_shell.resize(dependents.rests.size());
  std::iota(dependents.rests_by_shell.begin(), dependents.rests_by_shell.end(), 0u);
  std::stable_sort(dependents.rests_by_shell.begin(), dependents.rests_by_shell.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return dependents.rests[a].shell < dependents.rests[b].shell; });
  return dependents;
}

namespace {

/// What is to be carried along, by node.
struct Carried {
  NodeIndex node;
  spatial::SurfacePoint on;
};

std::vector<Carried> find_carried(const Generation& generation, const Motion& motion) {
  const Dependents& dependents = generation.around->dependents;
  const Model& model = generation.model;
  std::vector<Carried> carried;
  auto rest = dependents.rests_by_shell.begin();
  for (const ShellIndex shell : shells_touching(model, motion.nodes)) {
    rest = std::lower_bound(rest, dependents.rests_by_shell.end(), shell,
                            [&](std::uint32_t r, ShellIndex s) { return dependents.rests[r].shell < s; });
    for (; rest != dependents.rests_by_shell.end() && dependents.rests[*rest].shell == shell; ++rest) {
      const Dependents::Rest& each = dependents.rests[*rest];
      if (each.tied || model.is_removed(each.node) || std::binary_search(motion.nodes.begin(), motion.nodes.end(), each.node)) continue;
      if ((generation.node_marks[each.node.value] & kLocked) != 0 || model.node_holds[each.node.value] != 0) continue;
      const auto on = spatial::ShellTree(model, {shell}).closest(model.position(each.node), each.reach);
      if (on) carried.push_back({each.node, *on});
    }
    if (rest == dependents.rests_by_shell.end()) break;
  }
  std::sort(carried.begin(), carried.end(), [](const Carried& a, const Carried& b) { return a.node < b.node; });
  return carried;
}

std::uint32_t place_of(const NodeSet& nodes, NodeIndex node) {
  const auto at = std::lower_bound(nodes.begin(), nodes.end(), node);
  return at != nodes.end() && *at == node ? static_cast<std::uint32_t>(at - nodes.begin()) : Motion::Follower::kStays;
}

/// Puts nodes of weight 0 among those that move; positions in `followers` follow.
void insert_nodes(const Model& model, const std::vector<Carried>& carried, Motion& motion) {
  const NodeSet before = std::move(motion.nodes);
  const std::vector<double> weight = std::move(motion.weight);
  const std::vector<Vec3> start = std::move(motion.start);
  motion.nodes.clear(), motion.weight.clear(), motion.start.clear();
  std::vector<std::uint32_t> moved_to(before.size());
  std::size_t c = 0;
  for (std::size_t i = 0; i <= before.size(); ++i) {
    for (; c < carried.size() && (i == before.size() || carried[c].node < before[i]); ++c) {
      motion.nodes.push_back(carried[c].node);
      motion.weight.push_back(0.0);
      motion.start.push_back(model.position(carried[c].node));
    }
    if (i == before.size()) break;
    moved_to[i] = static_cast<std::uint32_t>(motion.nodes.size());
    motion.nodes.push_back(before[i]);
    motion.weight.push_back(weight[i]);
    motion.start.push_back(start[i]);
  }
  if (motion.plane) {
    const std::vector<shape::Mirrored> mirrored = std::move(motion.mirrored);
    motion.mirrored.assign(motion.nodes.size(), {});
    for (std::size_t i = 0; i < mirrored.size(); ++i) {
      motion.mirrored[moved_to[i]] = mirrored[i];
      std::uint32_t& image = motion.mirrored[moved_to[i]].image;
      if (image != shape::Mirrored::kNone) image = moved_to[image];
    }
  }
  for (Motion::Follower& follower : motion.followers) {
    follower.node = moved_to[follower.node];
    for (std::uint32_t& of : follower.of)
      if (of != Motion::Follower::kStays) of = moved_to[of];
  }
}

}  // namespace

void add_welded(const Generation& generation, const NodeSet& acted_on, Motion& motion) {
  if (generation.around->dependents.rests.empty()) return;
  const std::vector<Carried> carried = find_carried(generation, motion);
  if (carried.empty()) return;
  insert_nodes(generation.model, carried, motion);
  for (const Carried& each : carried) {
    Motion::Follower follower;
    follower.node = place_of(motion.nodes, each.node);
    const ShellNodes& corners = generation.model.shell(each.on.shell);
    for (std::size_t i = 0; i < static_cast<std::size_t>(corners.corners()); ++i) {
      if (each.on.share[i] == 0) continue;
      follower.of[i] = place_of(motion.nodes, corners.node[i]);
      follower.share[i] = each.on.share[i];
    }
    motion.followers.push_back(follower);
    if (motion.unreached > 0 && std::binary_search(acted_on.begin(), acted_on.end(), each.node)) --motion.unreached;
  }
}

}  // namespace prismesh::mesh::document
