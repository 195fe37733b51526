#include "mesh/document/plan_motion.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "mesh/document/edit_kinds.h"
#include "mesh/document/edit_targets.h"
#include "mesh/document/followers.h"
#include "mesh/document/joined_sheets.h"
#include "mesh/document/refusal.h"
#include "mesh/document/selection.h"
#include "mesh/document/symmetry.h"
#include "mesh/model/adjacency.h"
#include "mesh/shape/normals.h"
#include "mesh/shape/rotate.h"

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

/// The grab among the nodes acted on; empty if the edit has none.
Result<std::optional<NodeIndex>> find_grab(const Model& model, const NodeSet& nodes, const Shaping& shaping) {
  const auto point_of = [](const std::array<double, 3>& point) { return Vec3(point[0], point[1], point[2]); };
  if (shaping.grab) {
    if (const auto* point = std::get_if<std::array<double, 3>>(&*shaping.grab)) return nearest_of(model, nodes, point_of(*point));
    const NodeIndex node = model.find_node(std::get<std::int64_t>(*shaping.grab));
    if (node.valid() && std::binary_search(nodes.begin(), nodes.end(), node)) return node;
    if (!shaping.grab_at) {
      const Result<NodeIndex> found = find_referenced_node(model, *shaping.grab);
      if (!found) return fail("", "grab: " + found.error().message);
      return fail("", "the grabbed node " + std::to_string(model.node_ids[found->value]) + " isn't among the nodes to be moved");
    }
  }
  if (shaping.grab_at) return nearest_of(model, nodes, point_of(*shaping.grab_at));
  return std::optional<NodeIndex>();
}

/// The node that origin_at names among the nodes acted on; empty without one.
Result<std::optional<NodeIndex>> find_origin_node(const Model& model, const NodeSet& nodes, const Shaping& shaping) {
  if (!shaping.origin_at) return std::optional<NodeIndex>();
  if (const auto* point = std::get_if<std::array<double, 3>>(&*shaping.origin_at))
    return nearest_of(model, nodes, Vec3((*point)[0], (*point)[1], (*point)[2]));
  const Result<NodeIndex> found = find_referenced_node(model, *shaping.origin_at);
  if (!found) return fail("", "origin_at: " + found.error().message);
  if (!std::binary_search(nodes.begin(), nodes.end(), *found))
    return fail("", "origin_at: the node " + std::to_string(model.node_ids[found->value]) + " isn't among the nodes to be moved");
  return std::optional(*found);
}

/// What the weights of an edit depend on beside its options.
Result<shape::WeightPlaces> find_places(const Model& model, const NodeSet& nodes, const Edit& edit, const Shaping& shaping) {
  const Result<std::optional<NodeIndex>> edge = find_origin_node(model, nodes, shaping);
  if (!edge) return fail(edge.error());
  shape::WeightPlaces places;
  places.edge = *edge;
  if (const auto* rotate = std::get_if<Rotate>(&edit))
    if (const std::optional<Vec3> direction = shape::unit_of(rotate->axis)) places.axis = shape::Axis{rotate->point, *direction};
  return places;
}

ShapingKind motion_kind(const Edit& edit) {
  if (std::holds_alternative<Lift>(edit)) return ShapingKind::lift;
  if (std::holds_alternative<Slide>(edit)) return ShapingKind::slide;
  if (std::holds_alternative<Move>(edit)) return ShapingKind::move;
  return std::holds_alternative<Rotate>(edit) ? ShapingKind::rotate : ShapingKind::translate;
}

/// Refuses numbers that aren't finite or in range. JSON has no NaN, but a program may pass one.
Result<void> refuse_unsound(const Edit& edit, const Shaping& shaping) {
  const std::string what(name(edit));
  const Displacement displacement = displacement_of(edit);
  if (!displacement.by.allFinite() || !std::isfinite(displacement.distance) || !std::isfinite(displacement.degrees))
    return fail("", what + ": how far it goes must be a finite number");
  const auto* rotate = std::get_if<Rotate>(&edit);
  const auto* rigid = std::get_if<Move>(&edit);
  if ((rotate != nullptr && !rotate->point.allFinite()) || (rigid != nullptr && !rigid->point.allFinite()))
    return fail("", what + ": the axis's point must be of finite numbers");
  if (shaping.max_move && !(*shaping.max_move > 0)) return fail("", what + ": max_move must be greater than 0");
  const auto finite = [](const std::array<double, 3>& point) { return Vec3(point[0], point[1], point[2]).allFinite(); };
  const auto finite_place = [&](const std::optional<NodeReference>& reference) {
    const auto* place = reference ? std::get_if<std::array<double, 3>>(&*reference) : nullptr;
    return place == nullptr || finite(*place);
  };
  if (!finite_place(shaping.grab) || (shaping.grab_at && !finite(*shaping.grab_at)))
    return fail("", what + ": the grab's place must be of finite numbers");
  if (!finite_place(shaping.origin_at)) return fail("", what + ": origin_at must be of finite numbers");
  if (shaping.origin_at && shaping.weights.origin != shape::Origin::free_edge)
    return fail("", what + ": origin_at names a free edge: it needs \"origin\": \"free_edge\"");
  return {};
}

std::string no_shell_at_grab(const Model& model, const Motion& motion) {
  return "no shell touches the grabbed node " + std::to_string(model.node_ids[motion.grab.value]);
}

/// Enters the surface to slide on, and the direction in which each node starts.
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

/// Enters what the kind of motion needs besides weights: axis, normals, surface.
Result<void> find_directions(const Model& model, const Edit& edit, Motion& motion) {
  motion.normal = shape::oriented_normals(model, {motion.grab}, motion.grab).front();
  const auto find_axis = [&](const auto& turn) -> Result<void> {
    const std::optional<Vec3> direction = shape::unit_of(turn.axis);
    if (!direction) return fail("", std::string(name(edit)) + ": the axis must be a direction of finite numbers, not all 0");
    motion.axis = {turn.point, *direction};
    return {};
  };
  Result<void> axis;
  if (const auto* rotate = std::get_if<Rotate>(&edit)) axis = find_axis(*rotate);
  if (const auto* rigid = std::get_if<Move>(&edit)) axis = find_axis(*rigid);
  if (!axis) return axis;
  if (motion.kind == ShapingKind::slide) return find_tracer(model, motion);
  if (motion.kind != ShapingKind::lift) return {};
  const bool each = std::get<Lift>(edit).each_normal;
  if (!(motion.normal.squaredNorm() > 0))
    return fail("", no_shell_at_grab(model, motion) + ", so there is no normal to lift along; use translate");
  if (each)
    motion.normals = shape::oriented_normals(model, motion.nodes, motion.grab);
  else
    motion.normals = {motion.normal};
  return {};
}

/// The nodes that the edit acts on.
Result<NodeSet> nodes_acted_on(const Generation& generation, const Edit& edit, const Shaping& shaping) {
  Result<NodeSet> nodes = shaping.on ? nodes_at(generation, *shaping.on) : selected_nodes(generation);
  if (!nodes) return nodes;
  if (nodes->empty())
    return fail("", std::string(name(edit)) + (shaping.on ? ": \"on\" names no node" : ": nothing is selected, and \"on\" names nothing"));
  return nodes;
}

Result<shape::Weights> find_weights(const Generation& generation, const Edit& edit, const Shaping& shaping) {
  const Result<NodeSet> nodes = nodes_acted_on(generation, edit, shaping);
  if (!nodes) return fail(nodes.error());
  const Result<std::optional<NodeIndex>> grab = find_grab(generation.model, *nodes, shaping);
  if (!grab) return fail(grab.error());
  Result<shape::WeightPlaces> places = find_places(generation.model, *nodes, edit, shaping);
  if (!places) return fail(places.error());
  connections::JoinedSheets joined;
  if (shaping.weights.across_welds && shaping.weights.falloff.profile != shape::Profile::constant) {
    joined = joined_sheets(generation, {});
    places->joined = &joined;
  }
  Result<shape::Weights> weights = shape::compute_weights(generation.model, *nodes, *grab, shaping.weights, *places);
  // A constant falloff needs no path along the surface: separate pieces move too.
  if (weights && shaping.weights.falloff.profile == shape::Profile::constant) weights->unreached = 0;
  return weights;
}

/// The nodes and those that follow them; ascending.
NodeSet with_followers(const NodeSet& nodes, const std::vector<FollowerNode>& followers) {
  NodeSet following;
  for (const FollowerNode& follower : followers) following.push_back(follower.node);
  std::sort(following.begin(), following.end());
  NodeSet all;
  std::merge(nodes.begin(), nodes.end(), following.begin(), following.end(), std::back_inserter(all));
  return all;
}

/// Enters the nodes and their followers, each once, with its own weight: an image that isn't acted on and a follower have none.
void put_nodes(const Model& model, const shape::Weights& weights, const NodeSet& nodes, const std::vector<FollowerNode>& followers,
               Motion& motion) {
  motion.nodes = with_followers(nodes, followers);
  auto weighted = weights.nodes.begin();
  for (const NodeIndex node : motion.nodes) {
    weighted = std::lower_bound(weighted, weights.nodes.end(), node);
    const bool has_weight = weighted != weights.nodes.end() && *weighted == node;
    motion.weight.push_back(has_weight ? weights.weight[static_cast<std::size_t>(weighted - weights.nodes.begin())] : 0.0);
    motion.start.push_back(model.position(node));
  }
  for (const FollowerNode& follower : followers) {
    Motion::Follower& placed = motion.followers.emplace_back();
    placed.node = motion.place_of(follower.node);
    motion.weight[placed.node] = 0;
    for (std::size_t i = 0; i < follower.leader.size(); ++i)
      if (follower.leader[i].valid()) placed.of[i] = motion.place_of(follower.leader[i]);
    placed.share = follower.share;
  }
}

/// The number of nodes acted on that neither have a weight nor follow a node that moves.
std::size_t count_unreached(const shape::Weights& weights, const WeightedNodes& weighted, const std::vector<FollowerNode>& welds) {
  std::size_t reached = weighted.reached_middles;
  for (const FollowerNode& weld : welds)
    if (std::binary_search(weights.nodes.begin(), weights.nodes.end(), weld.node)) ++reached;
  return weights.unreached - std::min(weights.unreached, reached);
}

}  // namespace

Result<Motion> plan_motion(const Generation& generation, const Edit& edit, const deck::Deck* named_by) {
  const Model& model = generation.model;
  const Shaping* shaping = shaping_of(edit);
  if (shaping == nullptr) return fail("", std::string(name(edit)) + " moves no nodes: only shaping edits can be dragged");
  if (const Result<void> sound = refuse_unsound(edit, *shaping); !sound) return fail(sound.error());
  const Result<shape::Weights> weights = find_weights(generation, edit, *shaping);
  if (!weights) return fail(weights.error());
  const Result<std::optional<Mirroring>> mirroring = find_mirroring(model, *weights, shaping->symmetry);
  if (!mirroring) return fail(mirroring.error());

  const WeightedNodes weighted = *mirroring ? find_weighted(model, with_images(*weights, **mirroring)) : find_weighted(model, *weights);
  const std::vector<FollowerNode> welds = find_weld_followers(generation, with_followers(weighted.nodes, weighted.middles));
  std::vector<FollowerNode> followers = weighted.middles;
  followers.insert(followers.end(), welds.begin(), welds.end());

  Motion motion;
  motion.kind = motion_kind(edit);
  motion.grab = weights->grab;
  motion.max_move = shaping->max_move;
  motion.unreached = count_unreached(*weights, weighted, welds);
  motion.free_ending = weights->free_ending;
  motion.edge = weights->edge;
  motion.other_edge = weights->other_edge;
  put_nodes(model, *weights, weighted.nodes, followers, motion);
  if (*mirroring) link_images(**mirroring, motion);
  if (const Result<void> free = refuse_held(generation, motion.nodes, named_by); !free) return fail(free.error());
  if (const Result<void> found = find_directions(model, edit, motion); !found) return fail(found.error());
  return motion;
}

}  // namespace prismesh::mesh::document
