// Which shells selections and searches may use: those of parts that aren't hidden.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "mesh/model/model.h"

namespace prismesh::mesh {

/// One entry for each part, not 0 where it is hidden; empty: no part is hidden.
using OutOfSight = std::span<const std::uint8_t>;

/// Whether a shell exists and its part isn't hidden.
inline bool in_sight(const Model& model, ShellIndex shell, OutOfSight out_of_sight) {
  if (model.is_removed(shell)) return false;
  if (out_of_sight.empty()) return true;
  const PartIndex part = model.shell_parts[shell.value];
  return !part.valid() || out_of_sight[part.value] == 0;
}

}  // namespace prismesh::mesh
