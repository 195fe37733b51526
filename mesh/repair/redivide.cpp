#include "mesh/repair/redivide.h"

#include <algorithm>

namespace prismesh::mesh::repair {

namespace {

std::size_t opposite(std::size_t corner) { return (corner + 2) % 4; }

/// Whether a shell has the edge u-v in the direction from u to v.
bool passes(const Corners& corners, LocalNode u, LocalNode v) {
  const int count = corner_count(corners);
  for (int i = 0; i < count; ++i)
    if (corners[static_cast<std::size_t>(i)] == u && corners[static_cast<std::size_t>((i + 1) % count)] == v) return true;
  return false;
}

/// The common edge of two shells, in the first's direction; false if they don't have exactly one.
bool shared_edge(const Patch& patch, LocalShell first, LocalShell second, LocalNode& u, LocalNode& v) {
  const Corners& corners = patch.shell(first).corners;
  const Corners& others = patch.shell(second).corners;
  const int count = corner_count(corners);
  int shared = 0, common = 0;
  for (int i = 0; i < count; ++i) {
    const LocalNode a = corners[static_cast<std::size_t>(i)], b = corners[static_cast<std::size_t>((i + 1) % count)];
    common += std::find(others.begin(), others.end(), a) != others.end() ? 1 : 0;
    if (!passes(others, a, b) && !passes(others, b, a)) continue;
    ++shared;
    u = a;
    v = b;
  }
  return shared == 1 && common == 2;
}

Loop reversed(const Loop& loop) { return {loop.rbegin(), loop.rend()}; }

/// The part of a loop from node i to node j.
Loop stretch(const Loop& loop, std::size_t i, std::size_t j) {
  Loop part;
  for (std::size_t k = i;; k = (k + 1) % loop.size()) {
    part.push_back(loop[k]);
    if (k == j) return part;
  }
}

}  // namespace

Refusal split_quad(const RepairContext& context, LocalShell quad, int first) {
  Patch& patch = context.patch;
  const Corners c = patch.shell(quad).corners;
  if (corner_count(c) != 4) return "a triangle has no diagonal";
  if (const Refusal refusal = refuse_dividing(patch, quad, 3)) return refusal;
  const Vec3 direction = first_edge(patch, quad);
  const auto i = static_cast<std::size_t>(first);
  patch.set_corners(quad, corners_along(patch, {c[i], c[i + 1], c[opposite(i)]}, direction));
  patch.add_shell(corners_along(patch, {c[i], c[opposite(i)], c[(i + 3) % 4]}, direction), quad);
  return std::nullopt;
}

Loop loop_of(const Patch& patch, LocalShell first, LocalShell second) {
  LocalNode u, v;
  if (!shared_edge(patch, first, second, u, v)) return {};
  const Corners& corners = patch.shell(first).corners;
  const Corners& others = patch.shell(second).corners;
  Loop loop;
  const auto count = static_cast<std::size_t>(corner_count(corners)), others_count = static_cast<std::size_t>(corner_count(others));
  const auto at_v = static_cast<std::size_t>(std::find(corners.begin(), corners.end(), v) - corners.begin());
  for (std::size_t k = 0; k < count; ++k) loop.push_back(corners[(at_v + k) % count]);  // v ... u
  const auto at_u = static_cast<std::size_t>(std::find(others.begin(), others.end(), u) - others.begin());
  const bool same_sense = passes(others, v, u);
  // From u on to v, without the two, in the first's sense.
  for (std::size_t k = 1; k + 1 < others_count; ++k) loop.push_back(others[(at_u + (same_sense ? k : others_count - k)) % others_count]);
  return loop;
}

Refusal redivide(const RepairContext& context, LocalShell first, LocalShell second, const std::vector<Loop>& pieces) {
  Patch& patch = context.patch;
  LocalNode u, v;
  if (!shared_edge(patch, first, second, u, v)) return "they have no edge in common";
  if (patch.line(u, v) != nullptr) return "the edge between them has to stay";
  const PatchShell f = patch.shell(first), g = patch.shell(second);
  if (f.part != g.part || f.properties.thickness != g.properties.thickness) return "they differ in part or thickness";
  if (!patch.may_exchange(first, second)) return "they are in different sets";
  const bool same_sense = passes(g.corners, v, u);
  // When two shells become one, the first stays, unless the second must not be removed.
  const bool swaps = (g.rules & kLasting) != 0;
  const LocalShell stays = swaps ? second : first, goes = swaps ? first : second;
  if (pieces.size() == 1 && (patch.shell(goes).rules & kLasting) != 0) return "neither of them can be removed";
  for (std::size_t i = 0; i < 2; ++i) {
    const LocalShell shell = i == 0 ? first : second;
    if (pieces.size() == 1 && shell != stays) continue;
    const Loop& piece = pieces[pieces.size() == 1 ? 0 : i];
    if (const Refusal refusal =
            pieces.size() > 2 ? refuse_dividing(patch, shell, piece.size()) : refuse_reshaping(patch, shell, piece.size()))
      return refusal;
  }
  for (std::size_t i = 2; i < pieces.size(); ++i)
    if ((f.rules & kNoTriangle) != 0 && static_cast<int>(pieces[i].size()) != corner_count(f.corners))
      return "a shell there can't be divided into triangles";
  const Vec3 f_edge = first_edge(patch, first), g_edge = first_edge(patch, second);
  if (pieces.size() == 1) {
    patch.remove_shell(goes);
    const bool turn = swaps && !same_sense;
    patch.set_corners(stays, corners_along(patch, turn ? reversed(pieces[0]) : pieces[0], swaps ? g_edge : f_edge));
    return std::nullopt;
  }
  patch.set_corners(first, corners_along(patch, pieces[0], f_edge));
  patch.set_corners(second, corners_along(patch, same_sense ? pieces[1] : reversed(pieces[1]), g_edge));
  for (std::size_t i = 2; i < pieces.size(); ++i) patch.add_shell(corners_along(patch, pieces[i], f_edge), first);
  return std::nullopt;
}

std::vector<std::vector<Loop>> divisions(const Loop& loop, int max_triangles) {
  std::vector<std::vector<Loop>> found;
  const std::size_t n = loop.size();
  const auto after = [n](std::size_t i, std::size_t by) { return (i + by) % n; };
  if (n == 4) {
    found.push_back({loop});
    if (max_triangles >= 2)
      for (std::size_t i = 0; i < 2; ++i) found.push_back({stretch(loop, i, i + 2), stretch(loop, i + 2, i)});
  } else if (n == 5 && max_triangles >= 1) {
    // One corner is cut off as a triangle; the order decides which of the shells becomes it.
    for (std::size_t i = 0; i < 5; ++i) {
      found.push_back({stretch(loop, i, after(i, 2)), stretch(loop, after(i, 2), i)});
      found.push_back({stretch(loop, after(i, 2), i), stretch(loop, i, after(i, 2))});
    }
  } else if (n == 6) {
    for (std::size_t i = 0; i < 3; ++i) found.push_back({stretch(loop, i, i + 3), stretch(loop, i + 3, i)});
    if (max_triangles >= 2)
      for (std::size_t i = 0; i < 6; ++i)
        for (const std::size_t gap : {std::size_t{2}, std::size_t{3}}) {
          const std::size_t j = after(i, gap);
          if (gap == 3 && i >= 3) continue;
          // Triangles i..i+2 and j..j+2, and the quad that is left.
          Loop rest;
          for (std::size_t k = 0; k < 6; ++k)
            if (k != after(i, 1) && k != after(j, 1)) rest.push_back(loop[k]);
          found.push_back({rest, stretch(loop, i, after(i, 2)), stretch(loop, j, after(j, 2))});
        }
  }
  return found;
}

}  // namespace prismesh::mesh::repair
