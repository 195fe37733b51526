// What a repair must not change, by the deck. Only the nodes and shells near a repair are looked up.
#pragma once

#include <cstdint>
#include <functional>

#include "mesh/model/index.h"

namespace prismesh::mesh::repair {

/// Bits: what is forbidden at a node.
enum NodeRule : std::uint8_t {
  kStays = 1,   ///< it must not move: locked, held, or used by more than shells
  kNeeded = 2,  ///< it must not be removed: a card or another element has it
};
/// Bits: what is forbidden at a shell.
enum ShellRule : std::uint8_t {
  kKeepsNodes = 1,   ///< it must keep its corners
  kIndivisible = 2,  ///< it must not be divided
  kLasting = 4,      ///< it must not be removed
  kNoTriangle = 8,   ///< a quad must stay a quad, and a triangle a triangle
};
inline constexpr std::uint8_t kStaysAsItIs = kKeepsNodes | kIndivisible | kLasting | kNoTriangle;

/// An empty function forbids nothing.
struct Rules {
  std::function<std::uint8_t(NodeIndex)> node;
  std::function<std::uint8_t(ShellIndex)> shell;
  /// Whether a new node may be put between two nodes: their constraints agree, and no other element has the edge.
  std::function<bool(NodeIndex, NodeIndex)> may_divide;
  /// Whether two shells may be divided anew together, so that each gets area of the other: the same sets name both.
  std::function<bool(ShellIndex, ShellIndex)> may_exchange{};
};

}  // namespace prismesh::mesh::repair
