#include "mesh/connections/find_joined_sheets.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "mesh/connections/sheet_reach.h"
#include "mesh/connections/sheets_near.h"
#include "mesh/connections/touching_sheets.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::connections {

namespace {

/// A share of a shell's longest side. Shells count as equally close to an end if their distances differ by no more.
constexpr double kEquallyClose = 1e-3;

void add_elements(const Model& model, std::vector<Joint>& joints) {
  for (const ElementClass kind :
       {ElementClass::beam, ElementClass::solid, ElementClass::tshell, ElementClass::discrete, ElementClass::other}) {
    const auto& block = model.elements[static_cast<std::size_t>(kind)];
    if (!block) continue;
    for (std::size_t e = 0; e < block->size(); ++e) {
      std::size_t end = block->first_node[e + 1];
      if (kind == ElementClass::beam) end = std::min<std::size_t>(end, block->first_node[e] + 2);  // the third node only orients it
      NodeSet ends(block->nodes.begin() + block->first_node[e], block->nodes.begin() + static_cast<std::ptrdiff_t>(end));
      std::erase_if(ends, [](NodeIndex node) { return !node.valid(); });
      std::sort(ends.begin(), ends.end());
      ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
      if (ends.size() > 1) joints.push_back({std::move(ends), kind, e});
    }
  }
}

/// Finds the shells that an end of a joint lies on.
class ShellsAtEnds {
 public:
  ShellsAtEnds(const Model& model, OutOfSight out_of_sight, std::span<const Joint> joints)
      : model_(model), out_of_sight_(out_of_sight), sheets_(model, loose_ends(model, joints), out_of_sight) {}

  ShellSet of(NodeIndex node) const {
    ShellSet at;
    for (const ShellIndex shell : model_.adjacency->shells_of(node))
      if (in_sight(model_, shell, out_of_sight_)) at.push_back(shell);
    if (!at.empty() || sheets_.empty()) return at;
    const Vec3& point = model_.position(node);
    const auto closest = sheets_.tree().closest(point);
    if (!closest || closest->distance > sheet_reach(model_, closest->shell, Attachment::placed)) return {};
    const double as_close = closest->distance + kEquallyClose * max_side(model_, closest->shell);
    for (const spatial::SurfacePoint& other : sheets_.tree().within(point, as_close)) at.push_back(other.shell);
    return at;
  }

 private:
  /// The ends that are no nodes of shells.
  static NodeSet loose_ends(const Model& model, std::span<const Joint> joints) {
    NodeSet loose;
    for (const Joint& joint : joints)
      for (const NodeIndex node : joint.ends)
        if (model.adjacency->shells_of(node).empty()) loose.push_back(node);
    std::sort(loose.begin(), loose.end());
    loose.erase(std::unique(loose.begin(), loose.end()), loose.end());
    return loose;
  }

  const Model& model_;
  OutOfSight out_of_sight_;
  SheetsNear sheets_;
};

bool touch(const Model& model, const ShellSet& a, const ShellSet& b) {
  for (const ShellIndex shell : a)
    for (const NodeIndex node : model.shell(shell).node)
      for (const ShellIndex other : model.adjacency->shells_of(node))
        if (std::binary_search(b.begin(), b.end(), other)) return true;
  return false;
}

void join(const Model& model, const NodeSet& ends, const ShellsAtEnds& shells_at_ends, std::vector<JoinedSheets::Pair>& pairs) {
  std::vector<ShellSet> on;
  for (const NodeIndex node : ends) on.push_back(shells_at_ends.of(node));
  for (std::size_t i = 0; i < ends.size(); ++i)
    for (std::size_t j = i + 1; j < ends.size(); ++j) {
      if (on[i].empty() || on[j].empty() || touch(model, on[i], on[j])) continue;
      double longest = 0;
      for (const ShellIndex shell : on[i]) longest = std::max(longest, max_side(model, shell));
      for (const ShellIndex shell : on[j]) longest = std::max(longest, max_side(model, shell));
      if ((model.position(ends[i]) - model.position(ends[j])).norm() > kMaxJointInSides * longest) continue;
      for (const ShellIndex a : on[i])
        for (const ShellIndex b : on[j]) pairs.emplace_back(a, b);
    }
}

void join_tied(const Model& model, const NodeOnSheet& tied, OutOfSight out_of_sight, std::vector<JoinedSheets::Pair>& pairs) {
  if (!in_sight(model, tied.shell, out_of_sight)) return;
  if (!spatial::ShellTree(model, {tied.shell}).closest(model.position(tied.node), tied.reach)) return;
  for (const ShellIndex shell : model.adjacency->shells_of(tied.node))
    if (in_sight(model, shell, out_of_sight)) pairs.emplace_back(shell, tied.shell);
}

}  // namespace

std::vector<Joint> possible_joints(const Model& model, std::span<const NodeSet> cards) {
  std::vector<Joint> joints;
  add_elements(model, joints);
  for (std::size_t c = 0; c < cards.size(); ++c)
    if (cards[c].size() > 1) joints.push_back({cards[c], std::nullopt, c});
  return joints;
}

std::vector<std::vector<JoinedSheets::Pair>> joined_by_each(const Model& model, std::span<const Joint> joints, OutOfSight out_of_sight) {
  const ShellsAtEnds shells_at_ends(model, out_of_sight, joints);
  std::vector<std::vector<JoinedSheets::Pair>> pairs(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) join(model, joints[j].ends, shells_at_ends, pairs[j]);
  return pairs;
}

std::vector<JoinedSheets::Pair> joined_by_ties(const Model& model, std::span<const NodeOnSheet> on_sheets, OutOfSight out_of_sight) {
  std::vector<JoinedSheets::Pair> pairs;
  for (const NodeOnSheet& each : on_sheets)
    if (each.tied) join_tied(model, each, out_of_sight, pairs);
  return pairs;
}

std::vector<JoinedSheets::Pair> find_joints(const Model& model, std::span<const NodeSet> cards, OutOfSight out_of_sight,
                                            std::span<const NodeOnSheet> on_sheets) {
  const std::vector<Joint> joints = possible_joints(model, cards);
  const ShellsAtEnds shells_at_ends(model, out_of_sight, joints);
  std::vector<JoinedSheets::Pair> pairs;
  for (const Joint& joint : joints) join(model, joint.ends, shells_at_ends, pairs);
  const std::vector<JoinedSheets::Pair> tied = joined_by_ties(model, on_sheets, out_of_sight);
  pairs.insert(pairs.end(), tied.begin(), tied.end());
  return pairs;
}

JoinedSheets find_joined_sheets(const Model& model, std::span<const NodeSet> cards, OutOfSight out_of_sight,
                                std::span<const NodeOnSheet> on_sheets) {
  std::vector<JoinedSheets::Pair> pairs = find_joints(model, cards, out_of_sight, on_sheets);
  std::vector<std::uint32_t> sheet_numbers = number_sheets(model, out_of_sight);
  const std::vector<JoinedSheets::Pair> touching = find_touching(model, sheet_numbers, pairs, out_of_sight);
  pairs.insert(pairs.end(), touching.begin(), touching.end());
  return {std::move(pairs), std::move(sheet_numbers)};
}

}  // namespace prismesh::mesh::connections
