#include "mesh/repair/divide.h"

#include <algorithm>
#include <cmath>

#include "mesh/repair/cuts.h"
#include "mesh/repair/patch_geometry.h"
#include "mesh/repair/placement.h"

namespace prismesh::mesh::repair {

namespace {

std::optional<EdgeAt> across(const Patch& patch, const EdgeAt& at, bool& is_end) {
  const Corners& corners = patch.shell(at.shell).corners;
  const auto count = static_cast<std::size_t>(corner_count(corners));
  const LocalNode a = corners[at.edge], b = corners[(at.edge + 1) % count];
  const std::vector<LocalShell> shells = patch.shells_at(a, b);
  is_end = shells.size() == 1;
  if (shells.size() != 2) return std::nullopt;
  const LocalShell other = shells[0] == at.shell ? shells[1] : shells[0];
  const Corners& theirs = patch.shell(other).corners;
  const auto their_count = static_cast<std::size_t>(corner_count(theirs));
  for (std::size_t e = 0; e < their_count; ++e)
    if (edge_key(theirs[e], theirs[(e + 1) % their_count]) == edge_key(a, b)) return EdgeAt{other, e};
  return std::nullopt;
}

/// A row's quads from the start in one direction, each with the edge by which it is entered, and the shell beyond them.
struct Walk {
  std::vector<EdgeAt> quads;
  std::optional<EdgeAt> beyond;
};

std::optional<Walk> walk(const Patch& patch, EdgeAt out, int steps) {
  Walk found;
  bool is_end = false;
  for (int step = 0;; ++step) {
    const std::optional<EdgeAt> next = across(patch, out, is_end);
    if (!next) {
      if (!is_end || step < steps) return std::nullopt;
      return found;
    }
    if (step == steps) {
      found.beyond = next;
      return found;
    }
    if (corner_count(patch.shell(next->shell).corners) != 4) return std::nullopt;
    found.quads.push_back(*next);
    out = {next->shell, (next->edge + 2) % 4};
  }
}

struct RowWalk {
  Walk forward, back;
};
std::optional<RowWalk> walk_row(const Patch& patch, const Row& row) {
  const auto edge = static_cast<std::size_t>(row.edge);
  const auto forward = walk(patch, {row.start, (edge + 2) % 4}, row.forward);
  const auto back = walk(patch, {row.start, edge}, row.back);
  if (!forward || !back) return std::nullopt;
  // A row must not cross itself.
  std::vector<LocalShell> all = {row.start};
  for (const Walk* side : {&*forward, &*back}) {
    for (const EdgeAt& at : side->quads) all.push_back(at.shell);
    if (side->beyond) all.push_back(side->beyond->shell);
  }
  std::sort(all.begin(), all.end());
  if (std::adjacent_find(all.begin(), all.end()) != all.end()) return std::nullopt;
  return RowWalk{*forward, *back};
}

}  // namespace

std::optional<RowEnds> ends_of(const Patch& patch, const Row& row) {
  const auto walked = walk_row(patch, row);
  if (!walked) return std::nullopt;
  const auto corners = [&](const Walk& side) { return side.beyond ? corner_count(patch.shell(side.beyond->shell).corners) : 0; };
  return RowEnds{corners(walked->forward), corners(walked->back)};
}

Refusal divide_row(const RepairContext& context, const Row& row) {
  Patch& patch = context.patch;
  if (corner_count(patch.shell(row.start).corners) != 4) return "a row begins with a quad";
  const auto walked = walk_row(patch, row);
  if (!walked) return "there is no row of quads";
  EdgeCuts cuts(context);
  struct End {
    EdgeAt at;
    LocalNode a, b;
    RowEnd end;
  };
  std::vector<End> ends;
  for (const auto& [side, end] : {std::pair(&walked->forward, row.forward_end), std::pair(&walked->back, row.back_end)}) {
    if (!side->beyond) continue;
    const Corners& c = patch.shell(side->beyond->shell).corners;
    const auto count = static_cast<std::size_t>(corner_count(c));
    ends.push_back({*side->beyond, c[side->beyond->edge], c[(side->beyond->edge + 1) % count], end});
  }
  if (const Refusal refusal = divide_quad(context, {row.start, static_cast<std::size_t>(row.edge)}, cuts)) return refusal;
  for (const Walk* side : {&walked->forward, &walked->back})
    for (const EdgeAt& at : side->quads)
      if (const Refusal refusal = divide_quad(context, at, cuts)) return refusal;
  for (const End& end : ends)
    if (const Refusal refusal = end_row(context, end.at, cuts.middle(end.a, end.b), end.end)) return refusal;
  return cuts.refusal();
}

Refusal divide_edge(const RepairContext& context, LocalNode a, LocalNode b, RowEnd first_end, RowEnd second_end) {
  const Patch& patch = context.patch;
  const std::vector<LocalShell> shells = patch.shells_at(a, b);
  EdgeCuts cuts(context);
  const LocalNode middle = cuts.middle(a, b);
  if (cuts.refusal()) return cuts.refusal();
  for (std::size_t i = 0; i < shells.size(); ++i) {
    const Corners& c = patch.shell(shells[i]).corners;
    const auto count = static_cast<std::size_t>(corner_count(c));
    std::size_t edge = 0;
    while (edge_key(c[edge], c[(edge + 1) % count]) != edge_key(a, b)) ++edge;
    if (const Refusal refusal = end_row(context, {shells[i], edge}, middle, i == 0 ? first_end : second_end)) return refusal;
  }
  return std::nullopt;
}

Refusal divide_about(const RepairContext& context, LocalNode node) {
  Patch& patch = context.patch;
  if (!patch.node(node).is_whole) return "the node can't be worked on";
  const std::vector<LocalShell> shells = patch.node(node).shells;
  EdgeCuts cuts(context);
  for (const LocalShell shell : shells) {
    if (const Refusal refusal = refuse_dividing(patch, shell, static_cast<std::size_t>(corner_count(patch.shell(shell).corners))))
      return refusal;
    const Corners c = patch.shell(shell).corners;
    if (corner_count(c) == 3 && (patch.shell(shell).rules & kNoTriangle) != 0) return "a shell there can't be divided into quads";
    const auto count = static_cast<std::size_t>(corner_count(c));
    const auto at = static_cast<std::size_t>(std::find(c.begin(), c.end(), node) - c.begin());
    const LocalNode next = c[(at + 1) % count], last = c[(at + count - 1) % count];
    const Vec3 direction = first_edge(patch, shell), normal = area_normal(patch, c);
    const LocalNode m = cuts.middle(node, next), n = cuts.middle(last, node);
    if (cuts.refusal()) return cuts.refusal();
    if (count == 3) {
      patch.set_corners(shell, corners_along(patch, {node, m, n}, direction));
      patch.add_shell(corners_along(patch, {m, next, last, n}, direction), shell);
      continue;
    }
    const LocalNode far = c[(at + 2) % 4];
    const Vec3 middle = 0.25 * (patch.position(node) + patch.position(next) + patch.position(far) + patch.position(last));
    const double size = (patch.position(node) - patch.position(far)).norm();
    constexpr double kQuarters[4] = {0.25, 0.25, 0.25, 0.25};
    const LocalNode parents[4] = {c[0], c[1], c[2], c[3]};
    const LocalNode p =
        patch.add_node(on_surface(context, middle, normal, size).value_or(middle), parents, kQuarters, relax::Freedom::surface);
    patch.set_corners(shell, corners_along(patch, {node, m, p, n}, direction));
    patch.add_shell(corners_along(patch, {m, next, far, p}, direction), shell);
    patch.add_shell(corners_along(patch, {p, far, last, n}, direction), shell);
  }
  return std::nullopt;
}

}  // namespace prismesh::mesh::repair
