// Which sheets are joined, and at which shells.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mesh/model/index.h"

namespace prismesh::mesh::connections {

/// Pairs of shells of different sheets, each in both orders, ascending. A sheet is all shells that are connected over shared nodes.
class JoinedSheets {
 public:
  using Pair = std::pair<ShellIndex, ShellIndex>;

  JoinedSheets() = default;
  /// The pairs in any order; each is entered in both. `sheet_numbers`: one for each shell of the model, the same within a sheet.
  JoinedSheets(std::vector<Pair> pairs, std::vector<std::uint32_t> sheet_numbers);

  /// The pairs of this shell with those joined to it.
  std::span<const Pair> of(ShellIndex shell) const;
  std::span<const Pair> all() const { return pairs_; }

  std::uint32_t sheet_of(ShellIndex shell) const { return sheet_numbers_[shell.value]; }
  /// Whether a pair joins these sheets somewhere, or they are the same.
  bool joined(std::uint32_t sheet, std::uint32_t other) const;

 private:
  std::vector<Pair> pairs_;
  std::vector<std::uint32_t> sheet_numbers_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> joined_;  ///< pairs of sheets, ascending, each in both orders
};

}  // namespace prismesh::mesh::connections
