// The pairs of shells of different sheets that are joined: by welds, adhesives, rivets.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "mesh/model/index.h"

namespace prismesh::mesh::connections {

/// Pairs of shells, each in both orders, ascending.
class JoinedSheets {
 public:
  using Pair = std::pair<ShellIndex, ShellIndex>;

  JoinedSheets() = default;
  /// The pairs in any order; each is entered in both.
  explicit JoinedSheets(std::vector<Pair> pairs);
  /// The pairs of this shell with those joined to it.
  std::span<const Pair> of(ShellIndex shell) const;
  std::span<const Pair> all() const { return pairs_; }

 private:
  std::vector<Pair> pairs_;
};

}  // namespace prismesh::mesh::connections
