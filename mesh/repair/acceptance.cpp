#include "mesh/repair/acceptance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/quality/judge_lanes.h"
#include "mesh/quality/shell_batch.h"
#include "mesh/repair/local_size.h"
#include "mesh/repair/patch_geometry.h"

namespace prismesh::mesh::repair {

namespace {

// Terms of the cost. A change that adds pairs of triangles is refused whatever its cost (trial.cpp).
constexpr double kFailing = 3, kWarning = 1, kTriangle = 0.2, kTrianglePair = 0.8, kImperfect = 0.15;

double cost_of(float composite, quality::ShellState state) {
  if (state.fail != 0) return kFailing * (1 - static_cast<double>(composite));
  return (state.warn != 0 ? kWarning : 0) + kImperfect * (1 - static_cast<double>(composite));
}

void add_shell(Cost& cost, const PatchShell& shell) {
  cost.total += cost_of(shell.composite, shell.state);
  cost.worst = std::min(cost.worst, shell.composite);
  cost.failing += shell.state.fail != 0 ? 1 : 0;
  cost.warning += shell.state.fail == 0 && shell.state.warn != 0 ? 1 : 0;
  cost.triangles += corner_count(shell.corners) == 3 ? 1 : 0;
}

bool is_in_change(const Patch& patch, const std::vector<LocalShell>& changed, LocalShell shell) {
  if (patch.is_new_since_begin(shell)) return true;
  return std::find(changed.begin(), changed.end(), shell) != changed.end();
}

/// Number of edges between two triangles, at least one of which is in the list; `changed` are the list's shells in the patch.
int triangle_pairs(const Patch& patch, const std::vector<Corners>& list, const std::vector<LocalShell>& changed) {
  std::vector<std::pair<LocalNode, LocalNode>> edges;
  int with_others = 0;
  for (const Corners& corners : list) {
    if (corner_count(corners) != 3) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(corners[i], corners[(i + 1) % 3]);
      edges.emplace_back(low, high);
      for (const LocalShell other : patch.shells_at(low, high))
        if (corner_count(patch.shell(other).corners) == 3 && !is_in_change(patch, changed, other)) ++with_others;
    }
  }
  std::sort(edges.begin(), edges.end());
  int among = 0;
  for (std::size_t i = 1; i < edges.size(); ++i) among += edges[i] == edges[i - 1] ? 1 : 0;
  return among + with_others;
}

void add_triangle_cost(Cost& cost) { cost.total += kTriangle * cost.triangles + kTrianglePair * cost.triangle_pairs; }

std::vector<LocalShell> old_list(const Patch& patch) {
  std::vector<LocalShell> list;
  for (const auto& [shell, was] : patch.old_shells()) list.push_back(shell);
  return list;
}

bool is_valid_shell(const Patch& patch, LocalShell shell) {
  const Corners& corners = patch.shell(shell).corners;
  const int count = corner_count(corners);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < i; ++j)
      if (corners[static_cast<std::size_t>(i)] == corners[static_cast<std::size_t>(j)]) return false;
  // Another shell on the same nodes is at this one's first corner and has three nodes in common with it.
  for (const LocalShell other : patch.node(corners[0]).shells) {
    if (other == shell) continue;
    int common = 0;
    const Corners& theirs = patch.shell(other).corners;
    for (int i = 0; i < count; ++i)
      common += std::find(theirs.begin(), theirs.end(), corners[static_cast<std::size_t>(i)]) != theirs.end() ? 1 : 0;
    if (common >= 3) return false;
  }
  return true;
}

/// The direction from an edge a-b to a shell's centre, normal to the edge.
Vec3 direction_from_edge(const Patch& patch, LocalShell shell, const Vec3& a, const Vec3& b) {
  const Corners& corners = patch.shell(shell).corners;
  const int count = corner_count(corners);
  Vec3 centre = Vec3::Zero();
  for (int i = 0; i < count; ++i) centre += patch.position(corners[static_cast<std::size_t>(i)]);
  const Vec3 along = b - a, out = centre / count - 0.5 * (a + b);
  const double length2 = along.squaredNorm();
  return length2 > 0 ? Vec3(out - along * (out.dot(along) / length2)) : out;
}

bool edge_conforms(const Patch& patch, LocalNode a, LocalNode b) {
  const std::vector<LocalShell> shells = patch.shells_at(a, b);
  const LineEnd* line = patch.line(a, b);
  if (shells.size() != (line != nullptr ? line->shells : 2U)) return false;
  if (shells.size() != 2) return true;
  const Vec3 first = direction_from_edge(patch, shells[0], patch.position(a), patch.position(b));
  const Vec3 second = direction_from_edge(patch, shells[1], patch.position(a), patch.position(b));
  const double size = std::sqrt(first.squaredNorm() * second.squaredNorm());
  // A crease may be sharp, but a sheet must not be folded onto itself.
  return first.dot(second) < (line != nullptr ? 0.9 : 0.3) * size;
}

/// Max distance of shells from the surface, at the points that divide edges inside sheets, and quads in both directions, into `parts`.
/// `size`: the max distance looked at.
template <class PositionOf>
double max_distance_to_surface(const RepairContext& context, const std::vector<Corners>& list, int parts, double size,
                               const PositionOf& at) {
  double farthest = 0;
  const auto look = [&](const Vec3& point, const Vec3& normal) {
    const auto place = context.surface.project(point, size, normal);
    farthest = std::max(farthest, place ? place->distance : size);
  };
  for (const Corners& corners : list) {
    const int count = corner_count(corners);
    const Vec3 normal = area_normal_of(corners, at);
    for (int i = 0; i < count; ++i) {
      const LocalNode a = corners[static_cast<std::size_t>(i)], b = corners[static_cast<std::size_t>((i + 1) % count)];
      if (b < a || context.patch.line(a, b) != nullptr) continue;
      for (int p = 1; p < parts; ++p) look(at(a) + static_cast<double>(p) / parts * (at(b) - at(a)), normal);
    }
    for (int p = 1; count == 4 && p < parts; ++p)
      for (int q = 1; q < parts; ++q) {
        const double u = static_cast<double>(p) / parts, v = static_cast<double>(q) / parts;
        look((1 - v) * ((1 - u) * at(corners[0]) + u * at(corners[1])) + v * ((1 - u) * at(corners[3]) + u * at(corners[2])), normal);
      }
  }
  return farthest;
}

double distance_to_line(const Vec3& point, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((point - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (point - a - t * along).norm();
}

double distance_to_triangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  const bool is_over = area2 > 0 && (b - a).cross(point - a).dot(normal) >= 0 && (c - b).cross(point - b).dot(normal) >= 0 &&
                       (a - c).cross(point - c).dot(normal) >= 0;
  if (is_over) return std::abs((point - a).dot(normal)) / std::sqrt(area2);
  return std::min({distance_to_line(point, a, b), distance_to_line(point, b, c), distance_to_line(point, c, a)});
}

/// A quad counts as the triangles at both of its diagonals.
double distance_to_shell(const Patch& patch, LocalShell shell, const Vec3& point) {
  const Corners& corners = patch.shell(shell).corners;
  const auto distance = [&](std::size_t i, std::size_t j, std::size_t k) {
    return distance_to_triangle(point, patch.position(corners[i]), patch.position(corners[j]), patch.position(corners[k]));
  };
  if (corner_count(corners) == 3) return distance(0, 1, 2);
  return std::min({distance(0, 1, 2), distance(0, 2, 3), distance(0, 1, 3), distance(1, 2, 3)});
}

}  // namespace

void judge_shells(const RepairContext& context, std::span<const LocalShell> shells) {
  Patch& patch = context.patch;
  quality::measure_in_batches(
      shells.size(),
      [&](std::size_t i, const Vec3*(&corner)[4]) {
        const Corners& corners = patch.shell(shells[i]).corners;
        for (std::size_t c = 0; c < 4; ++c) corner[c] = &patch.position(corners[c]);
        return corner_count(corners) == 3 ? quality::Shape::triangle : quality::Shape::quad;
      },
      [&](const quality::ShellBatch& batch, const quality::BatchValues& values) {
        quality::ShellProperties properties[quality::kLanes];
        quality::ShellState states[quality::kLanes];
        float composites[quality::kLanes];
        for (std::size_t lane = 0; lane < batch.count; ++lane) properties[lane] = patch.shell(shells[batch.slot[lane]]).properties;
        quality::judge_lanes(values, batch.count, context.limits, properties, states);
        quality::rate_lanes(values, batch.count, context.limits, properties, composites);
        for (std::size_t lane = 0; lane < batch.count; ++lane) patch.set_judged(shells[batch.slot[lane]], composites[lane], states[lane]);
      });
}

Cost cost_before(const Patch& patch) {
  Cost cost;
  std::vector<Corners> list;
  for (const auto& [shell, was] : patch.old_shells()) {
    add_shell(cost, was);
    list.push_back(was.corners);
  }
  cost.triangle_pairs = triangle_pairs(patch, list, old_list(patch));
  add_triangle_cost(cost);
  return cost;
}

Cost cost_now(const Patch& patch) {
  Cost cost;
  std::vector<Corners> list;
  for (const LocalShell shell : patch.changed_shells()) {
    add_shell(cost, patch.shell(shell));
    list.push_back(patch.shell(shell).corners);
  }
  cost.triangle_pairs = triangle_pairs(patch, list, old_list(patch));
  add_triangle_cost(cost);
  return cost;
}

bool conforms(const Patch& patch, LocalShell shell) {
  if (!is_valid_shell(patch, shell)) return false;
  const Corners& corners = patch.shell(shell).corners;
  const int count = corner_count(corners);
  for (int i = 0; i < count; ++i)
    if (!edge_conforms(patch, corners[static_cast<std::size_t>(i)], corners[static_cast<std::size_t>((i + 1) % count)])) return false;
  return true;
}

bool conforms(const Patch& patch) {
  const auto changed = patch.changed_shells();
  return std::all_of(changed.begin(), changed.end(), [&](LocalShell shell) { return conforms(patch, shell); });
}

bool adds_failures(const Patch& patch) {
  int failing_before = 0, failing_now = 0;
  bool new_one_fails = false;
  for (const auto& [shell, was] : patch.old_shells()) {
    failing_before += was.state.fail != 0 ? 1 : 0;
    if (patch.shell(shell).is_alive && was.state.fail == 0 && patch.shell(shell).state.fail != 0) return true;
  }
  for (const LocalShell shell : patch.changed_shells()) {
    if (patch.shell(shell).state.fail == 0) continue;
    ++failing_now;
    new_one_fails = new_one_fails || patch.is_new_since_begin(shell);
  }
  return new_one_fails && failing_now >= failing_before;
}

bool has_new_failure(const Patch& patch) {
  for (const auto& [shell, was] : patch.old_shells())
    if (patch.shell(shell).is_alive && was.state.fail == 0 && patch.shell(shell).state.fail != 0) return true;
  const std::vector<LocalShell> changed = patch.changed_shells();
  return std::any_of(changed.begin(), changed.end(),
                     [&](LocalShell shell) { return patch.is_new_since_begin(shell) && patch.shell(shell).state.fail != 0; });
}

bool stays_on_surface(const RepairContext& context) {
  const Patch& patch = context.patch;
  std::vector<Corners> now, before;
  const std::vector<LocalShell> changed = patch.changed_shells();
  for (const LocalShell shell : changed) now.push_back(patch.shell(shell).corners);
  const SizeRange sizes = target_sizes_of(context, changed);
  const double allowed = context.options.max_off_surface * sizes.min, reach = 2 * sizes.max;
  const double off = max_distance_to_surface(context, now, 2, reach, [&](LocalNode n) -> const Vec3& { return patch.position(n); });
  if (off <= allowed) return true;
  for (const auto& [shell, was] : patch.old_shells()) before.push_back(was.corners);
  // The shells before are sampled at quarters: the middles of their halves lie there.
  return off <=
         1.0001 * max_distance_to_surface(context, before, 4, reach, [&](LocalNode n) -> const Vec3& { return patch.old_position(n); });
}

bool keeps_peaks(const RepairContext& context) {
  constexpr double kMaxCut = 0.05;  // of the target size
  const Patch& patch = context.patch;
  const std::vector<LocalShell> shells = patch.changed_shells();
  const double max_cut = kMaxCut * target_sizes_of(context, shells).min;
  const auto is_covered = [&](const Vec3& place) {
    return std::any_of(shells.begin(), shells.end(), [&](LocalShell shell) { return distance_to_shell(patch, shell, place) <= max_cut; });
  };
  for (const LocalNode node : patch.changed_nodes()) {
    const Vec3& was = patch.old_position(node);
    if (was != patch.position(node) && !is_covered(was)) return false;
  }
  return true;
}

std::vector<std::pair<LocalNode, LocalNode>> pair_edges(const Patch& patch) {
  std::vector<std::pair<LocalNode, LocalNode>> edges;
  for (std::size_t s = 0; s < patch.shell_count(); ++s) {
    const PatchShell& shell = patch.shell(LocalShell(s));
    if (!shell.is_alive || corner_count(shell.corners) != 3) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(shell.corners[i], shell.corners[(i + 1) % 3]);
      const std::vector<LocalShell> shells = patch.shells_at(low, high);
      if (shells.size() != 2) continue;
      const LocalShell other = shells[0] == LocalShell(s) ? shells[1] : shells[0];
      if (other.value > s && corner_count(patch.shell(other).corners) == 3) edges.emplace_back(low, high);
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

}  // namespace prismesh::mesh::repair
