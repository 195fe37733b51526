// Projects points into a view. Private to mesh/select.
#pragma once

#include <array>
#include <cstddef>

#include "mesh/model/model.h"

namespace prismesh::mesh::select {

using ViewMatrix = std::array<double, 16>;  ///< deck coordinates to clip space, column-major

struct ClipPoint {
  double x = 0;
  double y = 0;
  double z = 0;
  double w = 0;
};

inline double clip_row(const ViewMatrix& view, std::size_t r, const Vec3& p) {
  return view[r] * p.x() + view[4 + r] * p.y() + view[8 + r] * p.z() + view[12 + r];
}

inline ClipPoint clip_point(const ViewMatrix& view, const Vec3& p) {
  return {clip_row(view, 0, p), clip_row(view, 1, p), clip_row(view, 2, p), clip_row(view, 3, p)};
}

}  // namespace prismesh::mesh::select
