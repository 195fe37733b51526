// Shells given by points instead of a model's nodes, for a drag or a trial.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "mesh/model/model.h"
#include "mesh/quality/shell_properties.h"

namespace prismesh::mesh::quality {

struct PointShells {
  std::span<const Vec3> moving;  ///< deck's length unit
  std::span<const Vec3> fixed;
  /// Of each shell: corner >= 0 is moving[corner], < 0 is fixed[~corner]; a triangle repeats its third.
  std::span<const std::array<std::int32_t, 4>> corners;
  std::span<const ShellProperties> properties;  ///< of each shell, or empty if unknown
};

}  // namespace prismesh::mesh::quality
