// Operations on the shells of a mesh.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "mesh/model/index.h"

namespace prismesh::mesh::repair {

enum class Operation : std::uint8_t {
  split,     ///< a quad into two triangles; shells across, with their neighbours
  collapse,  ///< an edge to a point
  merge,     ///< two triangles into a quad
  swap,      ///< two shells are divided along another edge
  move,      ///< a warped quad's corner along the normal; not for a manual operation
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
