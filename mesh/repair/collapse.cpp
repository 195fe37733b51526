#include "mesh/repair/collapse.h"

#include <algorithm>

#include "mesh/repair/local_size.h"
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

Refusal refuse_collapse(const RepairContext& context, const Collapse& pair, LocalNode& other_end) {
  const Patch& patch = context.patch;
  const PatchNode& gone = patch.node(pair.removed);
  if (!gone.is_whole || !patch.node(pair.kept).is_whole) return "a node there can't be worked on";
  if ((gone.rules & kNeeded) != 0) return "something else needs the node that would go";
  if (gone.freedom == relax::Freedom::fixed) return "both nodes hold the part's shape";
  if (gone.lines.empty()) return gone.freedom == relax::Freedom::surface ? Refusal() : Refusal("both nodes hold the part's shape");
  if (gone.lines.size() != 2 || patch.line(pair.removed, pair.kept) == nullptr) return "that would bend an edge of the part";
  const LineEnd& one = gone.lines[0];
  const LineEnd& two = gone.lines[1];
  if (one.is_rim || two.is_rim || one.shells != two.shells) return "that would bend an edge of the part";
  other_end = one.node == pair.kept ? two.node : one.node;
  const double off = distance_to_segment(gone.position, patch.position(pair.kept), patch.position(other_end));
  if (off > context.options.max_off_surface * target_size_at(context, pair.removed)) return "that would bend an edge of the part";
  return std::nullopt;
}

/// A shell's corners after the collapses, each node once. Fewer than three, also for a quad whose opposite corners meet: it is removed.
Loop united(const Corners& corners, const std::vector<Collapse>& collapses) {
  const auto count = static_cast<std::size_t>(corner_count(corners));
  Loop mapped;
  for (std::size_t i = 0; i < count; ++i) {
    const auto pair = std::find_if(collapses.begin(), collapses.end(), [&](const Collapse& u) { return u.removed == corners[i]; });
    mapped.push_back(pair == collapses.end() ? corners[i] : pair->kept);
  }
  if (count == 4 && (mapped[0] == mapped[2] || mapped[1] == mapped[3])) return {};
  Loop loop;
  for (std::size_t i = 0; i < count; ++i)
    if (mapped[i] != mapped[(i + 1) % count]) loop.push_back(mapped[i]);
  return loop;
}

}  // namespace

std::optional<Collapse> collapse_of(const RepairContext& context, LocalNode a, LocalNode b) {
  const Patch& patch = context.patch;
  const auto rank = [&](LocalNode n) {
    const PatchNode& node = patch.node(n);
    if ((node.rules & kNeeded) != 0 || !node.is_whole) return 4;
    if (node.freedom == relax::Freedom::fixed) return 3;
    if (!node.lines.empty() || node.freedom == relax::Freedom::line) return 2;
    return (node.rules & kStays) != 0 ? 1 : 0;
  };
  // The more constrained node stays; of equals the one with the lower index, which was there before.
  const int of_a = rank(a), of_b = rank(b);
  const bool a_goes = of_a < of_b || (of_a == of_b && a > b);
  const Collapse found = a_goes ? Collapse{a, b} : Collapse{b, a};
  if (std::min(of_a, of_b) > 2) return std::nullopt;
  return found;
}

Refusal collapse_nodes(const RepairContext& context, const std::vector<Collapse>& collapses) {
  Patch& patch = context.patch;
  std::vector<LocalNode> other_ends(collapses.size());
  for (std::size_t i = 0; i < collapses.size(); ++i) {
    if (const Refusal refusal = refuse_collapse(context, collapses[i], other_ends[i])) return refusal;
    for (std::size_t j = 0; j < collapses.size(); ++j)
      if (i != j && (collapses[i].removed == collapses[j].removed || collapses[i].removed == collapses[j].kept))
        return "the nodes run into each other";
  }
  std::vector<LocalShell> shells;
  for (const Collapse& pair : collapses)
    shells.insert(shells.end(), patch.node(pair.removed).shells.begin(), patch.node(pair.removed).shells.end());
  std::sort(shells.begin(), shells.end());
  shells.erase(std::unique(shells.begin(), shells.end()), shells.end());
  for (const LocalShell shell : shells) {
    const Loop loop = united(patch.shell(shell).corners, collapses);
    if (loop.size() < 3) {
      if ((patch.shell(shell).rules & kLasting) != 0) return "a shell there can't be removed";
      patch.remove_shell(shell);
      continue;
    }
    if (const Refusal refusal = refuse_reshaping(patch, shell, loop.size())) return refusal;
    patch.set_corners(shell, corners_along(patch, loop, first_edge(patch, shell)));
  }
  for (std::size_t i = 0; i < collapses.size(); ++i) {
    const PatchNode& gone = patch.node(collapses[i].removed);
    const PatchNode& stays = patch.node(collapses[i].kept);
    if (other_ends[i].valid()) {
      patch.join_lines(collapses[i].kept, collapses[i].removed, other_ends[i]);
    } else if (stays.lines.empty() && stays.freedom == relax::Freedom::surface && (stays.rules & kStays) == 0) {
      const Vec3 middle = 0.5 * (gone.position + stays.position);
      Vec3 normal = Vec3::Zero();
      for (const LocalShell shell : stays.shells) {
        const Vec3 own = area_normal(patch, patch.shell(shell).corners);
        normal += normal.dot(own) < 0 ? Vec3(-own) : own;
      }
      const auto place = on_surface(context, middle, normal, target_size_at(context, collapses[i].kept));
      if (place && within_limit(context, collapses[i].kept, *place)) patch.move(collapses[i].kept, *place);
    }
    patch.remove_node(collapses[i].removed);
  }
  return std::nullopt;
}

}  // namespace prismesh::mesh::repair
