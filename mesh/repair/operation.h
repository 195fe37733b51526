// The names of what can be done to a mesh's structure.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "mesh/model/index.h"

namespace prismesh::mesh::repair {

enum class Operation : std::uint8_t {
  split,     ///< a quad into two triangles; a stretched shell (and its neighbour) across
  collapse,  ///< an edge to a point
  merge,     ///< two triangles into a quad
  swap,      ///< the edge that two shells share turns
  move,      ///< a warped quad's corner along the normal; not by hand
};
inline constexpr int kOperationCount = 5;
std::string_view name(Operation operation);  ///< as in an edit's JSON

/// An operation and the elements to carry it out on.
struct ManualOperation {
  Operation operation = Operation::split;
  std::span<const ShellIndex> shells;
  std::span<const NodeIndex> nodes;
};

}  // namespace prismesh::mesh::repair
