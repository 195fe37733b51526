#include "mesh/deck/data/taken_ids.h"

#include <algorithm>
#include <iterator>

namespace prismesh::mesh::deck {

void unite(std::vector<IdRange>& ranges) {
  std::erase_if(ranges, [](const IdRange& range) { return range.last < range.first; });
  std::sort(ranges.begin(), ranges.end(), [](const IdRange& a, const IdRange& b) { return a.first < b.first; });
  std::size_t out = 0;
  for (std::size_t r = 1; r < ranges.size(); ++r) {
    if (ranges[r].first - 1 <= ranges[out].last)
      ranges[out].last = std::max(ranges[out].last, ranges[r].last);
    else
      ranges[++out] = ranges[r];
  }
  ranges.resize(std::min(ranges.size(), out + 1));
}

const IdRange* range_with(const std::vector<IdRange>& ranges, std::int64_t id) {
  const auto after =
      std::upper_bound(ranges.begin(), ranges.end(), id, [](std::int64_t value, const IdRange& r) { return value < r.first; });
  if (after == ranges.begin() || std::prev(after)->last < id) return nullptr;
  return &*std::prev(after);
}

}  // namespace prismesh::mesh::deck
