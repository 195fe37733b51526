#include "mesh/repair/node_smoothing.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "mesh/quality/judge_lanes.h"
#include "mesh/quality/shell_batch.h"
#include "mesh/repair/local_size.h"
#include "mesh/repair/patch_geometry.h"
#include "mesh/repair/placement.h"

namespace prismesh::mesh::repair {

namespace {

/// The penalty of a shell, exp(-4 composite) by squaring: the worst shells count far more than the others.
double penalty(float composite) {
  const double x = 1 - 4 * static_cast<double>(composite) / 64;
  double p = x;
  for (int i = 0; i < 6; ++i) p *= p;
  return p;
}

bool may_move(const Patch& patch, LocalNode node) {
  const PatchNode& n = patch.node(node);
  if (!n.is_alive || !n.is_whole || (n.rules & kStays) != 0 || n.is_off_surface || n.shells.empty()) return false;
  if (n.freedom == relax::Freedom::surface) return n.lines.empty();
  // Only inside of a line; nodes where lines meet or end stay.
  return n.freedom == relax::Freedom::line && n.lines.size() == 2 && !n.lines[0].is_rim && !n.lines[1].is_rim;
}

/// The sum of the penalties of a node's shells, for each of several positions of the node.
void sum_penalties(const RepairContext& context, LocalNode node, std::span<const Vec3> places, std::span<double> sums) {
  const Patch& patch = context.patch;
  const std::vector<LocalShell>& shells = patch.node(node).shells;
  std::fill(sums.begin(), sums.end(), 0.0);
  quality::measure_in_batches(
      places.size() * shells.size(),
      [&](std::size_t i, const Vec3*(&corner)[4]) {
        const Corners& corners = patch.shell(shells[i % shells.size()]).corners;
        for (std::size_t c = 0; c < 4; ++c) corner[c] = corners[c] == node ? &places[i / shells.size()] : &patch.position(corners[c]);
        return corner_count(corners) == 3 ? quality::Shape::triangle : quality::Shape::quad;
      },
      [&](const quality::ShellBatch& batch, const quality::BatchValues& values) {
        quality::ShellProperties properties[quality::kLanes];
        float composites[quality::kLanes];
        for (std::size_t lane = 0; lane < batch.count; ++lane)
          properties[lane] = patch.shell(shells[batch.slot[lane] % shells.size()]).properties;
        quality::rate_lanes(values, batch.count, context.limits, properties, composites);
        for (std::size_t lane = 0; lane < batch.count; ++lane) sums[batch.slot[lane] / shells.size()] += penalty(composites[lane]);
      });
}

struct NodeNeighbourhood {
  Vec3 normal = Vec3::Zero();  ///< unit
  Vec3 centre = Vec3::Zero();  ///< mean position of the neighbours along edges
  double size = 0;             ///< mean distance to them
};

NodeNeighbourhood around(const Patch& patch, LocalNode node) {
  NodeNeighbourhood found;
  int count = 0;
  for (const LocalShell shell : patch.node(node).shells) {
    const Corners& corners = patch.shell(shell).corners;
    const int corners_used = corner_count(corners);
    Vec3 normal = area_normal(patch, corners);
    if (normal.dot(found.normal) < 0) normal = -normal;
    found.normal += normal;
    for (int i = 0; i < corners_used; ++i) {
      const LocalNode a = corners[static_cast<std::size_t>(i)], b = corners[static_cast<std::size_t>((i + 1) % corners_used)];
      if (a != node && b != node) continue;
      const Vec3& other = patch.position(a == node ? b : a);
      found.centre += other;
      found.size += (other - patch.position(node)).norm();
      ++count;
    }
  }
  if (count > 0) {
    found.centre /= count;
    found.size /= count;
  }
  const double length = found.normal.norm();
  if (length > 0) found.normal /= length;
  return found;
}

/// Whether a line's two edges at a node would follow the line with the node at `place`: within the options' limit, or as closely as now.
bool follows_line(const RepairContext& context, LocalNode node, const Vec3& place) {
  const Patch& patch = context.patch;
  const double allowed = context.options.max_off_surface * target_size_at(context, node);
  const auto off = [&](const Vec3& at, const Vec3& end) {
    const Vec3 middle = 0.5 * (at + end);
    const auto on_line = context.surface.project_on_line(middle, 0.5 * (at - end).norm());
    return on_line ? (*on_line - middle).norm() : (at - end).norm();
  };
  double now = 0, before = 0;
  for (const LineEnd& line : patch.node(node).lines) {
    now = std::max(now, off(place, patch.position(line.node)));
    before = std::max(before, off(patch.position(node), patch.position(line.node)));
  }
  return now <= std::max(allowed, before * (1 + 1e-9));
}

/// The position of min penalty among several, the first of which is the node's own; nothing: its own.
std::optional<Vec3> best_of(const RepairContext& context, LocalNode node, std::span<const Vec3> places, std::span<double> sums) {
  sum_penalties(context, node, places, sums);
  const auto best = static_cast<std::size_t>(std::min_element(sums.begin(), sums.end()) - sums.begin());
  return best == 0 ? std::nullopt : std::optional<Vec3>(places[best]);
}

bool lowers_penalty(const RepairContext& context, LocalNode node, const Vec3& place, double sum_now) {
  double sum = 0;
  sum_penalties(context, node, std::span(&place, 1), std::span(&sum, 1));
  return sum < sum_now;
}

/// Moves a node on a line along it.
void smooth_on_line(const RepairContext& context, LocalNode node, double step) {
  const Patch& patch = context.patch;
  const PatchNode& n = patch.node(node);
  const Vec3 at = n.position, one = patch.position(n.lines[0].node), other = patch.position(n.lines[1].node);
  const std::array<Vec3, 5> places = {at, at + step * (one - at), at + step * (other - at), at + 2 * step * (one - at),
                                      at + 2 * step * (other - at)};
  std::array<double, 5> sums{};
  const auto best = best_of(context, node, places, sums);
  if (!best) return;
  const double radius = 0.5 * std::min((one - at).norm(), (other - at).norm());
  const auto place = context.surface.project_on_line(*best, radius);
  if (!place || !place->allFinite() || !within_limit(context, node, *place)) return;
  if (lowers_penalty(context, node, *place, sums[0]) && follows_line(context, node, *place)) context.patch.move(node, *place);
}

void smooth_in_sheet(const RepairContext& context, LocalNode node, double step) {
  const NodeNeighbourhood here = around(context.patch, node);
  if (!(here.size > 0) || here.normal.squaredNorm() < 0.5) return;
  const Vec3 at = context.patch.position(node);
  const Vec3 across = (here.normal.unitOrthogonal()), along = here.normal.cross(across);
  std::array<Vec3, 10> places;
  places[0] = at;
  constexpr double kDiagonal = 0.7071067811865476;
  constexpr double kWay[8][2] = {
      {1, 0}, {-1, 0}, {0, 1}, {0, -1}, {kDiagonal, kDiagonal}, {-kDiagonal, kDiagonal}, {kDiagonal, -kDiagonal}, {-kDiagonal, -kDiagonal}};
  for (std::size_t i = 0; i < 8; ++i) places[i + 1] = at + step * here.size * (kWay[i][0] * across + kWay[i][1] * along);
  const Vec3 inward = here.centre - at;
  places[9] = at + inward - here.normal * inward.dot(here.normal);
  std::array<double, 10> sums{};
  const auto best = best_of(context, node, places, sums);
  if (!best) return;
  const auto place = on_surface(context, *best, here.normal, here.size);
  if (place && within_limit(context, node, *place) && lowers_penalty(context, node, *place, sums[0])) context.patch.move(node, *place);
}

}  // namespace

void smooth_nodes(const RepairContext& context, int sweeps, bool along_lines) {
  std::vector<LocalNode> nodes = context.patch.changed_nodes();
  std::erase_if(nodes, [&](LocalNode n) { return !may_move(context.patch, n) || (!along_lines && !context.patch.node(n).lines.empty()); });
  double step = 0.2;
  for (int sweep = 0; sweep < sweeps; ++sweep, step *= 0.6)
    for (const LocalNode node : nodes) {
      if (context.patch.node(node).lines.empty())
        smooth_in_sheet(context, node, step);
      else
        smooth_on_line(context, node, step);
    }
}

}  // namespace prismesh::mesh::repair
