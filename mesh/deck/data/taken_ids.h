// Ids that a deck uses without having a node or an element of its model with them.
#pragma once

#include <cstdint>
#include <vector>

namespace prismesh::mesh::deck {

/// The ids from first to last; none if last < first.
struct IdRange {
  std::int64_t first = 0;
  std::int64_t last = 0;
  bool operator==(const IdRange&) const = default;
};

/// What shares the number space of nodes or elements and isn't in the model: scalar points, aerodynamic boxes, what cards generate when the
/// solver starts. New nodes and elements can't have these ids. Each list ascends and its ranges are apart, after unite().
struct TakenIds {
  std::vector<IdRange> nodes;
  std::vector<IdRange> elements;
};

/// Sorts ranges and makes one of those that meet, so that a range holds consecutive ids together.
void unite(std::vector<IdRange>& ranges);
/// The range with the id, in united ranges; null: none.
const IdRange* range_with(const std::vector<IdRange>& ranges, std::int64_t id);

}  // namespace prismesh::mesh::deck
