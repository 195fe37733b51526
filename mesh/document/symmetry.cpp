#include "mesh/document/symmetry.h"

#include <algorithm>
#include <iterator>

#include "mesh/shape/rotate.h"

namespace prismesh::mesh::document {

namespace {

/// The node's own weight; 0 if it isn't acted on.
double weight_of(const shape::Weights& weights, NodeIndex node) {
  const auto at = std::lower_bound(weights.nodes.begin(), weights.nodes.end(), node);
  return at != weights.nodes.end() && *at == node ? weights.weight[static_cast<std::size_t>(at - weights.nodes.begin())] : 0.0;
}

}  // namespace

NodeIndex Mirroring::image_of(NodeIndex node) const {
  const auto at = std::lower_bound(images.begin(), images.end(), node, [](const auto& pair, NodeIndex n) { return pair.first < n; });
  return at != images.end() && at->first == node ? at->second : NodeIndex();
}

Result<std::optional<Mirroring>> find_mirroring(const Model& model, const shape::Weights& weights,
                                                const std::optional<Symmetry>& symmetry) {
  if (!symmetry) return std::optional<Mirroring>();
  const std::optional<Vec3> normal = shape::unit_of(symmetry->normal);
  if (!normal) return fail("", "symmetry: the plane's normal must be a direction of finite numbers, not all 0");
  if (!symmetry->point.allFinite()) return fail("", "symmetry: the plane's point must be of finite numbers");
  Mirroring mirroring;
  mirroring.plane = {symmetry->point, *normal};
  NodeSet moving;
  for (std::size_t i = 0; i < weights.nodes.size(); ++i)
    if (weights.weight[i] > 0) moving.push_back(weights.nodes[i]);
  const std::vector<NodeIndex> found = shape::find_images(model, moving, mirroring.plane);
  auto& images = mirroring.images;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    if (!found[i].valid()) {
      ++mirroring.without_image;
      continue;
    }
    images.emplace_back(moving[i], found[i]);
    images.emplace_back(found[i], moving[i]);
  }
  std::sort(images.begin(), images.end());
  images.erase(std::unique(images.begin(), images.end()), images.end());
  return std::optional(std::move(mirroring));
}

shape::Weights with_images(const shape::Weights& weights, const Mirroring& mirroring) {
  shape::Weights all;
  all.grab = weights.grab;
  all.unreached = weights.unreached;
  for (const auto& [node, image] : mirroring.images) all.nodes.push_back(node);
  NodeSet joined;
  std::set_union(weights.nodes.begin(), weights.nodes.end(), all.nodes.begin(), all.nodes.end(), std::back_inserter(joined));
  all.nodes = std::move(joined);
  for (const NodeIndex node : all.nodes) {
    const double own = weight_of(weights, node);
    const NodeIndex image = mirroring.image_of(node);
    all.weight.push_back(own > 0 || !image.valid() ? own : weight_of(weights, image));
  }
  return all;
}

void link_images(const Mirroring& mirroring, Motion& motion) {
  motion.plane = mirroring.plane;
  motion.without_image = mirroring.without_image;
  motion.mirrored.assign(motion.nodes.size(), {});
  std::vector<std::uint8_t> follows(motion.nodes.size(), 0);
  for (const Motion::Follower& follower : motion.followers) follows[follower.node] = 1;
  for (std::size_t i = 0; i < motion.nodes.size(); ++i) {
    if (follows[i] != 0) continue;
    const NodeIndex image = mirroring.image_of(motion.nodes[i]);
    const std::uint32_t place = image.valid() ? motion.place_of(image) : Motion::Follower::kStays;
    if (place != Motion::Follower::kStays && follows[place] == 0) motion.mirrored[i].image = place;
  }
  const std::uint32_t grab = motion.place_of(motion.grab);
  const bool grab_on_plane = mirroring.image_of(motion.grab) == motion.grab || grab == Motion::Follower::kStays;
  shape::find_shares(mirroring.plane, motion.start, motion.weight, grab_on_plane ? mirroring.plane.point : motion.start[grab],
                     motion.mirrored);
}

}  // namespace prismesh::mesh::document
