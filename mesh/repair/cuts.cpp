#include "mesh/repair/cuts.h"

#include <algorithm>

#include "mesh/repair/patch_geometry.h"
#include "mesh/repair/placement.h"

namespace prismesh::mesh::repair {

std::vector<LocalNode> EdgeCuts::cut(LocalNode a, LocalNode b) {
  const auto [place, is_new] = cuts_.try_emplace(edge_key(a, b));
  if (is_new) place->second = make(place->first.first, place->first.second);
  std::vector<LocalNode> nodes = place->second;
  if (b < a) std::reverse(nodes.begin(), nodes.end());
  return nodes;
}

std::vector<LocalNode> EdgeCuts::make(LocalNode a, LocalNode b) {
  Patch& patch = context_.patch;
  if (!patch.may_divide(a, b)) refusal_ = "no node can come between two nodes there";
  const Vec3 from = patch.position(a), to = patch.position(b);
  const double size = (to - from).norm();
  const bool is_line = patch.line(a, b) != nullptr;
  const std::vector<LocalShell> shells = patch.shells_at(a, b);
  std::vector<LocalNode> nodes;
  for (int i = 1; i < pieces_; ++i) {
    const double share = static_cast<double>(i) / pieces_;
    const Vec3 point = from + share * (to - from);
    std::optional<Vec3> place;
    if (is_line)
      place = context_.surface.project_on_line(point, 0.5 * size);
    else if (!shells.empty())
      place = on_surface(context_, point, area_normal(patch, patch.shell(shells[0]).corners), size);
    // An edge whose middle isn't near the surface is divided on its straight line.
    const LocalNode parents[2] = {a, b};
    const double shares[2] = {1 - share, share};
    nodes.push_back(patch.add_node(place.value_or(point), parents, shares, is_line ? relax::Freedom::line : relax::Freedom::surface));
    if (is_line) patch.divide_line(i == 1 ? a : nodes[nodes.size() - 2], b, nodes.back());
  }
  return nodes;
}

Refusal end_row(const RepairContext& context, const EdgeAt& at, LocalNode middle, RowEnd end) {
  Patch& patch = context.patch;
  const Corners c = patch.shell(at.shell).corners;
  const Vec3 direction = first_edge(patch, at.shell);
  const auto count = static_cast<std::size_t>(corner_count(c));
  const LocalNode a = c[at.edge], b = c[(at.edge + 1) % count], d = c[(at.edge + 2) % count];
  if (count == 3 && end == RowEnd::absorb) {
    if (const Refusal refusal = refuse_reshaping(patch, at.shell, 4)) return refusal;
    patch.set_corners(at.shell, corners_along(patch, {a, middle, b, d}, direction));
    return std::nullopt;
  }
  if (const Refusal refusal = refuse_dividing(patch, at.shell, count)) return refusal;
  if (count == 4 && (patch.shell(at.shell).rules & kNoTriangle) != 0) return "a shell there can't be divided into triangles";
  if (count == 3) {
    patch.set_corners(at.shell, corners_along(patch, {a, middle, d}, direction));
    patch.add_shell(corners_along(patch, {middle, b, d}, direction), at.shell);
    return std::nullopt;
  }
  const LocalNode e = c[(at.edge + 3) % count];
  const bool low = end == RowEnd::low_triangle;
  const Loop quad = low ? Loop{middle, b, d, e} : Loop{a, middle, d, e};
  const Loop small = low ? Loop{a, middle, e} : Loop{middle, b, d};
  patch.set_corners(at.shell, corners_along(patch, quad, direction));
  patch.add_shell(corners_along(patch, small, direction), at.shell);
  return std::nullopt;
}

Refusal divide_quad(const RepairContext& context, const EdgeAt& at, EdgeCuts& cuts) {
  Patch& patch = context.patch;
  if (const Refusal refusal = refuse_dividing(patch, at.shell, 4)) return refusal;
  const Corners c = patch.shell(at.shell).corners;
  const Vec3 direction = first_edge(patch, at.shell);
  const LocalNode a = c[at.edge], b = c[(at.edge + 1) % 4], d = c[(at.edge + 2) % 4], e = c[(at.edge + 3) % 4];
  std::vector<LocalNode> near = cuts.cut(a, b), far = cuts.cut(e, d);
  if (cuts.refusal()) return cuts.refusal();
  near.push_back(b);
  far.push_back(d);
  patch.set_corners(at.shell, corners_along(patch, {a, near[0], far[0], e}, direction));
  for (std::size_t i = 0; i + 1 < near.size(); ++i)
    patch.add_shell(corners_along(patch, {near[i], near[i + 1], far[i + 1], far[i]}, direction), at.shell);
  return std::nullopt;
}

}  // namespace prismesh::mesh::repair
