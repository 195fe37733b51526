// What a repair must leave alone, as whoever knows the deck says. Asked only of what a repair comes near, so it costs what is touched.
#pragma once

#include <cstdint>
#include <functional>

#include "mesh/model/index.h"

namespace prismesh::mesh::repair {

/// Bits of what a node's surroundings forbid.
enum NodeRule : std::uint8_t {
  kStays = 1,   ///< it can't be moved: locked, held, or something besides shells hangs on it
  kNeeded = 2,  ///< it can't be removed: a card or another element has it
};
/// Bits of what a shell's surroundings forbid.
enum ShellRule : std::uint8_t {
  kKeepsNodes = 1,   ///< it can't be given other corners
  kIndivisible = 2,  ///< it can't be cut into several
  kLasting = 4,      ///< it can't be removed
  kNoTriangle = 8,   ///< a quad that can't become a triangle, or a triangle that can't become a quad
};

/// An empty function forbids nothing.
struct Rules {
  std::function<std::uint8_t(NodeIndex)> node;
  std::function<std::uint8_t(ShellIndex)> shell;
  /// Whether a new node may come between two nodes (their constraints agree, no other element shares the edge).
  std::function<bool(NodeIndex, NodeIndex)> may_divide;
};

}  // namespace prismesh::mesh::repair
