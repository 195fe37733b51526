#include "mesh/document/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/document/apply.h"
#include "mesh/document/dependents.h"
#include "mesh/document/edge_middles.h"
#include "mesh/document/refusal.h"
#include "mesh/document/selecting.h"
#include "mesh/document/symmetry.h"
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

/// Numbers that make no sense, whoever wrote them: JSON has no NaN, a program may.
Result<void> refuse_unsound(const Edit& edit, const Shaping& shaping) {
  const std::string what(name(edit));
  const Displacement displacement = displacement_of(edit);
  if (!displacement.by.allFinite() || !std::isfinite(displacement.distance) || !std::isfinite(displacement.degrees))
    return fail("", what + ": how far it goes must be a finite number");
  if (const auto* rotate = std::get_if<Rotate>(&edit); rotate != nullptr && !rotate->point.allFinite())
    return fail("", what + ": the axis's point must be of finite numbers");
  if (shaping.max_move && !(*shaping.max_move > 0)) return fail("", what + ": max_move must be greater than 0");
  const auto finite = [](const std::array<double, 3>& point) { return Vec3(point[0], point[1], point[2]).allFinite(); };
  const auto* place = shaping.grab ? std::get_if<std::array<double, 3>>(&*shaping.grab) : nullptr;
  if ((place != nullptr && !finite(*place)) || (shaping.grab_at && !finite(*shaping.grab_at)))
    return fail("", what + ": the grab's place must be of finite numbers");
  return {};
}

std::string no_shell_at_grab(const Model& model, const Motion& motion) {
  return "no shell touches the grabbed node " + std::to_string(model.node_ids[motion.grab.value]);
}

/// The surface, and how each node sets out on it.
Result<void> find_tracer(const Model& model, Motion& motion) {
  if (!(motion.normal.squaredNorm() > 0))
    return fail("", no_shell_at_grab(model, motion) + ", so there is no surface to slide on; use translate");
  std::vector<Vec3> normals = shape::oriented_normals(model, motion.nodes, motion.grab);
  motion.turns = shape::turns_along(model, motion.nodes, normals, motion.grab);
  shape::SurfaceTracer tracer(model, motion.nodes, std::move(normals));
  if (motion.plane) {
    std::vector<std::uint8_t> in_plane(motion.nodes.size(), 0);
    for (std::size_t i = 0; i < in_plane.size(); ++i) in_plane[i] = motion.mirrored[i].image == i ? 1 : 0;
    tracer.keep_in_plane(motion.plane->normal, std::move(in_plane));
  }
  motion.tracer = std::make_shared<const shape::SurfaceTracer>(std::move(tracer));
  return {};
}

/// What the kind of motion needs besides weights: axis, normals, surface.
Result<void> find_ways(const Model& model, const Edit& edit, Motion& motion) {
  motion.normal = shape::oriented_normals(model, {motion.grab}, motion.grab).front();
  if (const auto* rotate = std::get_if<Rotate>(&edit)) {
    const std::optional<Vec3> direction = shape::unit_of(rotate->axis);
    if (!direction) return fail("", "rotate: the axis must be a direction of finite numbers, not all 0");
    motion.axis = {rotate->point, *direction};
  }
  if (motion.kind == Motion::Kind::slide) return find_tracer(model, motion);
  if (motion.kind != Motion::Kind::lift) return {};
  const bool each = std::get<Lift>(edit).each_normal;
  if (!(motion.normal.squaredNorm() > 0))
    return fail("", no_shell_at_grab(model, motion) + ", so there is no normal to lift along; use translate");
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
  if (const Result<void> sound = refuse_unsound(edit, shaping); !sound) return fail(sound.error());
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
  Images images;
  std::optional<shape::Plane> plane;
  if (shaping.symmetry) {
    const Result<shape::Plane> found = plane_of(*shaping.symmetry);
    if (!found) return fail(found.error());
    plane = *found;
    images = find_images(model, *weights, *plane);
  }
  keep_moving(plane ? with_images(*weights, images) : *weights, model, motion);
  add_welded(generation, weights->nodes, motion);
  if (plane) link_images(*weights, images, *plane, motion);
  if (const Result<void> free = refuse_held(generation, motion.nodes, document); !free) return fail(free.error());
  if (const Result<void> found = find_ways(model, edit, motion); !found) return fail(found.error());
  return motion;
}

namespace {

/// Along the surface; the moves of a pair of images become one before they set out, each on its own side's faces.
std::size_t slide_to(const Motion& motion, const Vec3& displacement, std::span<Vec3> out) {
  std::vector<Vec3> by(motion.nodes.size());
  for (std::size_t i = 0; i < by.size(); ++i) by[i] = motion.weight[i] * (motion.turns[i] * displacement);
  if (motion.plane) by = shape::mirror_moves(*motion.plane, motion.mirrored, by);
  return motion.tracer->positions(by, motion.max_move, out);
}

/// Adds to each node's move the mirrored one of its image.
void mirror(const Motion& motion, std::span<Vec3> out) {
  std::vector<Vec3> moves(out.size());
  for (std::size_t i = 0; i < moves.size(); ++i) moves[i] = out[i] - motion.start[i];
  moves = shape::mirror_moves(*motion.plane, motion.mirrored, moves);
  for (std::size_t i = 0; i < moves.size(); ++i) out[i] = motion.start[i] + moves[i];
}

void follow(const Motion& motion, std::span<Vec3> out) {
  for (const Motion::Follower& follower : motion.followers) {
    Vec3 move = Vec3::Zero();
    for (std::size_t i = 0; i < follower.of.size(); ++i)
      if (const std::uint32_t of = follower.of[i]; of != Motion::Follower::kStays) move += follower.share[i] * (out[of] - motion.start[of]);
    out[follower.node] = motion.start[follower.node] + move;
  }
}

/// Straight back towards the start. Returns how many nodes were beyond the limit.
std::size_t hold_back(const Motion& motion, std::span<Vec3> out) {
  if (!motion.max_move) return 0;
  std::size_t held_back = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Vec3 move = out[i] - motion.start[i];
    const double length = move.norm();
    if (!(length > *motion.max_move)) continue;
    out[i] = motion.start[i] + move * (*motion.max_move / length);
    ++held_back;
  }
  return held_back;
}

}  // namespace

std::size_t positions_at(const Motion& motion, const Displacement& displacement, std::span<Vec3> out) {
  std::size_t held_back = 0;
  switch (motion.kind) {
    case Motion::Kind::translate: shape::translate(motion.start, motion.weight, displacement.by, out); break;
    case Motion::Kind::lift: shape::lift(motion.start, motion.weight, motion.normals, displacement.distance, out); break;
    case Motion::Kind::rotate:
      held_back = shape::rotate(motion.start, motion.weight, motion.axis, displacement.degrees, motion.max_move, out);
      break;
    case Motion::Kind::slide: held_back = slide_to(motion, displacement.by, out); break;
  }
  if (motion.plane && motion.kind != Motion::Kind::slide) mirror(motion, out);
  follow(motion, out);
  // on a circle and on the surface a node stops on its way
  if (motion.kind == Motion::Kind::translate || motion.kind == Motion::Kind::lift) held_back = hold_back(motion, out);
  for (std::size_t i = 0; i < out.size(); ++i)
    if (out[i] == motion.start[i]) out[i] = motion.start[i];  // -0 stays -0: what hasn't moved keeps its bits
  return held_back;
}

}  // namespace prismesh::mesh::document
