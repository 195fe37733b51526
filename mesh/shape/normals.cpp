#include "mesh/shape/normals.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <Eigen/Geometry>

#include "mesh/spatial/geodesic.h"

namespace prismesh::mesh::shape {

namespace {

using spatial::Patch;

/// Twice the shell's area along its normal, in the sense of its nodes' order.
Vec3 area_normal(const Patch& patch, std::uint32_t shell) {
  const auto& corner = patch.shells[shell];
  return (patch.positions[corner[2]] - patch.positions[corner[0]]).cross(patch.positions[corner[3]] - patch.positions[corner[1]]);
}

/// +1 where the shell runs from a to b along its outline, -1 from b to a, 0 if that isn't one of its sides.
int sense_along(const Patch& patch, std::uint32_t shell, std::uint32_t a, std::uint32_t b) {
  const auto& corner = patch.shells[shell];
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t from = corner[i];
    const std::uint32_t to = corner[(i + 1) % 4];
    if (from == a && to == b) return 1;
    if (from == b && to == a) return -1;
  }
  return 0;
}

/// Turns each shell's normal to agree with the shells it hangs together with: two neighbours agree when they run through
/// their common side in opposite directions.
class Orientation {
 public:
  explicit Orientation(const Patch& patch) : patch_(patch), sign_(patch.shells.size(), 0) {}

  void spread_from(std::uint32_t shell) {
    if (sign_[shell] != 0) return;
    sign_[shell] = 1;
    reached_.assign(1, shell);
    for (std::size_t at = 0; at < reached_.size(); ++at) {
      const auto corner = patch_.shells[reached_[at]];
      for (std::size_t i = 0; i < 4; ++i)
        if (corner[i] != corner[(i + 1) % 4]) cross(reached_[at], corner[i], corner[(i + 1) % 4]);
    }
  }

  int sign(std::uint32_t shell) const { return sign_[shell]; }

 private:
  void cross(std::uint32_t shell, std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t k = patch_.node_first[from]; k < patch_.node_first[from + 1]; ++k) {
      const std::uint32_t other = patch_.node_shells[k];
      if (sign_[other] != 0) continue;
      const int sense = sense_along(patch_, other, from, to);
      if (sense == 0) continue;
      sign_[other] = static_cast<std::int8_t>(-sense * sign_[shell]);
      reached_.push_back(other);
    }
  }

  const Patch& patch_;
  std::vector<std::int8_t> sign_;  ///< 0: not reached yet
  std::vector<std::uint32_t> reached_;
};

Vec3 unit(const Vec3& v) {
  const double length = v.norm();
  return length > 0 ? Vec3(v / length) : Vec3::Zero();
}

}  // namespace

std::vector<Vec3> oriented_normals(const Model& model, const NodeSet& nodes, NodeIndex reference) {
  const Patch patch = spatial::cut_patch(model, shells_touching(model, nodes));
  Orientation orientation(patch);
  const auto at_reference = std::lower_bound(patch.nodes.begin(), patch.nodes.end(), reference);
  if (at_reference != patch.nodes.end() && *at_reference == reference) {
    const auto local = static_cast<std::size_t>(at_reference - patch.nodes.begin());
    // the first in the model's order: local shells ascend with it
    if (patch.node_first[local] < patch.node_first[local + 1]) orientation.spread_from(patch.node_shells[patch.node_first[local]]);
  }
  for (std::uint32_t shell = 0; shell < patch.shells.size(); ++shell) orientation.spread_from(shell);

  std::vector<Vec3> normals;
  normals.reserve(nodes.size());
  std::size_t local = 0;
  for (const NodeIndex node : nodes) {
    Vec3 sum = Vec3::Zero();
    while (local < patch.nodes.size() && patch.nodes[local] < node) ++local;
    if (local < patch.nodes.size() && patch.nodes[local] == node)
      for (std::uint32_t k = patch.node_first[local]; k < patch.node_first[local + 1]; ++k)
        sum += orientation.sign(patch.node_shells[k]) * area_normal(patch, patch.node_shells[k]);
    normals.push_back(unit(sum));
  }
  return normals;
}

}  // namespace prismesh::mesh::shape
