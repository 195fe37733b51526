#include "mesh/deck/assembly/assemble_parts.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "base/parallel_for.h"

namespace prismesh::mesh::deck {
namespace {

void sort_unique(std::vector<std::int64_t>& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

void collect_parts(const std::vector<std::int64_t>& of_elements, std::vector<std::int64_t>& used) {
  std::vector<std::int64_t> ids;
  for (const std::int64_t id : of_elements)
    if (id != kNoPart && (ids.empty() || ids.back() != id)) ids.push_back(id);
  sort_unique(ids);
  used.insert(used.end(), ids.begin(), ids.end());
}

/// The ids of the parts that elements name, ascending.
std::vector<std::int64_t> used_parts(std::span<const PieceCards> cards) {
  std::vector<std::vector<std::int64_t>> used(cards.size());
  parallel_for(cards.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      collect_parts(cards[p].shells.part, used[p]);
      for (int c = 0; c < kElementClassCount; ++c)
        if (c != static_cast<int>(ElementClass::mass)) collect_parts(cards[p].elements[static_cast<std::size_t>(c)].part, used[p]);
    }
  });
  std::vector<std::int64_t> ids;
  for (const auto& piece : used) ids.insert(ids.end(), piece.begin(), piece.end());
  sort_unique(ids);
  return ids;
}

}  // namespace

AssembledParts assemble_parts(std::span<const PieceCards> cards, std::vector<Part> defined) {
  std::vector<Part> parts = std::move(defined);
  const auto count = static_cast<std::ptrdiff_t>(parts.size());
  const auto by_id = [](const Part& a, const Part& b) { return a.id < b.id; };
  for (const std::int64_t id : used_parts(cards)) {
    Part part;
    part.id = id;
    if (!std::binary_search(parts.begin(), parts.begin() + count, part, by_id)) parts.push_back(part);
  }
  std::inplace_merge(parts.begin(), parts.begin() + count, parts.end(), by_id);
  std::vector<std::int64_t> ids(parts.size());
  std::transform(parts.begin(), parts.end(), ids.begin(), [](const Part& part) { return part.id; });
  return {std::make_shared<const std::vector<Part>>(std::move(parts)), IdIndex(ids)};
}

}  // namespace prismesh::mesh::deck
