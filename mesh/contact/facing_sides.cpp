#include "mesh/contact/facing_sides.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>

#include <Eigen/Geometry>

#include "mesh/contact/close_shells.h"
#include "mesh/contact/lift_apart.h"
#include "mesh/contact/shares_node.h"
#include "mesh/contact/sort_unique.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::contact {

namespace {

constexpr double kMinShareOfThickness = 0.05;  ///< what stays between middle surfaces, however deep they may stay
constexpr double kMinLiftShare = 1e-6;         ///< of the least distance: shorter lifts count as none
constexpr double kSweepInReaches = 4;          ///< how far out of a penetration is looked for shells of the other side

Vec3 area_vector(const Model& model, ShellIndex shell) {
  Vec3 vector = Vec3::Zero();
  each_shell_triangle(model, shell, [&](const ShellTriangle& t) { vector += (t.at[1] - t.at[0]).cross(t.at[2] - t.at[0]); });
  return vector;
}

Eigen::AlignedBox3d box_of(const Model& model, const ShellSet& shells) {
  Eigen::AlignedBox3d box;
  for (const ShellIndex shell : shells)
    for (const NodeIndex node : model.shell(shell).node)
      if (model.position(node).allFinite()) box.extend(model.position(node));
  return box;
}

bool has(const ShellSet& shells, ShellIndex shell) { return std::binary_search(shells.begin(), shells.end(), shell); }

ShellSet with_neighbours(const Model& model, const ShellSet& shells, const ShellSet& without) {
  ShellSet grown = shells;
  for (const ShellIndex shell : shells)
    for (const NodeIndex node : model.shell(shell).node)
      for (const ShellIndex neighbour : model.adjacency->shells_of(node))
        if (!has(without, neighbour)) grown.push_back(neighbour);
  sort_unique(grown);
  return grown;
}

double max_thickness_of(const ContactThickness& thickness, const ShellSet& shells) {
  double max = 0;
  for (const ShellIndex shell : shells) max = std::max(max, thickness.of_shell[shell.value]);
  return max;
}

}  // namespace

FacingSides::FacingSides(const SeparationInput& input, const SeparationWish& wish, const Model& model, const spatial::BoxTree& tree,
                         const MeantRegion& region, bool each_its_own)
    : input_(input), wish_(wish), model_(model), tree_(tree), region_(region), lower_(region.shells[region.lower()]) {
  ShellSet seeds = region.shells[region.upper];
  for (const NodeIndex node : region.entering)
    for (const ShellIndex shell : model.adjacency->shells_of(node)) seeds.push_back(shell);
  sort_unique(seeds);
  upper_ = seeds;
  reach_ = (max_thickness_of(input.thickness, upper_) + max_thickness_of(input.thickness, lower_)) / 2 + wish.gap;
  const NodeSet nodes = nodes_of(model, upper_);
  direction_ = mean_way(spatial::ShellTree(model, lower_), nodes);
  grow_lower(direction_);
  direction_ = mean_way(spatial::ShellTree(model, lower_), nodes);
  if (wish.direction) {
    Vec3 wished = wish.direction->normalized();
    if (wished.dot(direction_) < 0) wished = -wished;
    cos_of_wish_ = wished.dot(direction_);
    direction_ = wished;
  }
  upper_ = with_neighbours(model, upper_, lower_);
  top_ = -std::numeric_limits<double>::infinity();
  for (const ShellIndex shell : lower_)
    for (const NodeIndex node : model.shell(shell).node) top_ = std::max(top_, model.position(node).dot(direction_));
  if (each_its_own) find_own_ways();
}

double FacingSides::least(ShellIndex a, ShellIndex b) const {
  const double mean = input_.thickness.between(a, b);
  return std::max(mean + wish_.gap - wish_.allowed_depth, mean > 0 ? kMinShareOfThickness * mean : wish_.gap);
}

bool FacingSides::is_entering(NodeIndex node) const { return std::binary_search(region_.entering.begin(), region_.entering.end(), node); }

bool FacingSides::any_stands() const {
  const auto stands = [&](ShellIndex shell) {
    const Vec3 vector = area_vector(model_, shell);
    return std::abs(vector.dot(direction_)) < kMinCosOfFacing * vector.norm();
  };
  for (const ShellSet& side : region_.shells)
    if (std::any_of(side.begin(), side.end(), stands)) return true;
  return std::any_of(region_.entering.begin(), region_.entering.end(), [&](NodeIndex node) {
    const auto shells = model_.adjacency->shells_of(node);
    return std::any_of(shells.begin(), shells.end(), stands);
  });
}

/// The other side's normal at the closest point, to the side on which the node must be; weighted by how much is missing there.
FacingSides::OwnWay FacingSides::way_at(const spatial::ShellTree& lower, NodeIndex node) const {
  const Vec3& point = model_.position(node);
  const auto closest = lower.closest(point);
  if (!closest) return {Vec3::Zero(), 0};
  const Vec3 normal = area_vector(model_, closest->shell).normalized();
  const Vec3 away = is_entering(node) ? Vec3(closest->point - point) : Vec3(point - closest->point);
  const double missing = is_entering(node) ? reach_ + closest->distance : std::max(reach_ - closest->distance, 0.0);
  if (closest->distance <= 1e-9 * reach_) return {normal, 0};
  const double along = normal.dot(away) / closest->distance;
  return {along < 0 ? Vec3(-normal) : normal, missing * std::abs(along)};
}

Vec3 FacingSides::mean_way(const spatial::ShellTree& lower, const NodeSet& nodes) const {
  Vec3 sum = Vec3::Zero(), undecided = Vec3::Zero();
  for (const NodeIndex node : nodes) {
    const OwnWay way = way_at(lower, node);
    sum += way.weight * way.direction;
    if (way.weight == 0) undecided += way.direction;
  }
  if (sum.norm() > 0) return sum.normalized();
  return undecided.norm() > 0 ? Vec3(undecided.normalized()) : Vec3(Vec3::UnitZ());
}

/// Adds the shells of the lower sheet that the upper side is above or could get above.
void FacingSides::grow_lower(const Vec3& direction) {
  Eigen::AlignedBox3d box = box_of(model_, upper_);
  if (box.isEmpty()) return;
  const Vec3 sweep = (region_.way + reach_) * direction;
  box.extend(box.min() + sweep).extend(box.max() + sweep);
  box.min().array() -= reach_, box.max().array() += reach_;
  ShellSet grown = lower_;
  std::set<ShellIndex> seen(upper_.begin(), upper_.end());
  seen.insert(lower_.begin(), lower_.end());
  for (std::size_t next = 0; next < grown.size(); ++next)
    for (const NodeIndex node : model_.shell(grown[next]).node)
      for (const ShellIndex shell : model_.adjacency->shells_of(node)) {
        if (!seen.insert(shell).second) continue;
        const Vec3 vector = area_vector(model_, shell);
        if (std::abs(vector.dot(direction)) < kMinCosOfFacing * vector.norm()) continue;
        if (box_of(model_, {shell}).intersects(box)) grown.push_back(shell);
      }
  sort_unique(grown);
  lower_ = std::move(grown);
}

void FacingSides::find_own_ways() {
  const spatial::ShellTree lower_tree(model_, lower_), upper_tree(model_, upper_);
  for (const NodeIndex node : nodes_of(model_, upper_)) {
    const OwnWay way = way_at(lower_tree, node);
    own_ways_[node] = way.weight == 0 && way.direction.dot(direction_) < 0 ? Vec3(-way.direction) : way.direction;
  }
  for (const NodeIndex node : nodes_of(model_, lower_)) {
    const OwnWay way = way_at(upper_tree, node);  // away from the upper side
    own_ways_.emplace(node, way.weight == 0 && way.direction.dot(direction_) > 0 ? way.direction : Vec3(-way.direction));
  }
}

Vec3 FacingSides::way_of(NodeIndex node) const {
  const auto own = own_ways_.find(node);
  return own != own_ways_.end() ? own->second : direction_;
}

/// How far a triangle must go along `way` of length 1, and which of its corners. If corners that stay must go, they are among them.
FacingSides::CornerLift FacingSides::lift_of(const ShellTriangle& moving, const ShellTriangle& fixed, const Vec3& way, double apart) const {
  CornerLift lift{lift_apart(moving.at, fixed.at, way, apart)};
  if (!(lift.length > kMinLiftShare * reach_)) return {0};
  std::array<bool, 3> is_free{};
  for (std::size_t i = 0; i < 3; ++i) is_free[i] = input_.why_stays(moving.node[i]).empty();
  if (is_free[0] && is_free[1] && is_free[2]) return lift;
  if (const auto of_free = lift_corners_apart(moving.at, is_free, fixed.at, way, apart)) return {*of_free, is_free};
  return lift;
}

double FacingSides::lift_shell(const Model& moved, const SideLifts& now, double upper_share, ShellIndex shell, SideLifts& needed) {
  Eigen::AlignedBox3d box = box_of(moved, {shell});
  if (box.isEmpty()) return 0;
  Vec3 way = Vec3::Zero();
  double lowest = std::numeric_limits<double>::infinity();
  for (const NodeIndex node : moved.shell(shell).node) {
    way += way_of(node);
    lowest = std::min(lowest, moved.position(node).dot(direction_));
  }
  way.normalize();
  const double height = region_.perforation ? std::max(top_ - lowest, 0.0) + reach_ : kSweepInReaches * reach_ / cos_of_wish_;
  box.extend(box.min() + height * way).extend(box.max() + height * way);
  const auto add = [&](Lifts& lifts, const Lifts& current, NodeIndex node, double length) {
    const auto at = current.find(node);
    const double whole = length + (at != current.end() ? at->second.length : 0);
    const auto [entry, is_new] = lifts.emplace(node, Lift{whole, way_of(node)});
    if (!is_new) entry->second.length = std::max(entry->second.length, whole);
  };
  double longest = 0;
  tree_.near_box(box.min(), box.max(), reach_ + lower_moved_, [&](ShellIndex other, const spatial::FloatBox&) {
    if (!has(lower_, other) || share_a_node(moved.shell(shell), moved.shell(other))) return true;
    const double apart = least(shell, other);
    each_shell_triangle(moved, shell, [&](const ShellTriangle& own) {
      each_shell_triangle(moved, other, [&](const ShellTriangle& its) {
        Vec3 pair_way = Vec3::Zero();
        for (const NodeIndex node : own.node) pair_way += way_of(node);
        if (upper_share < 1)
          for (const NodeIndex node : its.node) pair_way += way_of(node);
        pair_way.normalize();
        const bool moves_upper = upper_share > 0, moves_lower = upper_share < 1;
        CornerLift lift{0};
        if (!moves_lower)
          lift = lift_of(own, its, pair_way, apart);
        else if (!moves_upper)
          lift = lift_of(its, own, -pair_way, apart);
        else
          lift.length = lift_apart(own.at, its.at, pair_way, apart);
        if (!(lift.length > kMinLiftShare * reach_)) return;
        longest = std::max(longest, lift.length);
        for (std::size_t i = 0; i < 3; ++i) {
          if (!lift.corners[i]) continue;
          if (moves_upper) add(needed.upper, now.upper, own.node[i], upper_share * lift.length);
          if (moves_lower) add(needed.lower, now.lower, its.node[i], (1 - upper_share) * lift.length);
        }
      });
    });
    return true;
  });
  return longest;
}

double FacingSides::add_missing(const Model& moved, const SideLifts& now, double upper_share, SideLifts& needed) {
  lower_moved_ = 0;
  for (const auto& [node, lift] : now.lower) lower_moved_ = std::max(lower_moved_, lift.length);
  double longest = 0;
  // Where more of the upper side is lifted, more of the lower one may be in its way.
  for (std::size_t below = 0; below != lower_.size();) {
    below = lower_.size();
    longest = std::max(longest, lift_upper(moved, now, upper_share, needed));
    grow_lower(direction_);
  }
  return longest;
}

void FacingSides::add_missing_of_nodes(double upper_share, SideLifts& needed) const {
  if (upper_share > 0) add_missing_of_nodes(upper_, lower_, 1, upper_share, needed.upper);
  if (upper_share < 1) add_missing_of_nodes(lower_, upper_, -1, 1 - upper_share, needed.lower);
}

/// `sign`: along the nodes' ways, or against them.
void FacingSides::add_missing_of_nodes(const ShellSet& moving, const ShellSet& fixed, double sign, double share, Lifts& needed) const {
  const double height = region_.perforation ? region_.way + reach_ : kSweepInReaches * reach_ / cos_of_wish_;
  for (const NodeIndex node : nodes_of(model_, moving)) {
    const Vec3& at = model_.position(node);
    if (!at.allFinite() || !input_.why_stays(node).empty()) continue;
    const Vec3 way = sign * way_of(node);
    Eigen::AlignedBox3d box(at);
    box.extend(at + height * way);
    double longest = 0;
    tree_.near_box(box.min(), box.max(), reach_, [&](ShellIndex other, const spatial::FloatBox&) {
      const ShellNodes& its = model_.shell(other);
      if (!has(fixed, other) || std::find(its.node.begin(), its.node.end(), node) != its.node.end()) return true;
      double apart = 0;
      for (const ShellIndex own : model_.adjacency->shells_of(node))
        if (has(moving, own) && !share_a_node(model_.shell(own), its)) apart = std::max(apart, least(own, other));
      if (!(apart > 0)) return true;
      each_shell_triangle(model_, other, [&](const ShellTriangle& t) {
        longest = std::max(longest, lift_apart({at, at, at}, t.at, way, apart));
      });
      return true;
    });
    if (longest > kMinLiftShare * reach_) needed.emplace(node, Lift{share * longest, way_of(node)});
  }
}

/// Lifts shell by shell, and the neighbours of what is lifted.
double FacingSides::lift_upper(const Model& moved, const SideLifts& now, double upper_share, SideLifts& needed) {
  double longest = 0;
  for (ShellSet front = upper_; !front.empty();) {
    ShellSet lifted;
    for (const ShellIndex shell : front) {
      const double lift = lift_shell(moved, now, upper_share, shell, needed);
      longest = std::max(longest, lift);
      if (lift > 0) lifted.push_back(shell);
    }
    // What is lifted has neighbours that may be too close as well.
    const ShellSet grown = with_neighbours(model_, lifted, lower_);
    front.clear();
    std::set_difference(grown.begin(), grown.end(), upper_.begin(), upper_.end(), std::back_inserter(front));
    upper_.insert(upper_.end(), front.begin(), front.end());
    sort_unique(upper_);
  }
  return longest;
}

}  // namespace prismesh::mesh::contact
