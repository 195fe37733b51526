#include "mesh/repair/unite.h"

#include <algorithm>

#include "mesh/repair/patch_geometry.h"
#include "mesh/repair/placement.h"

namespace prismesh::mesh::repair {

namespace {

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

Refusal refuse_union(const RepairContext& context, const Union& pair, LocalNode& other_end) {
  const Patch& patch = context.patch;
  const PatchNode& gone = patch.node(pair.gone);
  if (!gone.is_whole || !patch.node(pair.stays).is_whole) return "a node there can't be worked on";
  if ((gone.rules & kNeeded) != 0) return "something else needs the node that would go";
  if (gone.freedom == relax::Freedom::fixed) return "both nodes hold the part's shape";
  if (gone.lines.empty()) return gone.freedom == relax::Freedom::surface ? Refusal() : Refusal("both nodes hold the part's shape");
  if (gone.lines.size() != 2 || patch.line(pair.gone, pair.stays) == nullptr) return "that would bend an edge of the part";
  const LineEnd& one = gone.lines[0];
  const LineEnd& two = gone.lines[1];
  if (one.is_rim || two.is_rim || one.shells != two.shells) return "that would bend an edge of the part";
  other_end = one.node == pair.stays ? two.node : one.node;
  const double off = distance_to_segment(gone.position, patch.position(pair.stays), patch.position(other_end));
  if (off > context.options.most_off_surface * context.criteria.target_size) return "that would bend an edge of the part";
  return std::nullopt;
}

/// A shell's corners after the unions, each node once; fewer than three: it goes. A quad whose opposite corners meet goes as well.
Loop united(const Corners& corners, const std::vector<Union>& unions) {
  const auto count = static_cast<std::size_t>(corner_count(corners));
  Loop mapped;
  for (std::size_t i = 0; i < count; ++i) {
    const auto pair = std::find_if(unions.begin(), unions.end(), [&](const Union& u) { return u.gone == corners[i]; });
    mapped.push_back(pair == unions.end() ? corners[i] : pair->stays);
  }
  if (count == 4 && (mapped[0] == mapped[2] || mapped[1] == mapped[3])) return {};
  Loop loop;
  for (std::size_t i = 0; i < count; ++i)
    if (mapped[i] != mapped[(i + 1) % count]) loop.push_back(mapped[i]);
  return loop;
}

}  // namespace

std::optional<Union> union_of(const RepairContext& context, LocalNode a, LocalNode b) {
  const Patch& patch = context.patch;
  const auto rank = [&](LocalNode n) {
    const PatchNode& node = patch.node(n);
    if ((node.rules & kNeeded) != 0 || !node.is_whole) return 4;
    if (node.freedom == relax::Freedom::fixed) return 3;
    if (!node.lines.empty() || node.freedom == relax::Freedom::line) return 2;
    return (node.rules & kStays) != 0 ? 1 : 0;
  };
  // The more constrained node stays; of equals the one that was there before.
  const int of_a = rank(a), of_b = rank(b);
  const bool a_goes = of_a < of_b || (of_a == of_b && a > b);
  const Union found = a_goes ? Union{a, b} : Union{b, a};
  if (std::min(of_a, of_b) > 2) return std::nullopt;
  return found;
}

Refusal unite(const RepairContext& context, const std::vector<Union>& unions) {
  Patch& patch = context.patch;
  std::vector<LocalNode> other_ends(unions.size());
  for (std::size_t i = 0; i < unions.size(); ++i) {
    if (const Refusal refusal = refuse_union(context, unions[i], other_ends[i])) return refusal;
    for (std::size_t j = 0; j < unions.size(); ++j)
      if (i != j && (unions[i].gone == unions[j].gone || unions[i].gone == unions[j].stays)) return "the nodes run into each other";
  }
  std::vector<LocalShell> shells;
  for (const Union& pair : unions) shells.insert(shells.end(), patch.node(pair.gone).shells.begin(), patch.node(pair.gone).shells.end());
  std::sort(shells.begin(), shells.end());
  shells.erase(std::unique(shells.begin(), shells.end()), shells.end());
  for (const LocalShell shell : shells) {
    const Loop loop = united(patch.shell(shell).corners, unions);
    if (loop.size() < 3) {
      if ((patch.shell(shell).rules & kLasting) != 0) return "a shell there can't be removed";
      patch.remove_shell(shell);
      continue;
    }
    if (const Refusal refusal = refuse_reshaping(patch, shell, loop.size())) return refusal;
    patch.set_corners(shell, turned_like(patch, loop, first_edge(patch, shell)));
  }
  for (std::size_t i = 0; i < unions.size(); ++i) {
    const PatchNode& gone = patch.node(unions[i].gone);
    const PatchNode& stays = patch.node(unions[i].stays);
    if (other_ends[i].valid()) {
      patch.join_lines(unions[i].stays, unions[i].gone, other_ends[i]);
    } else if (stays.lines.empty() && stays.freedom == relax::Freedom::surface && (stays.rules & kStays) == 0) {
      const Vec3 middle = 0.5 * (gone.position + stays.position);
      Vec3 normal = Vec3::Zero();
      for (const LocalShell shell : stays.shells) {
        const Vec3 own = area_normal(patch, patch.shell(shell).corners);
        normal += normal.dot(own) < 0 ? Vec3(-own) : own;
      }
      const auto place = on_surface(context, middle, normal, context.criteria.target_size);
      if (place && within_limit(context, unions[i].stays, *place)) patch.move(unions[i].stays, *place);
    }
    patch.remove_node(unions[i].gone);
  }
  return std::nullopt;
}

}  // namespace prismesh::mesh::repair
