#include "mesh/shape/move.h"

#include <cstddef>

namespace prismesh::mesh::shape {

void translate(std::span<const Vec3> start, std::span<const double> weight, const Vec3& by, std::span<Vec3> out) {
  for (std::size_t i = 0; i < start.size(); ++i) out[i] = start[i] + weight[i] * by;
}

void lift(std::span<const Vec3> start, std::span<const double> weight, std::span<const Vec3> normals, double distance,
          std::span<Vec3> out) {
  const bool each = normals.size() > 1;
  for (std::size_t i = 0; i < start.size(); ++i) out[i] = start[i] + (weight[i] * distance) * normals[each ? i : 0];
}

}  // namespace prismesh::mesh::shape
