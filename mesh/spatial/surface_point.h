// A point of a surface: on which shell, and where on it.
#pragma once

#include <array>

#include "mesh/model/model.h"

namespace prismesh::mesh::spatial {

struct SurfacePoint {
  ShellIndex shell;
  Vec3 point = Vec3::Zero();
  double distance = 0;
  std::array<double, 4> share{};  ///< of the shell's corners, 0..1, sum 1: point = sum of share * corner; a triangle's last is 0
};

}  // namespace prismesh::mesh::spatial
