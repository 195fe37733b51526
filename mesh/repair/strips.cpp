#include "mesh/repair/strips.h"

#include <algorithm>
#include <bit>
#include <map>
#include <optional>
#include <set>

#include "mesh/repair/collapse.h"
#include "mesh/repair/cuts.h"

namespace prismesh::mesh::repair {

namespace {

constexpr unsigned kAcross = 0b0101, kAlong = 0b1010;  ///< opposite edges of a quad

/// The edges that a strip divides, and those of each shell.
class StripPlan {
 public:
  StripPlan(const Patch& patch, const Strip& strip) : patch_(patch), strip_(strip) {
    if (corner_count(patch.shell(strip.start).corners) != 4) return;
    const unsigned edges = strip.edge % 2 == 0 ? kAcross : kAlong;
    for (std::size_t e = 0; e < 4; ++e)
      if ((edges >> e & 1) != 0 && !may_cut(strip.start, e)) return;
    for (std::size_t e = 0; e < 4; ++e)
      if ((edges >> e & 1) != 0) cut(strip.start, e);
    is_possible_ = follow();
  }

  bool is_possible() const { return is_possible_; }
  const std::map<LocalShell, unsigned>& edges() const { return edges_; }
  const std::set<EdgeKey>& cut_edges() const { return cut_; }
  static bool divides(unsigned edges) { return edges == kAcross || edges == kAlong; }

 private:
  EdgeKey nodes_of(LocalShell shell, std::size_t edge) const {
    const Corners& corners = patch_.shell(shell).corners;
    const auto count = static_cast<std::size_t>(corner_count(corners));
    return edge_key(corners[edge], corners[(edge + 1) % count]);
  }

  bool may_cut(LocalShell shell, std::size_t edge) const {
    const auto [a, b] = nodes_of(shell, edge);
    return patch_.may_divide(a, b);
  }

  void cut(LocalShell shell, std::size_t edge) {
    const EdgeKey nodes = nodes_of(shell, edge);
    cut_.insert(nodes);
    for (const LocalShell other : patch_.shells_at(nodes.first, nodes.second)) {
      const int count = corner_count(patch_.shell(other).corners);
      for (std::size_t e = 0; e < static_cast<std::size_t>(count); ++e)
        if (nodes_of(other, e) == nodes) edges_[other] |= 1U << e;
      reached_.push_back(other);
    }
  }

  /// Continues the strip from every shell reached; false: it crosses itself.
  bool follow() {
    for (std::size_t i = 0; i < reached_.size(); ++i) {
      const LocalShell shell = reached_[i];
      const unsigned edges = edges_[shell];
      const int count = corner_count(patch_.shell(shell).corners);
      if (count == 3) {
        if (std::popcount(edges) > 2) return false;
        continue;
      }
      if (std::popcount(edges) > 1) {
        if (!divides(edges)) return false;
        continue;
      }
      const auto opposite = static_cast<std::size_t>(std::countr_zero(edges) + 2) % 4;
      if (goes_on(shell, opposite)) cut(shell, opposite);
    }
    return true;
  }

  bool goes_on(LocalShell shell, std::size_t out) const {
    const auto [a, b] = nodes_of(shell, out);
    const double length = (patch_.position(a) - patch_.position(b)).norm();
    // A strip that ends in a quad leaves a triangle there. Where none may be, it goes on whatever its edges' lengths.
    const bool may_end = (patch_.shell(shell).rules & kNoTriangle) == 0;
    if (may_end && (length < strip_.min_length || length > strip_.max_length)) return false;
    if (!patch_.may_divide(a, b) || refuse_dividing(patch_, shell, 4)) return false;
    // The shells beyond must be divided as well, or be reshaped as the strip's end.
    const std::vector<LocalShell> shells = patch_.shells_at(a, b);
    return std::none_of(shells.begin(), shells.end(), [&](LocalShell other) {
      return other != shell && refuse_dividing(patch_, other, static_cast<std::size_t>(corner_count(patch_.shell(other).corners)));
    });
  }

  const Patch& patch_;
  Strip strip_;
  bool is_possible_ = false;
  std::set<EdgeKey> cut_;
  std::map<LocalShell, unsigned> edges_;  ///< a bit an edge
  std::vector<LocalShell> reached_;
};

/// The end in a quad with one divided edge: the triangle lies at the corner with the shorter diagonal from `middle`.
RowEnd better_end(const Patch& patch, const EdgeAt& at, LocalNode middle) {
  const Corners& c = patch.shell(at.shell).corners;
  const auto diagonal = [&](std::size_t corner) {
    return (patch.position(c[(at.edge + corner) % 4]) - patch.position(middle)).squaredNorm();
  };
  return diagonal(3) <= diagonal(2) * (1 + 1e-9) ? RowEnd::low_triangle : RowEnd::high_triangle;
}

/// Divides a triangle whose two edges at a corner are divided into a triangle at that corner and a quad.
Refusal divide_at_corner(const RepairContext& context, LocalShell shell, unsigned edges, EdgeCuts& cuts) {
  Patch& patch = context.patch;
  if (const Refusal refusal = refuse_dividing(patch, shell, 3)) return refusal;
  if ((patch.shell(shell).rules & kNoTriangle) != 0) return "a shell there can't be divided into triangles";
  const auto whole = static_cast<std::size_t>(std::countr_zero(~edges & 0b111));  // the edge that isn't divided
  const Corners c = patch.shell(shell).corners;
  const Vec3 direction = first_edge(patch, shell);
  const LocalNode a = c[whole], b = c[(whole + 1) % 3], top = c[(whole + 2) % 3];
  const LocalNode m = cuts.middle(b, top), n = cuts.middle(top, a);
  if (cuts.refusal()) return cuts.refusal();
  patch.set_corners(shell, corners_along(patch, {a, b, m, n}, direction));
  patch.add_shell(corners_along(patch, {n, m, top}, direction), shell);
  return std::nullopt;
}

/// Divides a quad of which one edge is divided into three: a quad between two triangles.
Refusal divide_in_three(const RepairContext& context, const EdgeAt& at, const std::vector<LocalNode>& nodes) {
  Patch& patch = context.patch;
  if (const Refusal refusal = refuse_dividing(patch, at.shell, 4)) return refusal;
  if ((patch.shell(at.shell).rules & kNoTriangle) != 0) return "a shell there can't be divided into triangles";
  const Corners c = patch.shell(at.shell).corners;
  const Vec3 direction = first_edge(patch, at.shell);
  const LocalNode a = c[at.edge], b = c[(at.edge + 1) % 4], d = c[(at.edge + 2) % 4], e = c[(at.edge + 3) % 4];
  patch.set_corners(at.shell, corners_along(patch, {nodes[0], nodes[1], d, e}, direction));
  patch.add_shell(corners_along(patch, {a, nodes[0], e}, direction), at.shell);
  patch.add_shell(corners_along(patch, {nodes[1], b, d}, direction), at.shell);
  return std::nullopt;
}

/// Divides or reshapes a shell at the end of a strip, or a triangle that the strip passes.
Refusal end_strip(const RepairContext& context, LocalShell shell, unsigned edges, EdgeCuts& cuts, bool absorbs) {
  const Corners c = context.patch.shell(shell).corners;
  const int count = corner_count(c);
  if (cuts.pieces() > (count == 4 ? 3 : 2)) return "a strip there would have to end in more pieces than there is a way for";
  if (std::popcount(edges) == 2) return divide_at_corner(context, shell, edges, cuts);
  const EdgeAt at{shell, static_cast<std::size_t>(std::countr_zero(edges))};
  const std::vector<LocalNode> nodes = cuts.cut(c[at.edge], c[(at.edge + 1) % static_cast<std::size_t>(count)]);
  if (cuts.pieces() == 3) return divide_in_three(context, at, nodes);
  const RowEnd end = count == 4 ? better_end(context.patch, at, nodes[0]) : absorbs ? RowEnd::absorb : RowEnd::two_triangles;
  return end_row(context, at, nodes[0], end);
}

}  // namespace

StripPath path_of(const Patch& patch, const Strip& strip) {
  const StripPlan plan(patch, strip);
  StripPath course;
  if (!plan.is_possible()) return course;
  for (const auto& [shell, edges] : plan.edges()) {
    const bool is_triangle = corner_count(patch.shell(shell).corners) == 3;
    if (!is_triangle && StripPlan::divides(edges)) course.quads.push_back({shell, edges == kAcross ? 0 : 1});
    course.ends_in_triangle = course.ends_in_triangle || (is_triangle && std::popcount(edges) == 1);
  }
  return course;
}

Refusal divide_strip(const RepairContext& context, const Strip& strip, int pieces, bool absorbs) {
  const Patch& patch = context.patch;
  const StripPlan plan(patch, strip);
  if (!plan.is_possible()) return "the strip of quads there crosses itself";
  EdgeCuts cuts(context, pieces);
  // Divide all edges first: an edge is found by its nodes only while its shells are unchanged.
  for (const auto& [a, b] : plan.cut_edges()) cuts.cut(a, b);
  if (cuts.refusal()) return cuts.refusal();
  for (const auto& [shell, edges] : plan.edges()) {
    const bool divides = corner_count(patch.shell(shell).corners) == 4 && StripPlan::divides(edges);
    const Refusal refusal =
        divides ? divide_quad(context, {shell, edges == kAcross ? 0U : 1U}, cuts) : end_strip(context, shell, edges, cuts, absorbs);
    if (refusal) return refusal;
  }
  return std::nullopt;
}

Refusal collapse_strip(const RepairContext& context, const Strip& strip) {
  const StripPlan plan(context.patch, strip);
  if (!plan.is_possible()) return "the strip of quads there crosses itself";
  std::vector<Collapse> collapses;
  for (const auto& [a, b] : plan.cut_edges()) {
    const auto pair = collapse_of(context, a, b);
    if (!pair) return "both nodes hold the part's shape";
    collapses.push_back(*pair);
  }
  return collapse_nodes(context, collapses);
}

}  // namespace prismesh::mesh::repair
