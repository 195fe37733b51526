#include "mesh/model/id_index.h"

#include <algorithm>
#include <functional>

namespace prismesh::mesh {
namespace {

/// A direct table may have this many slots an id: beyond, a binary search is cheaper than the memory.
constexpr std::uint64_t kSlotsPerId = 8;

}  // namespace

IdIndex::IdIndex(std::span<const std::int64_t> ids) {
  if (ids.empty()) return;
  const bool ascending = std::adjacent_find(ids.begin(), ids.end(), std::greater_equal<>()) == ids.end();
  const auto [low, high] = ascending ? std::pair(ids.front(), ids.back()) : [&] {
    const auto [a, b] = std::minmax_element(ids.begin(), ids.end());
    return std::pair(*a, *b);
  }();
  first_ = low;
  // Unsigned, because ids from hostile decks may lie further apart than the largest signed number.
  const std::uint64_t range = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low);
  const bool dense = range / kSlotsPerId < ids.size();
  if (ascending) {
    size_ = ids.size();
    contiguous_ = range == ids.size() - 1;
    if (contiguous_) return;
    ids_.assign(ids.begin(), ids.end());
    if (!dense) return;
    dense_.assign(range + 1, kNotFound);
    for (std::size_t i = 0; i < ids.size(); ++i) dense_[static_cast<std::uint64_t>(ids[i] - first_)] = static_cast<std::uint32_t>(i);
  } else if (dense) {
    build_dense(ids, range);
  } else {
    build_sorted(ids);
  }
}

void IdIndex::build_dense(std::span<const std::int64_t> ids, std::uint64_t range) {
  dense_.assign(range + 1, kNotFound);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    std::uint32_t& slot = dense_[static_cast<std::uint64_t>(ids[i] - first_)];
    if (slot == kNotFound)
      slot = static_cast<std::uint32_t>(i);
    else
      duplicates_.push_back(ids[i]);
  }
  std::sort(duplicates_.begin(), duplicates_.end());
  duplicates_.erase(std::unique(duplicates_.begin(), duplicates_.end()), duplicates_.end());
  ids_.reserve(ids.size());
  order_.reserve(ids.size());
  for (std::size_t slot = 0; slot < dense_.size(); ++slot)
    if (dense_[slot] != kNotFound) {
      ids_.push_back(first_ + static_cast<std::int64_t>(slot));
      order_.push_back(dense_[slot]);
    }
  size_ = ids_.size();
}

void IdIndex::build_sorted(std::span<const std::int64_t> ids) {
  std::vector<std::pair<std::int64_t, std::uint32_t>> sorted(ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i) sorted[i] = {ids[i], static_cast<std::uint32_t>(i)};
  std::sort(sorted.begin(), sorted.end());
  ids_.reserve(ids.size());
  order_.reserve(ids.size());
  for (const auto& [id, index] : sorted) {
    if (!ids_.empty() && ids_.back() == id) {
      if (duplicates_.empty() || duplicates_.back() != id) duplicates_.push_back(id);
      continue;
    }
    ids_.push_back(id);
    order_.push_back(index);
  }
  size_ = ids_.size();
}

std::uint32_t IdIndex::find_sorted(std::int64_t id) const {
  const auto at = std::lower_bound(ids_.begin(), ids_.end(), id);
  if (at == ids_.end() || *at != id) return kNotFound;
  return index_at(static_cast<std::size_t>(at - ids_.begin()));
}

std::size_t IdIndex::lower_bound(std::int64_t id) const {
  if (!contiguous_) return static_cast<std::size_t>(std::lower_bound(ids_.begin(), ids_.end(), id) - ids_.begin());
  if (id <= first_) return 0;
  const std::uint64_t offset = static_cast<std::uint64_t>(id) - static_cast<std::uint64_t>(first_);
  return static_cast<std::size_t>(std::min<std::uint64_t>(offset, size_));
}

}  // namespace prismesh::mesh
