#include "mesh/shape/normals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <Eigen/Geometry>

#include "mesh/spatial/cut_patch.h"

namespace prismesh::mesh::shape {

namespace {

using spatial::Patch;

/// Twice the shell's area along its normal, in the sense of its nodes' order.
Vec3 area_normal(const Patch& patch, std::uint32_t shell) {
  const auto& corner = patch.shells[shell];
  return (patch.positions[corner[2]] - patch.positions[corner[0]]).cross(patch.positions[corner[3]] - patch.positions[corner[1]]);
}

Vec3 unit(const Vec3& v) {
  const double length = v.norm();
  return length > 0 && std::isfinite(length) ? Vec3(v / length) : Vec3::Zero();
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

/// Orients each shell's normal like those of the shells connected to it: two neighbours agree when they run through their common side in
/// opposite directions. Where more than two shells meet, the pair with the smallest turn is connected first, and the others follow when
/// nothing else is left: so a sheet with ribs is one sheet, whichever rib the spreading begins on. On a Moebius strip the orientation that
/// reaches a shell first stays; the seam lies on the far side from the start.
class Orientation {
 public:
  explicit Orientation(const Patch& patch) : patch_(patch), sign_(patch.shells.size(), 0) {}

  void spread_from(std::uint32_t shell) {
    if (sign_[shell] != 0) return;
    sign_[shell] = 1;
    reached_.assign(1, shell);
    junctions_.clear();
    for (std::size_t at = 0, junction = 0; at < reached_.size(); ++at) {
      cross_sides_of(reached_[at]);
      while (at + 1 == reached_.size() && junction < junctions_.size()) cross_junction(junctions_[junction++]);
    }
  }

  int sign(std::uint32_t shell) const { return sign_[shell]; }

 private:
  struct Side {
    std::uint32_t shell, from, to;
  };

  void cross_sides_of(std::uint32_t shell) {
    const auto& corner = patch_.shells[shell];
    for (std::size_t i = 0; i < 4; ++i) {
      const Side side{shell, corner[i], corner[(i + 1) % 4]};
      if (side.from == side.to) continue;
      find_others(side, others_);
      if (others_.size() == 1) {
        orient(side, others_.front());
      } else if (others_.size() > 1) {
        const std::uint32_t on = smallest_turn(side, others_);
        find_others({on, side.from, side.to}, back_);
        if (smallest_turn({on, side.from, side.to}, back_) == shell) orient(side, on);
        junctions_.push_back(side);
      }
    }
  }

  /// Orients one shell only: the others at the edge may be connected to it without the junction, and are looked at again from there.
  void cross_junction(const Side& side) {
    find_others(side, others_);
    for (const std::uint32_t other : others_)
      if (sign_[other] == 0) return orient(side, other);
  }

  void find_others(const Side& side, std::vector<std::uint32_t>& out) const {
    out.clear();
    for (std::uint32_t k = patch_.node_first[side.from]; k < patch_.node_first[side.from + 1]; ++k) {
      const std::uint32_t other = patch_.node_shells[k];
      if (other != side.shell && sense_along(patch_, other, side.from, side.to) != 0) out.push_back(other);
    }
  }

  void orient(const Side& side, std::uint32_t other) {
    if (sign_[other] != 0) return;
    const int along = sense_along(patch_, side.shell, side.from, side.to);
    sign_[other] = static_cast<std::int8_t>(-along * sense_along(patch_, other, side.from, side.to) * sign_[side.shell]);
    reached_.push_back(other);
  }

  /// The one of the others that continues the shell over its side with the smallest turn; of equals the first.
  std::uint32_t smallest_turn(const Side& side, const std::vector<std::uint32_t>& others) const {
    const Vec3 inward = away_from(side, side.shell);
    std::uint32_t best = others.front();
    double min_cosine = 2;
    for (const std::uint32_t other : others)
      if (const double turned = inward.dot(away_from(side, other)); turned < min_cosine) {
        min_cosine = turned;
        best = other;
      }
    return best;
  }

  /// Unit direction in which a shell leaves its side.
  Vec3 away_from(const Side& side, std::uint32_t shell) const {
    const Vec3& from = patch_.positions[side.from];
    const Vec3 along = unit(patch_.positions[side.to] - from);
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t corner : patch_.shells[shell]) middle += patch_.positions[corner] - from;
    return unit(middle - middle.dot(along) * along);
  }

  const Patch& patch_;
  std::vector<std::int8_t> sign_;  ///< 0: not reached yet
  std::vector<std::uint32_t> reached_;
  std::vector<Side> junctions_;  ///< sides of reached shells where more than two meet
  std::vector<std::uint32_t> others_;
  std::vector<std::uint32_t> back_;
};

/// The mean of the normals of the shells at a local node. Where they cancel out (a sheet folded onto itself, the seam of a Moebius strip)
/// only rounding errors are left: then the normal of the first shell that has one.
Vec3 normal_at(const Patch& patch, const Orientation& orientation, std::size_t local) {
  constexpr double kCancelled = 1e-9;
  Vec3 sum = Vec3::Zero();
  Vec3 first = Vec3::Zero();
  double area = 0;
  for (std::uint32_t k = patch.node_first[local]; k < patch.node_first[local + 1]; ++k) {
    const Vec3 normal = orientation.sign(patch.node_shells[k]) * area_normal(patch, patch.node_shells[k]);
    if (!normal.allFinite()) continue;
    if (first.isZero(0)) first = unit(normal);
    sum += normal;
    area += normal.norm();
  }
  return sum.norm() > kCancelled * area ? unit(sum) : first;
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
    while (local < patch.nodes.size() && patch.nodes[local] < node) ++local;
    const bool there = local < patch.nodes.size() && patch.nodes[local] == node;
    normals.push_back(there ? normal_at(patch, orientation, local) : Vec3::Zero());
  }
  return normals;
}

}  // namespace prismesh::mesh::shape
