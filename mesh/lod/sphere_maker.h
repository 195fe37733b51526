// Spheres around points and spheres. Private to mesh/lod.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "mesh/lod/levels.h"

namespace prismesh::mesh::lod {

/// Around the points: the middle of their box, and the farthest of them.
class SphereMaker {
 public:
  void add(const Vec3& point);
  Sphere sphere() const;

 private:
  Vec3 low_ = Vec3::Constant(std::numeric_limits<double>::infinity()), high_ = -low_;
  std::vector<Vec3> points_;
};

Sphere around(std::span<const Sphere> spheres);
/// Around the nodes of a cluster of shells.
Sphere bounds_of_shells(const Model& model, const Levels& levels, const Cluster& cluster);

}  // namespace prismesh::mesh::lod
