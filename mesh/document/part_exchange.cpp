#include "mesh/document/part_exchange.h"
#include "base/readable_number.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "mesh/connections/sheet_reach.h"
#include "mesh/deck/editing/ancestors.h"
#include "mesh/deck/editing/edit_checks.h"
#include "mesh/deck/editing/new_ids.h"
#include "mesh/deck/formats/formats.h"
#include "mesh/document/connections_kept.h"
#include "mesh/document/deck_relations.h"
#include "mesh/model/adjacency.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::document {

namespace {

/// A new node comes from one node or one edge of the part if it is nearer to it than this share of the tolerance.
constexpr double kSnapShare = 0.25;
constexpr double kToleranceInSides = 0.75;
/// Shares of corners below this count as none.
constexpr double kMinShare = 1e-6;

Vec3 vector_of(const std::array<double, 3>& at) { return {at[0], at[1], at[2]}; }

/// Points in cells of a grid.
class PointGrid {
 public:
  PointGrid(std::vector<Vec3> points, double cell) : points_(std::move(points)), cell_(cell) {
    for (std::size_t p = 0; p < points_.size(); ++p) cells_[cell_of(points_[p])].push_back(p);
  }
  /// Those within the cell's size, inclusive.
  template <class Visit>
  void near(const Vec3& at, Visit&& visit) const {
    const std::array<std::int64_t, 3> middle = cell_of(at);
    for (std::int64_t x = -1; x <= 1; ++x)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t z = -1; z <= 1; ++z)
          if (const auto cell = cells_.find({middle[0] + x, middle[1] + y, middle[2] + z}); cell != cells_.end())
            for (const std::size_t p : cell->second)
              if (const double distance = (points_[p] - at).norm(); distance <= cell_) visit(p, distance);
  }
  /// The nearest of all, however far, and its distance. Precondition: there is one.
  std::pair<std::size_t, double> nearest(const Vec3& at) const {
    std::pair<std::size_t, double> best{0, std::numeric_limits<double>::infinity()};
    for (std::size_t p = 0; p < points_.size(); ++p)
      if (const double distance = (points_[p] - at).norm(); distance < best.second) best = {p, distance};
    return best;
  }

 private:
  std::array<std::int64_t, 3> cell_of(const Vec3& at) const {
    std::array<std::int64_t, 3> cell{};
    for (std::size_t k = 0; k < 3; ++k)
      cell[k] = static_cast<std::int64_t>(std::floor(std::clamp(at[static_cast<Eigen::Index>(k)] / cell_, -1e15, 1e15)));
    return cell;
  }

  std::vector<Vec3> points_;
  double cell_;
  std::map<std::array<std::int64_t, 3>, std::vector<std::size_t>> cells_;
};

/// The cards that name some of a part's nodes, or some of its shells. Sets that name all of them are no reason to keep one.
class NamedOfPart {
 public:
  /// `ids`: those of the deck, and those that added ones come from.
  NamedOfPart(const Document& document, Referred referred, std::vector<std::int64_t> ids)
      : references_(*document.deck->references), referred_(referred), ids_(std::move(ids)), unread_(*document.deck) {}

  struct Naming {
    std::vector<std::uint32_t> sets;     ///< that name it and not all others, ascending
    std::optional<std::uint32_t> alone;  ///< a card that names it alone
    bool in_unread = false;              ///< text that isn't read may name it
    bool in_segments = false;            ///< of a node: it is a corner of a segment
    bool any() const { return !sets.empty() || alone || in_unread; }
  };

  Naming of(std::int64_t id) {
    Naming naming;
    for (const Reference& reference : references_.naming(referred_, id)) {
      if (reference.role == ReferenceRole::single) naming.alone = reference.referrer;
      naming.in_segments |= reference.role == ReferenceRole::segment;
      if (reference.role != ReferenceRole::list && reference.role != ReferenceRole::range) continue;
      if (!names_all(reference.referrer)) naming.sets.push_back(reference.referrer);
    }
    std::sort(naming.sets.begin(), naming.sets.end());
    naming.sets.erase(std::unique(naming.sets.begin(), naming.sets.end()), naming.sets.end());
    if (!naming.any()) naming.in_unread = !unread_.check_unread_text(referred_, id);
    return naming;
  }
  /// Of one that an edit added: it is in the sets that name all it comes from.
  Naming of_added(std::span<const std::int64_t> from) {
    Naming naming;
    naming.sets = of(from.front()).sets;
    std::erase_if(naming.sets, [&](std::uint32_t set) { return !deck::all_named_by(references_, referred_, from, set); });
    return naming;
  }

  bool in_segments(std::int64_t id) const {
    return std::ranges::any_of(references_.naming(referred_, id),
                               [](const Reference& reference) { return reference.role == ReferenceRole::segment; });
  }

 private:
  bool names_all(std::uint32_t referrer) {
    const auto known = names_all_.find(referrer);
    if (known != names_all_.end()) return known->second;
    return names_all_[referrer] = deck::all_named_by(references_, referred_, ids_, referrer);
  }

  const References& references_;
  Referred referred_;
  std::vector<std::int64_t> ids_;
  std::map<std::uint32_t, bool> names_all_;
  deck::DeletionCheck unread_;
};

/// A place of the part that should keep its entry: a node or shell that something names or uses.
struct Wanted {
  std::size_t old = 0;  ///< which
  Vec3 at = Vec3::Zero();
};

/// Pairs each place with one new one, the nearest pairs first. Returns by place the new one, or kNone.
constexpr std::size_t kUnpaired = std::numeric_limits<std::size_t>::max();
template <class Fits>
std::vector<std::size_t> pair_places(const std::vector<Wanted>& wanted, const PointGrid& grid, std::vector<std::uint8_t>& taken,
                                     Fits&& fits) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (std::size_t w = 0; w < wanted.size(); ++w)
    grid.near(wanted[w].at, [&](std::size_t at, double distance) {
      if (taken[at] == 0 && fits(w, at)) pairs.emplace_back(distance, w, at);
    });
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::size_t> found(wanted.size(), kUnpaired);
  for (const auto& [distance, w, at] : pairs) {
    if (found[w] != kUnpaired || taken[at] != 0) continue;
    found[w] = at;
    taken[at] = 1;
  }
  return found;
}

class ExchangePlanner {
 public:
  ExchangePlanner(const Document& document, PartIndex part, const VariantMesh& mesh, double tolerance)
      : document_(document), now_(document.current()), model_(now_.model), part_(part), mesh_(mesh), tolerance_(tolerance) {
    find_old();
    find_places();
  }

  PartExchange plan() {
    look_at_nodes();
    look_at_shells();
    const spatial::ShellTree old_surface(model_, plan_.old_shells);
    pair_nodes();
    place_nodes(old_surface);
    keep_last_of_sets();
    pair_shells();
    place_shells(old_surface);
    remove_rest();
    return std::move(plan_);
  }

 private:
  void find_old() {
    for (std::size_t s = 0; s < model_.shell_count(); ++s)
      if (const ShellIndex shell(s); model_.shell_parts[s] == part_ && !model_.is_removed(shell)) plan_.old_shells.push_back(shell);
    for (const ShellIndex shell : plan_.old_shells) {
      for (const NodeIndex node : model_.shell(shell).node) nodes_.push_back(node);
      varies_ |= model_.shell_thickness[shell.value] != 0;
    }
    std::sort(nodes_.begin(), nodes_.end());
    nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  }

  void find_places() {
    std::unordered_map<std::int64_t, std::size_t> by_id;
    for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) {
      by_id.emplace(mesh_.nodes[n].id, n);
      node_at_.push_back(vector_of(mesh_.nodes[n].at));
    }
    for (const VariantMesh::Shell& shell : mesh_.shells) {
      Vec3 sum = Vec3::Zero();
      const int corners = shell.node[3] == shell.node[2] ? 3 : 4;
      for (std::size_t c = 0; c < static_cast<std::size_t>(corners); ++c) sum += node_at_[by_id.at(shell.node[c])];
      shell_at_.emplace_back(sum / corners);
    }
    plan_.node.resize(mesh_.nodes.size());
    plan_.origin.resize(mesh_.nodes.size());
    plan_.keeps_place.resize(mesh_.nodes.size());
    plan_.shell.resize(mesh_.shells.size());
    plan_.parent.resize(mesh_.shells.size());
  }

  // --- what names and uses the part's nodes and shells ---

  struct OldNode {
    NamedOfPart::Naming naming;
    std::string user;          ///< another part or element that has it; empty: none
    bool held = false;         ///< it can't be moved or removed
    bool constrained = false;  ///< by its own card, unlike others
  };

  std::string user_of(NodeIndex node) const {
    for (const ShellIndex shell : model_.adjacency->shells_of(node))
      if (const PartIndex part = model_.shell_parts[shell.value]; part != part_)
        return part.valid() ? "part:" + std::to_string((*model_.parts)[part.value].id)
                            : "shell:" + std::to_string(model_.shell_ids[shell.value]);
    for (const ElementUse& use : uses_at(*now_.relations, node))
      return std::string(name(use.element_class)) + ":" +
             std::to_string(model_.elements[static_cast<std::size_t>(use.element_class)]->id[use.element]);
    if (!hidden_at(*now_.relations, node).empty()) return "an element that isn't shown";
    return "";
  }

  deck::CardRef card_ref(NodeIndex node) const {
    const deck::CardRun& run = document_.deck->run_of(node);
    return {document_.deck->files[run.file].bytes.text(), document_.deck->node_line[node.value], run.style};
  }

  /// The numbers of the deck's nodes that a node comes from; of the deck's own: its own.
  std::vector<std::int64_t> origins_of(NodeIndex node) const {
    std::vector<std::int64_t> ids;
    for (const NodeIndex ancestor : deck::deck_ancestors(model_, node)) ids.push_back(model_.node_ids[ancestor.value]);
    return ids;
  }
  std::vector<std::int64_t> origins_of(ShellIndex shell) const { return {model_.shell_ids[deck_ancestor(model_, shell).value]}; }

  template <class Indices, class Origins>
  static std::vector<std::int64_t> all_of(const Indices& indices, Origins&& origins) {
    std::vector<std::int64_t> ids;
    for (const auto index : indices)
      for (const std::int64_t id : origins(index)) ids.push_back(id);
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    return ids;
  }

  void look_at_nodes() {
    NamedOfPart named(document_, Referred::node, all_of(nodes_, [&](NodeIndex node) { return origins_of(node); }));
    const std::unique_ptr<const deck::CardWriter> writer = deck::card_writer(document_.deck->format);
    std::optional<std::string> usual;
    for (const NodeIndex node : nodes_) {
      OldNode old;
      old.user = user_of(node);
      old.held = model_.node_holds[node.value] != 0;
      if (!is_added(model_, node)) {
        old.naming = named.of(model_.node_ids[node.value]);
        const std::string constraints = writer->node_constraints(card_ref(node));
        if (!usual) usual = constraints;
        old.constrained = constraints != *usual;
      } else {
        old.naming = named.of_added(origins_of(node));
      }
      old_nodes_.push_back(std::move(old));
    }
  }

  void look_at_shells() {
    NamedOfPart named(document_, Referred::shell, all_of(plan_.old_shells, [&](ShellIndex shell) { return origins_of(shell); }));
    NamedOfPart corners(document_, Referred::node, {});
    for (const ShellIndex shell : plan_.old_shells) {
      const std::vector<std::int64_t> from = origins_of(shell);
      old_shells_.push_back(is_added(model_, shell) ? named.of_added(from) : named.of(from.front()));
      // A segment goes with its shell of the deck, so such a shell is as one of a set of some.
      const ShellNodes& nodes = document_.opened->model.shell(deck_ancestor(model_, shell));
      old_shells_.back().in_segments = std::ranges::all_of(
          nodes.node, [&](NodeIndex node) { return corners.in_segments(document_.opened->model.node_ids[node.value]); });
    }
  }

  // --- nodes ---

  std::size_t rank_of(NodeIndex node) const {
    return static_cast<std::size_t>(std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin());
  }

  /// Gives what uses or names a node of the part the nearest new node: first where elements share it, then where cards name it.
  void pair_nodes() {
    const PointGrid grid(node_at_, tolerance_);
    std::vector<std::uint8_t> taken(mesh_.nodes.size(), 0);
    std::vector<std::pair<std::size_t, std::pair<std::size_t, double>>> unpaired;
    for (const bool by_elements : {true, false}) {
      std::vector<Wanted> wanted;
      for (std::size_t n = 0; n < nodes_.size(); ++n) {
        const OldNode& old = old_nodes_[n];
        const bool used = !old.user.empty() || old.held;
        if (by_elements ? used : !used && (old.naming.any() || old.constrained)) wanted.push_back({n, model_.position(nodes_[n])});
      }
      const std::vector<std::size_t> found = pair_places(wanted, grid, taken, [](std::size_t, std::size_t) { return true; });
      for (std::size_t w = 0; w < wanted.size(); ++w) {
        const std::size_t n = wanted[w].old;
        if (found[w] == kUnpaired) {
          unpaired.emplace_back(n, grid.nearest(wanted[w].at));
          continue;
        }
        plan_.node[found[w]] = nodes_[n];
        plan_.keeps_place[found[w]] = by_elements ? 1 : 0;
        kept_.insert(nodes_[n]);
        if (!old_nodes_[n].user.empty())
          ++plan_.joined_by_elements;
        else if (!old_nodes_[n].naming.sets.empty() || old_nodes_[n].naming.alone)
          ++plan_.joined_by_cards;
      }
    }
    for (const auto& [n, nearest] : unpaired)
      if (!is_merged(n, nearest.first, nearest.second)) lose(n, nearest.second);
  }

  /// Whether the sets of a node of the part have the new node there anyway, since it took the place of another of their nodes: a coarser
  /// mesh has fewer nodes along the same line.
  bool is_merged(std::size_t n, std::size_t at, double distance) const {
    const OldNode& old = old_nodes_[n];
    if (!old.user.empty() || old.held || old.naming.alone || distance > tolerance_ || !plan_.node[at].valid()) return false;
    const std::vector<std::uint32_t>& sets = old_nodes_[rank_of(plan_.node[at])].naming.sets;
    return std::includes(sets.begin(), sets.end(), old.naming.sets.begin(), old.naming.sets.end());
  }

  void lose(std::size_t n, double nearest) {
    const OldNode& old = old_nodes_[n];
    const bool stays = !old.user.empty() || old.held || old.naming.alone.has_value();
    if (stays) kept_.insert(nodes_[n]);
    std::string user = old.user;
    if (user.empty() && old.naming.alone) user = card_of(*now_.relations, *old.naming.alone);
    if (user.empty() && !old.naming.sets.empty()) user = card_of(*now_.relations, old.naming.sets.front());
    if (user.empty() && old.constrained) user = "a constraint on its own card";
    if (!user.empty()) plan_.lost.push_back({nodes_[n], std::move(user), !old.user.empty(), nearest, stays});
  }

  /// Sets that name some of the part's nodes and all of these.
  std::vector<std::uint32_t> common_sets(std::span<const NodeIndex> nodes) const {
    std::vector<std::uint32_t> common;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::vector<std::uint32_t>& own = old_nodes_[rank_of(nodes[i])].naming.sets;
      std::vector<std::uint32_t> both;
      if (i == 0)
        both = own;
      else
        std::set_intersection(common.begin(), common.end(), own.begin(), own.end(), std::back_inserter(both));
      common = std::move(both);
    }
    return common;
  }

  /// Nodes that no set names all of but those that name the whole part, as far as four can do.
  NodeOrigin origin_elsewhere() {
    std::vector<NodeIndex> chosen;
    std::vector<std::uint32_t> common;
    for (int step = 0; step < 4 && (step == 0 || !common.empty()); ++step) {
      std::optional<NodeIndex> best;
      std::size_t least = std::numeric_limits<std::size_t>::max();
      for (const NodeIndex node : nodes_) {
        std::vector<NodeIndex> with = chosen;
        with.push_back(node);
        const std::size_t left = common_sets(with).size() + (old_nodes_[rank_of(node)].naming.alone ? 1 : 0);
        if (left < least) least = left, best = node;
        if (least == 0) break;
      }
      if (std::find(chosen.begin(), chosen.end(), *best) != chosen.end()) break;
      chosen.push_back(*best);
      common = common_sets(chosen);
    }
    if (!common.empty())
      plan_.notes.push_back("new nodes away from the old mesh join " + card_of(*now_.relations, common.front()) +
                            ", since no node of the part is outside it");
    NodeOrigin origin;
    for (std::size_t p = 0; p < chosen.size(); ++p) {
      origin.parent[p] = chosen[p];
      origin.weight[p] = 1.0 / static_cast<double>(chosen.size());
    }
    return origin;
  }

  /// The node, edge or shell of the part at which a new node lies.
  NodeOrigin origin_at(const Vec3& at, const spatial::SurfacePoint& on) const {
    const ShellNodes& corners = model_.shell(on.shell);
    const auto count = static_cast<std::size_t>(corners.corners());
    const double snap = kSnapShare * tolerance_;
    // The nearest: on stretched shells the snap reaches several.
    const auto away = [&](NodeIndex corner) { return (model_.position(corner) - at).norm(); };
    const NodeIndex nearest = *std::min_element(corners.node.begin(), corners.node.begin() + static_cast<std::ptrdiff_t>(count),
                                                [&](NodeIndex a, NodeIndex b) { return away(a) < away(b); });
    if (away(nearest) <= snap) return {{nearest, NodeIndex(), NodeIndex(), NodeIndex()}, {1, 0, 0, 0}};
    for (std::size_t c = 0; c < count; ++c) {
      const NodeIndex a = corners.node[c], b = corners.node[(c + 1) % count];
      const Vec3 from = model_.position(a), along = model_.position(b) - from;
      const double share = along.squaredNorm() > 0 ? (at - from).dot(along) / along.squaredNorm() : 0;
      if (share > kMinShare && share < 1 - kMinShare && (from + share * along - at).norm() <= snap) return edge_origin(a, b, share);
    }
    NodeOrigin origin;
    std::size_t used = 0;
    double sum = 0;
    for (std::size_t c = 0; c < count; ++c) {
      if (on.share[c] < kMinShare) continue;
      origin.parent[used] = corners.node[c];
      origin.weight[used++] = on.share[c];
      sum += on.share[c];
    }
    for (std::size_t p = 0; p < used; ++p) origin.weight[p] /= sum;
    return origin;
  }

  /// Notes a new node on an edge that the old mesh shared with another part: that part doesn't have it.
  void note_between(std::size_t n, const NodeOrigin& origin) {
    if (origin.count() != 2) return;
    const EdgeIndex edge = model_.adjacency->find_edge(origin.parent[0], origin.parent[1]);
    if (!edge.valid()) return;
    for (const ShellIndex shell : model_.adjacency->shells_of(edge))
      if (const PartIndex part = model_.shell_parts[shell.value]; part != part_) {
        plan_.between.push_back({n, {origin.parent[0], origin.parent[1]}, part});
        return;
      }
  }

  void place_nodes(const spatial::ShellTree& old_surface) {
    std::unordered_map<std::int64_t, NodeIndex> free_by_id;
    for (const NodeIndex node : nodes_)
      if (!kept_.contains(node)) free_by_id.emplace(model_.node_ids[node.value], node);
    std::optional<NodeOrigin> elsewhere;
    for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) {
      if (plan_.node[n].valid()) continue;
      const auto on = old_surface.closest(node_at_[n], tolerance_);
      if (!on && !elsewhere) elsewhere = origin_elsewhere();
      const NodeOrigin origin = on ? origin_at(node_at_[n], *on) : *elsewhere;
      if (on) note_between(n, origin);
      const auto same = free_by_id.find(mesh_.nodes[n].id);
      if (same == free_by_id.end() || !may_stand_for(same->second, origin)) {
        plan_.origin[n] = origin;
        continue;
      }
      plan_.node[n] = same->second;
      kept_.insert(same->second);
      free_by_id.erase(same);
    }
  }

  /// Whether a new node with the number of an old one can have its entry: at its place, or where no card tells the places apart.
  bool may_stand_for(NodeIndex old, const NodeOrigin& origin) const {
    if (origin.count() == 1 && origin.parent[0] == old) return true;
    const OldNode& own = old_nodes_[rank_of(old)];
    return !varies_ && !own.naming.any() && !own.naming.in_segments && !own.constrained &&
           common_sets(std::span(origin.parent).first(static_cast<std::size_t>(origin.count()))).empty();
  }

  /// A set that would name nothing keeps its nodes, without the part: no deck may have an empty set.
  void keep_last_of_sets() {
    std::map<std::uint32_t, std::vector<std::size_t>> leaving;  // places in `lost`, by set
    for (std::size_t l = 0; l < plan_.lost.size(); ++l)
      if (!plan_.lost[l].stays)
        for (const std::uint32_t set : old_nodes_[rank_of(plan_.lost[l].node)].naming.sets) leaving[set].push_back(l);
    if (leaving.empty()) return;
    std::set<std::uint32_t> joined;
    for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) {
      if (plan_.node[n].valid()) continue;
      const NodeOrigin& origin = plan_.origin[n];
      for (const std::uint32_t set : common_sets(std::span(origin.parent).first(static_cast<std::size_t>(origin.count()))))
        joined.insert(set);
    }
    for (const auto& [set, places] : leaving) {
      if (joined.contains(set)) continue;
      std::set<std::int64_t> gone;
      for (const std::size_t l : places) gone.insert(model_.node_ids[plan_.lost[l].node.value]);
      if (names_others(set, gone)) continue;
      for (const std::size_t l : places) {
        plan_.lost[l].stays = true;
        kept_.insert(plan_.lost[l].node);
      }
    }
  }

  /// Whether the card lists a node that isn't among these.
  bool names_others(std::uint32_t set, const std::set<std::int64_t>& gone) const {
    for (const Reference& reference : document_.deck->references->all()) {
      if (reference.referrer != set) continue;
      if (reference.referred != Referred::node || reference.role == ReferenceRole::range) return true;
      for (std::int64_t id = reference.first; id <= reference.last; id += reference.step)
        if (!gone.contains(id)) return true;
    }
    return false;
  }

  // --- shells ---

  bool is_triangle(std::size_t s) const { return mesh_.shells[s].node[3] == mesh_.shells[s].node[2]; }

  Vec3 centre_of(ShellIndex shell) const {
    const ShellNodes& nodes = model_.shell(shell);
    Vec3 sum = Vec3::Zero();
    for (int c = 0; c < nodes.corners(); ++c) sum += model_.position(nodes.node[static_cast<std::size_t>(c)]);
    return sum / nodes.corners();
  }

  /// Of the part's shells, the mean.
  double half_side() const {
    double sum = 0;
    for (const ShellIndex shell : plan_.old_shells) sum += connections::mean_side(model_, shell);
    return sum / static_cast<double>(plan_.old_shells.size()) / 2;
  }

  void pair_shells() {
    std::vector<Wanted> wanted;
    for (std::size_t s = 0; s < old_shells_.size(); ++s)
      if (old_shells_[s].alone || old_shells_[s].in_unread) wanted.push_back({s, centre_of(plan_.old_shells[s])});
    if (wanted.empty()) return;
    std::vector<std::uint8_t> taken(mesh_.shells.size(), 0);
    // Of a divided shell no piece has its centre.
    const PointGrid grid(shell_at_, std::max(tolerance_, half_side()));
    const auto fits = [&](std::size_t w, std::size_t at) {
      return model_.shell(plan_.old_shells[wanted[w].old]).is_triangle() == is_triangle(at);
    };
    const std::vector<std::size_t> found = pair_places(wanted, grid, taken, fits);
    for (std::size_t w = 0; w < wanted.size(); ++w) {
      if (found[w] == kUnpaired) continue;  // can_restructure says which card forbids to remove it
      plan_.shell[found[w]] = plan_.old_shells[wanted[w].old];
      kept_shells_.insert(plan_.old_shells[wanted[w].old]);
    }
  }

  static bool is_plain(const NamedOfPart::Naming& naming) { return !naming.any() && !naming.in_segments; }
  bool is_plain(ShellIndex shell) const {
    const auto at = std::lower_bound(plan_.old_shells.begin(), plan_.old_shells.end(), shell) - plan_.old_shells.begin();
    return is_plain(old_shells_[static_cast<std::size_t>(at)]);
  }

  /// Segments, and what names some shells, go with the new shells that come from their shells.
  void find_lost_segments() {
    ShellSet followed;
    for (std::size_t s = 0; s < mesh_.shells.size(); ++s)
      for (const ShellIndex from : {plan_.parent[s], plan_.shell[s]})
        if (from.valid()) followed.push_back(from);
    std::sort(followed.begin(), followed.end());
    for (std::size_t s = 0; s < old_shells_.size(); ++s)
      if (old_shells_[s].in_segments && !std::binary_search(followed.begin(), followed.end(), plan_.old_shells[s]))
        plan_.lost_segments.push_back(plan_.old_shells[s]);
    std::map<std::uint32_t, bool> goes_on;
    for (std::size_t s = 0; s < old_shells_.size(); ++s)
      for (const std::uint32_t set : old_shells_[s].sets)
        goes_on[set] = goes_on[set] || std::binary_search(followed.begin(), followed.end(), plan_.old_shells[s]);
    for (const auto& [set, goes] : goes_on)
      if (!goes)
        plan_.notes.push_back(card_of(*now_.relations, set) +
                              " gets no shell of the new mesh: none has its centre on a shell that it names");
  }

  void place_shells(const spatial::ShellTree& old_surface) {
    std::map<std::pair<std::int64_t, bool>, ShellIndex> free_by_id;
    std::optional<ShellIndex> plain;
    for (std::size_t s = 0; s < plan_.old_shells.size(); ++s) {
      const ShellIndex shell = plan_.old_shells[s];
      if (!plain && is_plain(old_shells_[s])) plain = shell;
      if (!kept_shells_.contains(shell))
        free_by_id.emplace(std::pair(model_.shell_ids[shell.value], model_.shell(shell).is_triangle()), shell);
    }
    bool noted = false, near = false;
    for (std::size_t s = 0; s < mesh_.shells.size(); ++s) {
      if (plan_.shell[s].valid()) {
        near = true;
        continue;
      }
      std::optional<spatial::SurfacePoint> on = old_surface.closest(shell_at_[s], tolerance_);
      near = near || on.has_value();
      if (!on && !plain) {
        on = old_surface.closest(shell_at_[s]);
        if (!std::exchange(noted, true))
          plan_.notes.push_back(
              "new shells away from the old mesh join the sets of the nearest old one, since each old one is in a set of some");
      }
      const ShellIndex parent = on ? on->shell : *plain;
      const auto same = free_by_id.find({mesh_.shells[s].id, is_triangle(s)});
      const auto may_stand = [&](ShellIndex old) { return old == parent || (!varies_ && is_plain(old) && is_plain(parent)); };
      if (same == free_by_id.end() || !may_stand(same->second)) {
        plan_.parent[s] = parent;
        continue;
      }
      plan_.shell[s] = same->second;
      kept_shells_.insert(same->second);
      free_by_id.erase(same);
    }
    if (!near)
      plan_.notes.push_back("no shell of the new mesh is within " + readable(tolerance_, 3) +
                            " of the old mesh: check where it stands, and its unit");
    find_lost_segments();
  }

  void remove_rest() {
    for (const ShellIndex shell : plan_.old_shells)
      if (!kept_shells_.contains(shell)) plan_.removed_shells.push_back(shell);
    for (const NodeIndex node : nodes_)
      if (!kept_.contains(node)) plan_.removed_nodes.push_back(node);
  }

  const Document& document_;
  const Generation& now_;
  const Model& model_;
  PartIndex part_;
  const VariantMesh& mesh_;
  double tolerance_;
  PartExchange plan_;
  NodeSet nodes_;                   ///< of the part
  bool varies_ = false;             ///< shells of the part have thicknesses of their own: a card must stay at its place
  std::vector<OldNode> old_nodes_;  ///< as nodes_
  std::vector<NamedOfPart::Naming> old_shells_;
  std::vector<Vec3> node_at_, shell_at_;  ///< of the mesh
  std::set<NodeIndex> kept_;
  std::set<ShellIndex> kept_shells_;
};

}  // namespace

PartExchange plan_exchange(const Document& document, PartIndex part, const VariantMesh& mesh, double tolerance) {
  return ExchangePlanner(document, part, mesh, tolerance).plan();
}

double default_tolerance(const VariantMesh& mesh) {
  std::unordered_map<std::int64_t, Vec3> at;
  for (const VariantMesh::Node& node : mesh.nodes) at.emplace(node.id, vector_of(node.at));
  double sum = 0;
  std::size_t sides = 0;
  for (const VariantMesh::Shell& shell : mesh.shells)
    for (std::size_t c = 0; c < 4; ++c) {
      if (shell.node[c] == shell.node[(c + 1) % 4]) continue;
      sum += (at.at(shell.node[c]) - at.at(shell.node[(c + 1) % 4])).norm();
      ++sides;
    }
  return sides > 0 ? kToleranceInSides * sum / static_cast<double>(sides) : 0;
}

}  // namespace prismesh::mesh::document
