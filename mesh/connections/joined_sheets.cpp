#include "mesh/connections/joined_sheets.h"

#include <algorithm>
#include <cstddef>

namespace prismesh::mesh::connections {

JoinedSheets::JoinedSheets(std::vector<Pair> pairs) : pairs_(std::move(pairs)) {
  const std::size_t count = pairs_.size();
  pairs_.reserve(2 * count);
  for (std::size_t i = 0; i < count; ++i) pairs_.emplace_back(pairs_[i].second, pairs_[i].first);
  std::sort(pairs_.begin(), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
}

std::span<const JoinedSheets::Pair> JoinedSheets::of(ShellIndex shell) const {
  const auto begin = std::lower_bound(pairs_.begin(), pairs_.end(), Pair(shell, ShellIndex(std::size_t{0})));
  auto end = begin;
  while (end != pairs_.end() && end->first == shell) ++end;
  return {begin, end};
}

}  // namespace prismesh::mesh::connections
