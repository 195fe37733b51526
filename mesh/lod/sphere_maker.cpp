#include "mesh/lod/sphere_maker.h"

#include <algorithm>

namespace prismesh::mesh::lod {

void SphereMaker::add(const Vec3& point) {
  low_ = low_.cwiseMin(point);
  high_ = high_.cwiseMax(point);
  points_.push_back(point);
}

Sphere SphereMaker::sphere() const {
  if (points_.empty()) return {};
  Sphere sphere{(low_ + high_) / 2, 0};
  for (const Vec3& point : points_) sphere.radius = std::max(sphere.radius, (point - sphere.centre).norm());
  return sphere;
}

Sphere around(std::span<const Sphere> spheres) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Sphere& each : spheres) {
    low = low.cwiseMin((each.centre.array() - each.radius).matrix());
    high = high.cwiseMax((each.centre.array() + each.radius).matrix());
  }
  Sphere sphere{(low + high) / 2, 0};
  for (const Sphere& each : spheres) sphere.radius = std::max(sphere.radius, (each.centre - sphere.centre).norm() + each.radius);
  return sphere;
}

Sphere bounds_of_shells(const Model& model, const Levels& levels, const Cluster& cluster) {
  SphereMaker maker;
  for (std::uint32_t i = 0; i < cluster.count; ++i)
    for (const NodeIndex node : model.shell(levels.shells[cluster.first + i]).node) maker.add(model.position(node));
  return maker.sphere();
}

}  // namespace prismesh::mesh::lod
