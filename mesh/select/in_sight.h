// Parts that are out of sight, as selections ask for them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "mesh/model/model.h"

namespace prismesh::mesh::select {

/// An entry for each part, not 0 where it is hidden; empty: all are in sight.
using OutOfSight = std::span<const std::uint8_t>;

/// Whether a shell is there and in sight.
inline bool in_sight(const Model& model, ShellIndex shell, OutOfSight out_of_sight) {
  if (model.is_removed(shell)) return false;
  if (out_of_sight.empty()) return true;
  const PartIndex part = model.shell_parts[shell.value];
  return !part.valid() || out_of_sight[part.value] == 0;
}

}  // namespace prismesh::mesh::select
