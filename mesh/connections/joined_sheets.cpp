#include "mesh/connections/joined_sheets.h"

#include <algorithm>
#include <cstddef>

namespace prismesh::mesh::connections {

JoinedSheets::JoinedSheets(std::vector<Pair> pairs, std::vector<std::uint32_t> sheet_numbers)
    : pairs_(std::move(pairs)), sheet_numbers_(std::move(sheet_numbers)) {
  const std::size_t count = pairs_.size();
  pairs_.reserve(2 * count);
  for (std::size_t i = 0; i < count; ++i) pairs_.emplace_back(pairs_[i].second, pairs_[i].first);
  std::sort(pairs_.begin(), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
  for (const auto& [shell, other] : pairs_) joined_.emplace_back(sheet_of(shell), sheet_of(other));
  std::sort(joined_.begin(), joined_.end());
  joined_.erase(std::unique(joined_.begin(), joined_.end()), joined_.end());
}

bool JoinedSheets::joined(std::uint32_t sheet, std::uint32_t other) const {
  return sheet == other || std::binary_search(joined_.begin(), joined_.end(), std::pair(sheet, other));
}

std::span<const JoinedSheets::Pair> JoinedSheets::of(ShellIndex shell) const {
  const auto begin = std::lower_bound(pairs_.begin(), pairs_.end(), Pair(shell, ShellIndex(std::size_t{0})));
  auto end = begin;
  while (end != pairs_.end() && end->first == shell) ++end;
  return {begin, end};
}

}  // namespace prismesh::mesh::connections
