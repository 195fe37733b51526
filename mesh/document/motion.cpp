#include "mesh/document/motion.h"

#include <algorithm>
#include <limits>

#include "mesh/document/apply.h"
#include "mesh/document/refusal.h"
#include "mesh/document/selecting.h"
#include "mesh/model/adjacency.h"
#include "mesh/shape/move.h"
#include "mesh/shape/normals.h"

namespace prismesh::mesh::document {

namespace {

NodeIndex nearest_of(const Model& model, const NodeSet& nodes, const Vec3& point) {
  NodeIndex best = nodes.front();
  double least = std::numeric_limits<double>::infinity();
  for (const NodeIndex node : nodes) {
    const double distance = (model.position(node) - point).squaredNorm();
    if (distance < least) {
      least = distance;
      best = node;
    }
  }
  return best;
}

/// The grab among the nodes acted on; nothing if the edit leaves it open.
Result<std::optional<NodeIndex>> find_grab(const Model& model, const NodeSet& nodes, const Shaping& shaping) {
  const auto point_of = [](const std::array<double, 3>& point) { return Vec3(point[0], point[1], point[2]); };
  if (shaping.grab) {
    if (const auto* point = std::get_if<std::array<double, 3>>(&*shaping.grab)) return nearest_of(model, nodes, point_of(*point));
    const NodeIndex node = model.find_node(std::get<std::int64_t>(*shaping.grab));
    if (node.valid() && std::binary_search(nodes.begin(), nodes.end(), node)) return node;
    if (!shaping.grab_at) {
      const Result<NodeIndex> found = find_place(model, *shaping.grab);
      if (!found) return fail("", "grab: " + found.error().message);
      return fail("", "the grabbed node " + std::to_string(model.node_ids[found->value]) + " isn't among the nodes to be moved");
    }
  }
  if (shaping.grab_at) return nearest_of(model, nodes, point_of(*shaping.grab_at));
  return std::optional<NodeIndex>();
}

/// The mid-side nodes on edges with an end among the nodes acted on, or acted on themselves, with the ends of their edges; ascending,
/// each once. A node that is a corner elsewhere moves as one.
struct EdgeMiddle {
  NodeIndex node;
  std::array<NodeIndex, 2> end;
};
std::vector<EdgeMiddle> middles_in(const Model& model, const NodeSet& nodes, const ShellSet& shells) {
  std::vector<EdgeMiddle> middles;
  if (!model.midside || model.midside->empty()) return middles;
  const auto acted_on = [&](NodeIndex node) { return std::binary_search(nodes.begin(), nodes.end(), node); };
  const auto& all = *model.midside;
  auto entry = all.begin();
  for (const ShellIndex shell : shells) {
    entry = std::lower_bound(entry, all.end(), shell, [](const MidsideNodes& m, ShellIndex s) { return m.shell < s; });
    if (entry == all.end()) break;
    if (entry->shell != shell) continue;
    const ShellNodes& corners = model.shell(shell);
    const int count = corners.corners();
    for (int i = 0; i < count; ++i) {
      const NodeIndex node = entry->node[i];
      const std::array<NodeIndex, 2> end = {corners.node[i], corners.node[(i + 1) % count]};
      if (!node.valid() || !model.adjacency->shells_of(node).empty()) continue;
      if (acted_on(node) || acted_on(end[0]) || acted_on(end[1])) middles.push_back({node, end});
    }
  }
  std::stable_sort(middles.begin(), middles.end(), [](const EdgeMiddle& a, const EdgeMiddle& b) { return a.node < b.node; });
  middles.erase(std::unique(middles.begin(), middles.end(), [](const EdgeMiddle& a, const EdgeMiddle& b) { return a.node == b.node; }),
                middles.end());
  return middles;
}

/// Position of a node in motion.nodes, or kStays.
std::uint32_t place_in(const NodeSet& nodes, NodeIndex node) {
  const auto at = std::lower_bound(nodes.begin(), nodes.end(), node);
  return at != nodes.end() && *at == node ? static_cast<std::uint32_t>(at - nodes.begin()) : Motion::Follower::kStays;
}

/// Keeps what moves: nodes with a weight, and middles of edges of which an end has one.
void keep_moving(const shape::Weights& weights, const Model& model, Motion& motion) {
  const auto weight_of = [&](NodeIndex node) {
    const std::uint32_t at = place_in(weights.nodes, node);
    return at == Motion::Follower::kStays ? 0.0 : weights.weight[at];
  };
  const auto keep = [&](NodeIndex node, double weight) {
    motion.nodes.push_back(node);
    motion.weight.push_back(weight);
    motion.start.push_back(model.position(node));
  };
  const std::vector<EdgeMiddle> middles = middles_in(model, weights.nodes, shells_touching(model, weights.nodes));
  auto middle = middles.begin();
  std::size_t i = 0;
  while (i < weights.nodes.size() || middle != middles.end()) {
    const bool has_node = i < weights.nodes.size();
    if (middle == middles.end() || (has_node && weights.nodes[i] < middle->node)) {
      if (weights.weight[i] > 0) keep(weights.nodes[i], weights.weight[i]);
      ++i;
      continue;
    }
    if (weight_of(middle->end[0]) > 0 || weight_of(middle->end[1]) > 0) keep(middle->node, 0.0);
    if (has_node && weights.nodes[i] == middle->node) {
      if (motion.unreached > 0) --motion.unreached;
      ++i;
    }
    ++middle;
  }
  for (const EdgeMiddle& each : middles)
    if (const std::uint32_t at = place_in(motion.nodes, each.node); at != Motion::Follower::kStays)
      motion.followers.push_back(
          {at,
           {place_in(motion.nodes, each.end[0]), place_in(motion.nodes, each.end[1]), Motion::Follower::kStays, Motion::Follower::kStays},
           {0.5, 0.5, 0, 0}});
}

Motion::Kind kind_of(const Edit& edit) {
  if (std::holds_alternative<Lift>(edit)) return Motion::Kind::lift;
  if (std::holds_alternative<Slide>(edit)) return Motion::Kind::slide;
  return std::holds_alternative<Rotate>(edit) ? Motion::Kind::rotate : Motion::Kind::translate;
}

/// What the kind of motion needs besides weights: axis, normals, surface.
Result<void> find_ways(const Model& model, const Edit& edit, Motion& motion) {
  motion.normal = shape::oriented_normals(model, {motion.grab}, motion.grab).front();
  if (const auto* rotate = std::get_if<Rotate>(&edit)) {
    const std::optional<Vec3> direction = shape::unit_of(rotate->axis);
    if (!direction) return fail("", "rotate: the axis has no direction");
    motion.axis = {rotate->point, *direction};
  }
  if (motion.kind == Motion::Kind::slide) {
    if (!(motion.normal.squaredNorm() > 0))
      return fail("", "no shell touches the grabbed node " + std::to_string(model.node_ids[motion.grab.value]) +
                          ", so there is no surface to slide on; use translate");
    motion.slideway =
        std::make_shared<const shape::Slideway>(model, motion.nodes, shape::oriented_normals(model, motion.nodes, motion.grab));
  }
  if (motion.kind != Motion::Kind::lift) return {};
  const bool each = std::get<Lift>(edit).each_normal;
  if (!(motion.normal.squaredNorm() > 0))
    return fail("", "no shell touches the grabbed node " + std::to_string(model.node_ids[motion.grab.value]) +
                        ", so there is no normal to lift along; use translate");
  if (each)
    motion.normals = shape::oriented_normals(model, motion.nodes, motion.grab);
  else
    motion.normals = {motion.normal};
  return {};
}

}  // namespace

Result<Motion> plan_motion(const Generation& generation, const Edit& edit, const Document* document) {
  const Shaping* shaping_in_edit = shaping_of(edit);
  if (shaping_in_edit == nullptr) return fail("", std::string(name(edit)) + " moves no nodes: only shaping edits can be dragged");
  const Shaping& shaping = *shaping_in_edit;
  if (shaping.symmetry) return fail("", std::string(name(edit)) + " isn't there yet");
  const Model& model = generation.model;

  NodeSet nodes;
  if (shaping.on) {
    Result<NodeSet> on = nodes_at(generation, *shaping.on);
    if (!on) return fail(on.error());
    nodes = std::move(*on);
  } else {
    nodes = selection(generation);
  }
  if (nodes.empty())
    return fail("", std::string(name(edit)) + (shaping.on ? ": \"on\" names no node" : ": nothing is selected, and \"on\" names nothing"));

  const Result<std::optional<NodeIndex>> grab = find_grab(model, nodes, shaping);
  if (!grab) return fail(grab.error());
  const Result<shape::Weights> weights = shape::compute_weights(model, nodes, *grab, shaping.weights);
  if (!weights) return fail(weights.error());

  Motion motion;
  motion.kind = kind_of(edit);
  motion.grab = weights->grab;
  // a constant falloff asks for no way along the surface: pieces apart move too
  motion.unreached = shaping.weights.falloff.profile == shape::Profile::constant ? 0 : weights->unreached;
  motion.max_move = shaping.max_move;
  keep_moving(*weights, model, motion);
  if (const Result<void> free = refuse_held(generation, motion.nodes, document); !free) return fail(free.error());
  if (const Result<void> found = find_ways(model, edit, motion); !found) return fail(found.error());
  return motion;
}

std::size_t positions_at(const Motion& motion, const Displacement& displacement, std::span<Vec3> out) {
  // on a circle, on the surface: there a node that may go no farther stays on its way
  const bool stops_itself = motion.kind == Motion::Kind::rotate || motion.kind == Motion::Kind::slide;
  std::size_t held_back = 0;
  switch (motion.kind) {
    case Motion::Kind::translate: shape::translate(motion.start, motion.weight, displacement.by, out); break;
    case Motion::Kind::lift: shape::lift(motion.start, motion.weight, motion.normals, displacement.distance, out); break;
    case Motion::Kind::rotate:
      held_back = shape::rotate(motion.start, motion.weight, motion.axis, displacement.degrees, motion.max_move, out);
      break;
    case Motion::Kind::slide: {
      std::vector<Vec3> by(motion.nodes.size());
      for (std::size_t i = 0; i < by.size(); ++i) by[i] = motion.weight[i] * displacement.by;
      held_back = motion.slideway->positions(by, motion.max_move, out);
      break;
    }
  }
  for (const Motion::Follower& follower : motion.followers) {
    Vec3 move = Vec3::Zero();
    for (std::size_t i = 0; i < follower.of.size(); ++i)
      if (const std::uint32_t of = follower.of[i]; of != Motion::Follower::kStays) move += follower.share[i] * (out[of] - motion.start[of]);
    out[follower.node] = motion.start[follower.node] + move;
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i] == motion.start[i]) out[i] = motion.start[i];  // -0 stays -0: what hasn't moved keeps its bits
    if (!motion.max_move || stops_itself) continue;
    const Vec3 move = out[i] - motion.start[i];
    const double length = move.norm();
    if (!(length > *motion.max_move)) continue;
    out[i] = motion.start[i] + move * (*motion.max_move / length);
    ++held_back;
  }
  return held_back;
}

}  // namespace prismesh::mesh::document
