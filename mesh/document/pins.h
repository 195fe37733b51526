// The nodes that relaxing and separating don't move. Private to mesh/document.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "mesh/document/generation.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::document {

class KeptWelds;

/// Why nodes stay, in the order in which the reasons are checked.
enum class Stays : std::uint8_t { locked, held, other_element, joined, mid_side, goes };
inline constexpr std::array<std::string_view, 5> kWhyStays{"of locked parts", "held by the deck", "with elements other than shells",
                                                           "that cards join", "beside mid-side nodes that can't follow"};

class Pins {
 public:
  /// The generation must outlive it, as must `welds`: where they are given, nodes of what may follow its nodes go. Null: these stay.
  explicit Pins(const Generation& generation, const KeptWelds* welds = nullptr);

  Stays of(NodeIndex node) const;

 private:
  Stays by_itself(NodeIndex node) const;
  void pin_beside_middles(const MidsideNodes& midside);

  const Generation& generation_;
  const KeptWelds* welds_;
  NodeSet beside_middles_;
};

/// Moves the mid-side nodes at edges of which an end has moved, by half of what each end moved by. `moved`: nodes of `before` that have
/// other positions in `next`, ascending. Returns the nodes that followed, ascending.
NodeSet let_middles_follow(const Model& before, const NodeSet& moved, Generation& next);

}  // namespace prismesh::mesh::document
