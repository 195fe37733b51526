#include "mesh/repair/smoothness.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "mesh/repair/cuts.h"
#include "mesh/repair/local_size.h"
#include "mesh/repair/patch_geometry.h"

namespace prismesh::mesh::repair {

namespace {

/// A shell's unit normal and the surface's at the shell's centre.
struct NormalPair {
  Vec3 shell, surface;
};

template <class PositionOf>
std::optional<NormalPair> normals_of(const RepairContext& context, const Corners& corners, double radius, const PositionOf& at) {
  const Vec3 normal = area_normal_of(corners, at);
  const double length = normal.norm();
  if (!(length > 0)) return std::nullopt;
  const int count = corner_count(corners);
  Vec3 centre = Vec3::Zero();
  for (int i = 0; i < count; ++i) centre += at(corners[static_cast<std::size_t>(i)]);
  const Vec3 unit = normal / length;
  const auto place = context.surface.project(centre / count, radius, unit);
  if (!place || !place->normal.allFinite()) return std::nullopt;
  return NormalPair{unit, place->normal};
}

/// Degrees between two lines along unit vectors, so that the shells' sides don't matter.
double angle_between(const Vec3& a, const Vec3& b) { return std::acos(std::min(1.0, std::abs(a.dot(b)))) * 180 / std::numbers::pi; }

double excess_of(const std::optional<NormalPair>& one, const std::optional<NormalPair>& other) {
  if (!one || !other) return 0;
  return std::max(0.0, angle_between(one->shell, other->shell) - angle_between(one->surface, other->surface));
}

/// The sum of excesses at the edges of the shells in `list`. `changed`: those shells, ascending.
template <class PositionOf>
double facets_of(const RepairContext& context, const std::vector<Corners>& list, const std::vector<LocalShell>& changed,
                 const PositionOf& at) {
  const Patch& patch = context.patch;
  const double radius = target_sizes_of(context, changed).max;
  std::vector<std::optional<NormalPair>> normals;
  std::map<EdgeKey, std::vector<std::size_t>> edges;
  for (std::size_t s = 0; s < list.size(); ++s) {
    normals.push_back(normals_of(context, list[s], radius, at));
    const auto count = static_cast<std::size_t>(corner_count(list[s]));
    for (std::size_t i = 0; i < count; ++i) edges[edge_key(list[s][i], list[s][(i + 1) % count])].push_back(s);
  }
  double sum = 0;
  for (const auto& [edge, shells] : edges) {
    if (shells.size() > 2 || patch.line(edge.first, edge.second) != nullptr) continue;
    if (shells.size() == 2) {
      sum += excess_of(normals[shells[0]], normals[shells[1]]);
      continue;
    }
    // Beside the change: the other shell is the same before and now.
    for (const LocalShell other : patch.shells_at(edge.first, edge.second))
      if (!std::binary_search(changed.begin(), changed.end(), other))
        sum += excess_of(normals[shells[0]], normals_of(context, patch.shell(other).corners, radius, at));
  }
  return sum;
}

/// The shells of the change, those before and those now, ascending.
std::vector<LocalShell> shells_of_change(const Patch& patch) {
  std::vector<LocalShell> shells = patch.changed_shells();
  for (const auto& [shell, was] : patch.old_shells()) shells.push_back(shell);
  std::sort(shells.begin(), shells.end());
  shells.erase(std::unique(shells.begin(), shells.end()), shells.end());
  return shells;
}

}  // namespace

double facets_now(const RepairContext& context) {
  const Patch& patch = context.patch;
  std::vector<Corners> list;
  for (const LocalShell shell : patch.changed_shells()) list.push_back(patch.shell(shell).corners);
  return facets_of(context, list, shells_of_change(patch), [&](LocalNode n) -> const Vec3& { return patch.position(n); });
}

double facets_before(const RepairContext& context) {
  const Patch& patch = context.patch;
  std::vector<Corners> list;
  for (const auto& [shell, was] : patch.old_shells()) list.push_back(was.corners);
  return facets_of(context, list, shells_of_change(patch), [&](LocalNode n) -> const Vec3& { return patch.old_position(n); });
}

}  // namespace prismesh::mesh::repair
