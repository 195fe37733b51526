// The target size at a place of a patch: that of the part there.
#pragma once

#include <algorithm>
#include <span>

#include "mesh/repair/context.h"

namespace prismesh::mesh::repair {

/// The target size of a shell's part.
inline double target_size_of(const RepairContext& context, LocalShell shell) {
  return context.criteria.of(context.patch.shell(shell).part).target_size;
}

struct SizeRange {
  double min, max;
};
/// The target sizes of several shells' parts; the deck's without shells.
inline SizeRange target_sizes_of(const RepairContext& context, std::span<const LocalShell> shells) {
  if (shells.empty()) return {context.criteria.target_size, context.criteria.target_size};
  SizeRange sizes{target_size_of(context, shells[0]), target_size_of(context, shells[0])};
  for (const LocalShell shell : shells) {
    const double size = target_size_of(context, shell);
    sizes = {std::min(sizes.min, size), std::max(sizes.max, size)};
  }
  return sizes;
}

/// The min target size of the parts that meet at a node: a tolerance there holds for each of them.
inline double target_size_at(const RepairContext& context, LocalNode node) {
  return target_sizes_of(context, context.patch.node(node).shells).min;
}

}  // namespace prismesh::mesh::repair
