#include "mesh/repair/operations.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "mesh/repair/pieces.h"

namespace prismesh::mesh::repair {

Refusal refuse_reshaping(const Patch& patch, LocalShell shell, std::size_t corners) {
  const PatchShell& s = patch.shell(shell);
  if ((s.rules & kKeepsNodes) != 0) return "a shell there has to keep its nodes";
  if ((s.rules & kNoTriangle) != 0 && static_cast<int>(corners) != corner_count(s.corners))
    return "a shell there can't change between quad and triangle";
  for (const LocalNode corner : s.corners)
    if (!patch.node(corner).is_whole) return "a shell there has a node that can't be worked on";
  return std::nullopt;
}

Refusal refuse_dividing(const Patch& patch, LocalShell shell, std::size_t corners) {
  if ((patch.shell(shell).rules & kIndivisible) != 0) return "a shell there can't be divided";
  return refuse_reshaping(patch, shell, corners);
}

Corners turned_like(const Patch& patch, const Loop& loop, const Vec3& direction) {
  std::size_t best = 0;
  double most = -2;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec3 edge = patch.position(loop[(i + 1) % loop.size()]) - patch.position(loop[i]);
    const double length = edge.norm();
    const double along = length > 0 ? edge.dot(direction) / length : -1;
    if (along > most + 1e-9) {
      most = along;
      best = i;
    }
  }
  Corners corners;
  for (std::size_t i = 0; i < 4; ++i) corners[i] = loop[(best + std::min(i, loop.size() - 1)) % loop.size()];
  return corners;
}

Vec3 first_edge(const Patch& patch, LocalShell shell) {
  const Corners& corners = patch.shell(shell).corners;
  const Vec3 edge = patch.position(corners[1]) - patch.position(corners[0]);
  const double length = edge.norm();
  return length > 0 ? Vec3(edge / length) : Vec3::Zero();
}

namespace {

std::size_t opposite(std::size_t corner) { return (corner + 2) % 4; }

/// Where a loop's edge u-v is passed in a shell from u to v.
bool passes(const Corners& corners, LocalNode u, LocalNode v) {
  const int count = corner_count(corners);
  for (int i = 0; i < count; ++i)
    if (corners[static_cast<std::size_t>(i)] == u && corners[static_cast<std::size_t>((i + 1) % count)] == v) return true;
  return false;
}

/// The edge two shells share, as the first passes it; false if they don't share exactly one.
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

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

}  // namespace

Refusal split_quad(const RepairContext& context, LocalShell quad, int first) {
  Patch& patch = context.patch;
  const Corners c = patch.shell(quad).corners;
  if (corner_count(c) != 4) return "a triangle has no diagonal";
  if (const Refusal refusal = refuse_dividing(patch, quad, 3)) return refusal;
  const Vec3 direction = first_edge(patch, quad);
  const auto i = static_cast<std::size_t>(first);
  patch.set_corners(quad, turned_like(patch, {c[i], c[i + 1], c[opposite(i)]}, direction));
  patch.add_shell(turned_like(patch, {c[i], c[opposite(i)], c[(i + 3) % 4]}, direction), quad);
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
  if (f.part != g.part || f.sheet.thickness != g.sheet.thickness) return "they differ in part or thickness";
  const bool same_sense = passes(g.corners, v, u);
  // Of two that become one the first stays, unless the second has to.
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
  const Vec3 f_edge = first_edge(patch, first), g_edge = first_edge(patch, second);
  if (pieces.size() == 1) {
    patch.remove_shell(goes);
    const bool turn = swaps && !same_sense;
    patch.set_corners(stays, turned_like(patch, turn ? reversed(pieces[0]) : pieces[0], swaps ? g_edge : f_edge));
    return std::nullopt;
  }
  patch.set_corners(first, turned_like(patch, pieces[0], f_edge));
  patch.set_corners(second, turned_like(patch, same_sense ? pieces[1] : reversed(pieces[1]), g_edge));
  for (std::size_t i = 2; i < pieces.size(); ++i) patch.add_shell(turned_like(patch, pieces[i], f_edge), first);
  return std::nullopt;
}

std::vector<std::vector<Loop>> divisions(const Loop& loop, int most_triangles) {
  std::vector<std::vector<Loop>> found;
  const std::size_t n = loop.size();
  const auto after = [n](std::size_t i, std::size_t by) { return (i + by) % n; };
  if (n == 4) {
    found.push_back({loop});
    if (most_triangles >= 2)
      for (std::size_t i = 0; i < 2; ++i) found.push_back({stretch(loop, i, i + 2), stretch(loop, i + 2, i)});
  } else if (n == 5 && most_triangles >= 1) {
    // An ear is cut off; the order decides which of the shells becomes the triangle.
    for (std::size_t i = 0; i < 5; ++i) {
      found.push_back({stretch(loop, i, after(i, 2)), stretch(loop, after(i, 2), i)});
      found.push_back({stretch(loop, after(i, 2), i), stretch(loop, i, after(i, 2))});
    }
  } else if (n == 6) {
    for (std::size_t i = 0; i < 3; ++i) found.push_back({stretch(loop, i, i + 3), stretch(loop, i + 3, i)});
    if (most_triangles >= 2)
      for (std::size_t i = 0; i < 6; ++i)
        for (const std::size_t gap : {std::size_t{2}, std::size_t{3}}) {
          const std::size_t j = after(i, gap);
          if (gap == 3 && i >= 3) continue;
          // Ears i..i+2 and j..j+2, and the quad of what is left.
          Loop rest;
          for (std::size_t k = 0; k < 6; ++k)
            if (k != after(i, 1) && k != after(j, 1)) rest.push_back(loop[k]);
          found.push_back({rest, stretch(loop, i, after(i, 2)), stretch(loop, j, after(j, 2))});
        }
  }
  return found;
}

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

namespace {

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
  if (off > context.options.most_off_surface * context.judge.target_size) return "that would bend an edge of the part";
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
      const auto place = on_surface(context, middle, normal, context.judge.target_size);
      if (place && within_limit(context, unions[i].stays, *place)) patch.move(unions[i].stays, *place);
    }
    patch.remove_node(unions[i].gone);
  }
  return std::nullopt;
}

Refusal stir(const RepairContext& context, LocalShell shell) {
  Patch& patch = context.patch;
  std::vector<LocalNode> nodes;
  for (const LocalNode corner : patch.shell(shell).corners)
    for (const LocalShell near : patch.node(corner).shells)
      for (const LocalNode node : patch.shell(near).corners) nodes.push_back(node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  for (const LocalNode node : nodes) patch.move(node, patch.position(node), patch.node(node).is_off_surface);
  return std::nullopt;
}

Refusal lift_node(const RepairContext& context, LocalNode node, double distance) {
  const PatchNode& n = context.patch.node(node);
  if (!n.is_whole || n.freedom != relax::Freedom::surface || !n.lines.empty() || (n.rules & kStays) != 0) return "the node can't be moved";
  Vec3 normal = Vec3::Zero();
  for (const LocalShell shell : n.shells) {
    const Vec3 own = area_normal(context.patch, context.patch.shell(shell).corners);
    normal += normal.dot(own) < 0 ? Vec3(-own) : own;
  }
  const double length = normal.norm();
  if (!(length > 0)) return "the node can't be moved";
  const auto place = context.surface.project(n.position, context.judge.target_size, Vec3(normal / length));
  if (!place) return "the node isn't near the surface";
  const Vec3 lifted = place->point + distance * (normal / length);
  if (!within_limit(context, node, lifted)) return "a node would go farther than it may";
  context.patch.move(node, lifted, true);
  return std::nullopt;
}

}  // namespace prismesh::mesh::repair
