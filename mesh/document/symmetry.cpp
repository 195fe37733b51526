#include "mesh/document/symmetry.h"

#include <algorithm>

namespace prismesh::mesh::document {

namespace {

/// The own weight of a node; 0 where it isn't acted on.
double weight_of(const shape::Weights& weights, NodeIndex node) {
  const auto at = std::lower_bound(weights.nodes.begin(), weights.nodes.end(), node);
  return at != weights.nodes.end() && *at == node ? weights.weight[static_cast<std::size_t>(at - weights.nodes.begin())] : 0.0;
}

}  // namespace

Result<shape::Plane> plane_of(const Symmetry& symmetry) {
  const std::optional<Vec3> normal = shape::unit_of(symmetry.normal);
  if (!normal) return fail("", "symmetry: the plane's normal must be a direction of finite numbers, not all 0");
  if (!symmetry.point.allFinite()) return fail("", "symmetry: the plane's point must be of finite numbers");
  return shape::Plane{symmetry.point, *normal};
}

NodeIndex Images::find(NodeIndex node) const {
  const auto at = std::lower_bound(of.begin(), of.end(), node, [](const auto& pair, NodeIndex n) { return pair.first < n; });
  return at != of.end() && at->first == node ? at->second : NodeIndex();
}

Images find_images(const Model& model, const shape::Weights& weights, const shape::Plane& plane) {
  NodeSet moving;
  for (std::size_t i = 0; i < weights.nodes.size(); ++i)
    if (weights.weight[i] > 0) moving.push_back(weights.nodes[i]);
  const std::vector<NodeIndex> found = shape::find_images(model, moving, plane);
  Images images;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    if (!found[i].valid()) {
      ++images.missing;
      continue;
    }
    images.of.emplace_back(moving[i], found[i]);
    images.of.emplace_back(found[i], moving[i]);
  }
  std::sort(images.of.begin(), images.of.end());
  images.of.erase(std::unique(images.of.begin(), images.of.end()), images.of.end());
  return images;
}

shape::Weights with_images(const shape::Weights& weights, const Images& images) {
  shape::Weights all;
  all.grab = weights.grab;
  all.unreached = weights.unreached;
  for (const auto& [node, image] : images.of) all.nodes.push_back(node);
  NodeSet joined;
  std::set_union(weights.nodes.begin(), weights.nodes.end(), all.nodes.begin(), all.nodes.end(), std::back_inserter(joined));
  all.nodes = std::move(joined);
  for (const NodeIndex node : all.nodes) {
    const double own = weight_of(weights, node);
    const NodeIndex image = images.find(node);
    all.weight.push_back(own > 0 || !image.valid() ? own : weight_of(weights, image));
  }
  return all;
}

void link_images(const shape::Weights& weights, const Images& images, const shape::Plane& plane, Motion& motion) {
  motion.plane = plane;
  motion.without_image = images.missing;
  motion.mirrored.assign(motion.nodes.size(), {});
  std::vector<std::uint8_t> follows(motion.nodes.size(), 0);
  for (const Motion::Follower& follower : motion.followers) follows[follower.node] = 1;
  for (std::size_t i = 0; i < motion.nodes.size(); ++i) {
    if (follows[i] != 0) continue;
    motion.weight[i] = weight_of(weights, motion.nodes[i]);
    const NodeIndex image = images.find(motion.nodes[i]);
    const auto at = std::lower_bound(motion.nodes.begin(), motion.nodes.end(), image);
    if (!image.valid() || at == motion.nodes.end() || *at != image || follows[static_cast<std::size_t>(at - motion.nodes.begin())] != 0)
      continue;
    motion.mirrored[i].image = static_cast<std::uint32_t>(at - motion.nodes.begin());
  }
  const auto grab = std::lower_bound(motion.nodes.begin(), motion.nodes.end(), motion.grab);
  const bool grab_on_plane = images.find(motion.grab) == motion.grab || grab == motion.nodes.end();
  shape::find_shares(plane, motion.start, motion.weight,
                     grab_on_plane ? plane.point : motion.start[static_cast<std::size_t>(grab - motion.nodes.begin())], motion.mirrored);
}

}  // namespace prismesh::mesh::document
