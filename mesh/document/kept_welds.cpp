#include "mesh/document/kept_welds.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <tuple>

#include "mesh/document/connections_kept.h"
#include "mesh/document/followers.h"

namespace prismesh::mesh::document {

namespace {

/// By index of the card; those that let sheets move have no nodes here.
std::vector<NodeSet> nodes_of_joining_cards(const Dependents& dependents) {
  std::vector<NodeSet> cards;
  for (const JoiningCard& card : dependents.joining_cards) cards.push_back(card.joins_sheets ? card.nodes : NodeSet());
  return cards;
}

/// Cards come last.
std::tuple<bool, int, std::size_t> order_of(const std::optional<ElementClass>& element_class, std::size_t of) {
  return {!element_class, element_class ? static_cast<int>(*element_class) : 0, of};
}

std::vector<std::pair<PartIndex, PartIndex>> parts_of(const Model& model, const std::vector<connections::JoinedSheets::Pair>& pairs) {
  std::vector<std::pair<PartIndex, PartIndex>> parts;
  for (const auto& [a, b] : pairs) parts.emplace_back(std::minmax(model.shell_parts[a.value], model.shell_parts[b.value]));
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
  return parts;
}

/// A corner of a solid and the three that its edges lead to, seen from within anticlockwise.
using SolidCorner = std::array<std::uint8_t, 4>;
constexpr std::array<SolidCorner, 4> kTetrahedron{{{0, 1, 2, 3}, {1, 2, 0, 3}, {2, 0, 1, 3}, {3, 0, 2, 1}}};
constexpr std::array<SolidCorner, 6> kWedge{{{0, 1, 2, 3}, {1, 2, 0, 4}, {2, 0, 1, 5}, {3, 5, 4, 0}, {4, 3, 5, 1}, {5, 4, 3, 2}}};
constexpr std::array<SolidCorner, 8> kBrick{
    {{0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6}, {3, 0, 2, 7}, {4, 7, 5, 0}, {5, 4, 6, 1}, {6, 5, 7, 2}, {7, 6, 4, 3}}};

/// Of an element by its number of nodes, those in the middles of sides included; none: not known.
std::span<const SolidCorner> corners_of(std::size_t nodes) {
  switch (nodes) {
    case 4:
    case 10: return kTetrahedron;
    case 6:
    case 15: return kWedge;
    case 8:
    case 20: return kBrick;
    default: return {};
  }
}

/// Six times the volume at a corner.
double volume_at(const Model& model, std::span<const NodeIndex> nodes, const SolidCorner& corner) {
  const Vec3& at = model.position(nodes[corner[0]]);
  const auto to = [&](std::uint8_t other) { return Vec3(model.position(nodes[other]) - at); };
  return to(corner[1]).cross(to(corner[2])).dot(to(corner[3]));
}

}  // namespace

KeptWelds::KeptWelds(const Generation& generation)
    : generation_(generation),
      joints_(connections::possible_joints(generation.model, nodes_of_joining_cards(generation.relations->dependents))),
      joined_(connections::joined_by_each(generation.model, joints_, {})) {
  for (std::size_t j = 0; j < joints_.size(); ++j)
    for (const auto& [a, b] : joined_[j])
      for (const ShellIndex shell : {a, b}) joints_at_.emplace_back(shell, static_cast<std::uint32_t>(j));
  std::sort(joints_at_.begin(), joints_at_.end());
  joints_at_.erase(std::unique(joints_at_.begin(), joints_at_.end()), joints_at_.end());
}

const connections::Joint* KeptWelds::joint_of(std::optional<ElementClass> element_class, std::size_t of) const {
  const auto wanted = order_of(element_class, of);
  const auto at = std::lower_bound(joints_.begin(), joints_.end(), wanted, [](const connections::Joint& joint, const auto& order) {
    return order_of(joint.element_class, joint.of) < order;
  });
  return at != joints_.end() && order_of(at->element_class, at->of) == wanted ? &*at : nullptr;
}

bool KeptWelds::joins(const connections::Joint* joint) const {
  return joint != nullptr && !joined_[static_cast<std::size_t>(joint - joints_.data())].empty();
}

bool KeptWelds::may_follow(const ElementUse& use) const {
  const ElementBlock& block = *generation_.model.elements[static_cast<std::size_t>(use.element_class)];
  return block.first_node[use.element + 1] - block.first_node[use.element] == 1 || joins(joint_of(use.element_class, use.element));
}

bool KeptWelds::may_follow(std::uint32_t card) const { return joins(joint_of(std::nullopt, card)); }

std::vector<connections::JoinedSheets::Pair> KeptWelds::pairs() const {
  std::vector<connections::JoinedSheets::Pair> all;
  for (const auto& pairs : joined_) all.insert(all.end(), pairs.begin(), pairs.end());
  const auto tied = connections::joined_by_ties(generation_.model, generation_.relations->dependents.on_sheets, {});
  all.insert(all.end(), tied.begin(), tied.end());
  return all;
}

NodeSet KeptWelds::carry(const Model& before, const NodeSet& moved, Model& after) const {
  NodeSet carried;
  for (const FollowerNode& follower : find_weld_followers(generation_, before, moved)) {
    Vec3 by = Vec3::Zero();
    for (std::size_t i = 0; i < follower.leader.size(); ++i)
      if (const NodeIndex leader = follower.leader[i]; leader.valid())
        by += follower.share[i] * (after.position(leader) - before.position(leader));
    if (by.isZero(0)) continue;
    after.positions.set(follower.node.value, before.position(follower.node) + by);
    carried.push_back(follower.node);
  }
  return carried;
}

std::string KeptWelds::why_lost(const Model& before, const Model& after, const NodeSet& moved) const {
  std::string why = why_off_sheet(before, after, moved);
  if (why.empty()) why = why_torn(before, after, moved);
  if (why.empty()) why = why_inside_out(before, after, moved);
  return why;
}

std::string KeptWelds::why_off_sheet(const Model& before, const Model& after, const NodeSet& moved) const {
  const Dependents& dependents = generation_.relations->dependents;
  for (const std::uint32_t r : doubtful_connections(dependents, before, moved)) {
    const NodeOnSheet& rest = dependents.on_sheets[r];
    const double gap = gap_from_sheet(after, rest);
    if (gap > rest.reach && gap_from_sheet(before, rest) <= rest.reach)
      return "a weld or tie would be lost: " + lost_connection(generation_, rest, gap);
  }
  return {};
}

std::string KeptWelds::name_of(const connections::Joint& joint) const {
  if (!joint.element_class) return card_of(*generation_.relations, generation_.relations->dependents.joining_cards[joint.of].referrer);
  const auto kind = static_cast<std::size_t>(*joint.element_class);
  return std::string(name(*joint.element_class)) + ":" + std::to_string(generation_.model.elements[kind]->id[joint.of]);
}

std::string KeptWelds::why_torn(const Model& before, const Model& after, const NodeSet& moved) const {
  std::vector<std::uint32_t> doubtful;
  auto at = joints_at_.begin();
  for (const ShellIndex shell : shells_touching(before, moved)) {
    at = std::lower_bound(at, joints_at_.end(), std::pair(shell, std::uint32_t{0}));
    for (; at != joints_at_.end() && at->first == shell; ++at) doubtful.push_back(at->second);
  }
  std::sort(doubtful.begin(), doubtful.end());
  doubtful.erase(std::unique(doubtful.begin(), doubtful.end()), doubtful.end());
  if (doubtful.empty()) return {};
  std::vector<connections::Joint> joints;
  for (const std::uint32_t joint : doubtful) joints.push_back(joints_[joint]);
  const auto joined = connections::joined_by_each(after, joints, {});
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto had = parts_of(before, joined_[doubtful[j]]), has = parts_of(after, joined[j]);
    if (!std::includes(has.begin(), has.end(), had.begin(), had.end()))
      return "a weld would be lost: " + name_of(joints[j]) + " would no longer join what it joins";
  }
  return {};
}

std::string KeptWelds::why_inside_out(const Model& before, const Model& after, const NodeSet& moved) const {
  for (const NodeIndex node : moved)
    for (const ElementUse& use : uses_at(*generation_.relations, node)) {
      if (use.element_class != ElementClass::solid && use.element_class != ElementClass::tshell) continue;
      const ElementBlock& block = *before.elements[static_cast<std::size_t>(use.element_class)];
      const std::span<const NodeIndex> nodes(block.nodes.data() + block.first_node[use.element],
                                             block.first_node[use.element + 1] - block.first_node[use.element]);
      if (std::any_of(nodes.begin(), nodes.end(), [](NodeIndex each) { return !each.valid(); })) continue;
      for (const SolidCorner& corner : corners_of(nodes.size()))
        if (volume_at(before, nodes, corner) > 0 && !(volume_at(after, nodes, corner) > 0))
          return std::string(name(use.element_class)) + ":" + std::to_string(block.id[use.element]) + " would turn inside out";
    }
  return {};
}

}  // namespace prismesh::mesh::document
