#include "mesh/document/distance_fields.h"

#include <algorithm>

#include "base/parallel_for.h"
#include "mesh/document/field_values.h"
#include "mesh/model/topology_change.h"
#include "mesh/spatial/surface_distance.h"

namespace prismesh::mesh::document {

namespace {

// Limits of the maps in the paper.
constexpr FieldLimits kDisplacementLimits_mm{1, 5};
constexpr FieldLimits kDistanceLimits_mm{0.05, 1};

FieldLimits in_unit(const FieldLimits& millimetres, LengthUnit unit) {
  return {millimetres.clear / millimetres_per(unit), millimetres.full / millimetres_per(unit)};
}

/// The node with the same id in another model; invalid if there is none. Usually it has the same index.
NodeIndex counterpart(const Model& other, const Model& model, std::size_t node) {
  const std::int64_t id = model.node_ids[node];
  if (node < other.node_count() && other.node_ids[node] == id && !other.is_removed(NodeIndex(node))) return NodeIndex(node);
  return other.find_node(id);
}

/// The positions at which the nodes added to `now` would have been made in another state: between the nodes that they come from. In the
/// order of the added nodes; not finite where that state doesn't have the nodes they come from.
std::vector<Vec3> makings_of_added(const Model& before, const Model& now) {
  std::vector<Vec3> makings;
  const auto making = [&](NodeIndex node) -> Vec3 {
    const NodeIndex was = counterpart(before, now, node.value);
    if (was.valid()) return before.position(was);
    const std::size_t added = node.value - now.topology_change->deck_nodes;
    return is_added(now, node) && added < makings.size() ? makings[added] : Vec3::Constant(kNoValue);
  };
  for (std::size_t n = now.topology_change->deck_nodes; n < now.node_count(); ++n) {
    const NodeOrigin& origin = origin_of(now, NodeIndex(n));
    Vec3 at = Vec3::Zero();
    for (std::size_t p = 0; p < static_cast<std::size_t>(origin.count()); ++p) at += origin.weight[p] * making(origin.parent[p]);
    makings.push_back(at);
  }
  return makings;
}

void measure_added(const Model& before, const Model& now, Field& field) {
  const std::vector<Vec3> makings = makings_of_added(before, now);
  for (std::size_t i = 0; i < makings.size(); ++i) {
    const std::size_t n = now.topology_change->deck_nodes + i;
    if (now.is_removed(NodeIndex(n)) || std::isfinite(field.values[n])) continue;
    const double way = (now.positions[n] - makings[i]).norm();
    if (!std::isfinite(way)) continue;
    field.values[n] = static_cast<float>(way);
    ++field.new_nodes;
  }
}

/// Whether both models have the same nodes at the same positions in this chunk of the second.
bool same_nodes(const Model& a, const Model& b, std::size_t chunk) {
  return b.positions.shares_chunk(a.positions, chunk) && b.node_ids.shares_chunk(a.node_ids, chunk) &&
         b.node_holds.shares_chunk(a.node_holds, chunk);
}

/// 1 for each corner of an existing shell.
std::vector<std::uint8_t> corners_of_shells(const Model& model) {
  std::vector<std::uint8_t> is_corner(model.node_count());
  for (std::size_t c = 0; c < model.shell_nodes.chunk_count(); ++c)
    for (const ShellNodes& shell : model.shell_nodes.chunk(c))
      if (shell.node[0].valid())
        for (const NodeIndex node : shell.node) is_corner[node.value] = 1;
  return is_corner;
}

struct Bounds {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = Vec3::Constant(-std::numeric_limits<double>::infinity());
  void add(const Vec3& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
};

/// The shells that come within `reach` of the bounds, and perhaps others.
ShellSet shells_near(const Model& model, const Bounds& bounds, double reach) {
  ShellSet near;
  const Vec3 low = bounds.low.array() - reach, high = bounds.high.array() + reach;
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    if (model.is_removed(ShellIndex(s))) continue;
    Bounds own;
    for (const NodeIndex node : model.shell_nodes[s].node) own.add(model.position(node));
    if ((own.low.array() <= high.array()).all() && (own.high.array() >= low.array()).all()) near.emplace_back(s);
  }
  return near;
}

/// Nodes whose distance must be computed, and the max distance of the surface from any of them.
struct Questions {
  std::vector<std::uint32_t> nodes;
  std::vector<Vec3> points;
  Bounds bounds;
  double reach = 0;
};

/// Corners of `now` that have moved, or have no counterpart on the surface. `still` gets a 1 for each of the others.
Questions moved_corners(const Model& surface, const Model& now, std::vector<std::uint8_t>& still) {
  const std::vector<std::uint8_t> on_surface = corners_of_shells(surface);
  Questions questions;
  still = corners_of_shells(now);
  for (std::size_t n = 0; n < now.node_count(); ++n) {
    const Vec3& at = now.positions[n];
    if (still[n] == 0) continue;
    const bool finite = at.allFinite();
    const NodeIndex same = counterpart(surface, now, n);
    const bool known = same.valid() && on_surface[same.value] != 0 && surface.position(same).allFinite();
    if (finite && known && surface.position(same) == at) continue;
    still[n] = 0;
    if (!finite) continue;
    questions.nodes.push_back(static_cast<std::uint32_t>(n));
    questions.points.push_back(at);
    questions.bounds.add(at);
    questions.reach = std::max(questions.reach, known ? (at - surface.position(same)).norm() : std::numeric_limits<double>::infinity());
  }
  return questions;
}

void take(const std::vector<std::uint32_t>& nodes, const std::vector<double>& distances, std::size_t count, Field& field,
          const std::vector<std::uint8_t>* zeros) {
  std::vector<double> all(count, kNoValue);
  for (std::size_t i = 0; i < nodes.size(); ++i) all[nodes[i]] = distances[i];
  fill(field, count, [&](std::size_t begin, std::size_t end, double* out) {
    for (std::size_t n = begin; n < end; ++n) out[n - begin] = zeros != nullptr && (*zeros)[n] != 0 ? 0 : all[n];
  });
}

}  // namespace

Result<Field> displacement_field(const Model& before, const Model& now, LengthUnit unit) {
  Field field{"node displacement", std::string(name(unit)), true, {}, {}, in_unit(kDisplacementLimits_mm, unit)};
  fill(field, now.node_count(), [&](std::size_t begin, std::size_t end, double* out) {
    const bool same = same_nodes(before, now, begin / kChunkSize);
    for (std::size_t n = begin; n < end; ++n) {
      if (now.is_removed(NodeIndex(n))) continue;
      const NodeIndex was = same ? NodeIndex(n) : counterpart(before, now, n);
      if (was.valid()) out[n - begin] = (now.positions[n] - before.position(was)).norm();
    }
  });
  if (field.figures.measured == 0)
    return fail("displacement",
                "the two have no node in common whose coordinates are numbers; the distance between their surfaces needs none");
  if (now.topology_change) measure_added(before, now, field);
  return field;
}

Result<Field> surface_distance_field(const Model& surface, const Model& now, LengthUnit unit, const Progress& progress) {
  Field field{"distance to the surface", std::string(name(unit)), true, {}, {}, in_unit(kDistanceLimits_mm, unit)};
  std::vector<std::uint8_t> still;
  const Questions questions = moved_corners(surface, now, still);
  std::vector<double> distances;
  if (!questions.points.empty()) {
    // The closest point can't be farther away than a node has moved.
    const spatial::ShellTree tree(surface, shells_near(surface, questions.bounds, questions.reach * (1 + 1e-9)));
    Result<std::vector<double>> found = spatial::distances_to(tree, questions.points, progress);
    if (!found) return fail(found.error());
    distances = std::move(*found);
  }
  take(questions.nodes, distances, now.node_count(), field, &still);
  if (field.figures.measured == 0) return fail("distance", "there are no shells to measure from, or none to measure to");
  return field;
}

Result<Field> gap_field(const Model& model, const spatial::Shape& from, const spatial::Shape& to, LengthUnit unit,
                        const Progress& progress) {
  Field field{"distance", std::string(name(unit)), true, {}, {}, {}};
  const spatial::ShellTree tree(model, to.shells, to.nodes);
  std::vector<std::uint8_t> asked(model.node_count());
  for (const NodeIndex node : from.nodes) asked[node.value] = 1;
  for (const ShellIndex shell : from.shells)
    if (!model.is_removed(shell))
      for (const NodeIndex node : model.shell(shell).node) asked[node.value] = 1;
  Questions questions;
  for (std::size_t n = 0; n < asked.size(); ++n)
    if (asked[n] != 0 && model.positions[n].allFinite()) {
      questions.nodes.push_back(static_cast<std::uint32_t>(n));
      questions.points.push_back(model.positions[n]);
    }
  const Result<std::vector<double>> distances = spatial::distances_to(tree, questions.points, progress);
  if (!distances) return fail(distances.error());
  take(questions.nodes, *distances, model.node_count(), field, nullptr);
  if (field.figures.measured == 0) return fail("distance", "one of the two has nothing whose place is known");
  field.limits = apart(field.figures.max, field.figures.min);
  return field;
}

}  // namespace prismesh::mesh::document
