#include "mesh/model/id_index.h"

#include <algorithm>
#include <functional>

#include "base/large_memory.h"

namespace prismesh::mesh {
namespace {

/// Max slots of a direct table for each id: with more, a binary search is cheaper than the memory.
constexpr std::uint64_t kSlotsPerId = 8;
/// Max spans for each id. Real decks number each part from a round number on: a span holds a piece of one run.
constexpr std::uint64_t kSpansPerId = 2;

}  // namespace

IdIndex::IdIndex(std::span<const std::int64_t> ids) {
  if (ids.empty()) return;
  const bool ascending = std::adjacent_find(ids.begin(), ids.end(), std::greater_equal<>()) == ids.end();
  const auto [low, high] = ascending ? std::pair(ids.front(), ids.back()) : [&] {
    const auto [a, b] = std::minmax_element(ids.begin(), ids.end());
    return std::pair(*a, *b);
  }();
  first_ = low;
  // unsigned: ids in a hostile deck may differ by more than the largest signed number
  const std::uint64_t range = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low);
  const bool dense = range / kSlotsPerId < ids.size();
  if (ascending) {
    size_ = ids.size();
    contiguous_ = range == ids.size() - 1;
    if (contiguous_) return;
    reserve_large(ids_, ids.size());
    ids_.assign(ids.begin(), ids.end());
    if (!dense) {
      build_spans();
      return;
    }
    reserve_large(dense_, range + 1);
    dense_.assign(range + 1, kNotFound);
    for (std::size_t i = 0; i < ids.size(); ++i) dense_[static_cast<std::uint64_t>(ids[i] - first_)] = static_cast<std::uint32_t>(i);
  } else if (dense) {
    build_dense(ids, range);
  } else {
    build_sorted(ids);
  }
}

void IdIndex::build_dense(std::span<const std::int64_t> ids, std::uint64_t range) {
  reserve_large(dense_, range + 1);
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
  reserve_large(ids_, ids.size());
  reserve_large(order_, ids.size());
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
  build_spans();
}

void IdIndex::build_spans() {
  const auto offset_of = [this](std::size_t rank) { return static_cast<std::uint64_t>(ids_[rank]) - static_cast<std::uint64_t>(first_); };
  const std::uint64_t range = offset_of(ids_.size() - 1);
  for (span_bits_ = 0; (range >> span_bits_) / kSpansPerId >= ids_.size();) ++span_bits_;
  const std::size_t count = static_cast<std::size_t>(range >> span_bits_) + 1;
  reserve_large(spans_, count + 1);
  for (std::size_t rank = 0; rank < ids_.size(); ++rank)
    spans_.resize(std::max(spans_.size(), static_cast<std::size_t>(offset_of(rank) >> span_bits_) + 1), static_cast<std::uint32_t>(rank));
  spans_.push_back(static_cast<std::uint32_t>(ids_.size()));
}

/// `id` isn't below the first.
std::uint32_t IdIndex::find_sorted(std::int64_t id) const {
  const std::uint64_t span = (static_cast<std::uint64_t>(id) - static_cast<std::uint64_t>(first_)) >> span_bits_;
  if (span + 1 >= spans_.size()) return kNotFound;
  const std::size_t begin = spans_[span], end = spans_[span + 1];
  if (begin == end || id < ids_[begin]) return kNotFound;
  // In a run that counts up by one the distance from the first is the place.
  const std::uint64_t ahead = static_cast<std::uint64_t>(id) - static_cast<std::uint64_t>(ids_[begin]);
  if (ahead < end - begin && ids_[begin + ahead] == id) return index_at(begin + ahead);
  const auto last = ids_.begin() + static_cast<std::ptrdiff_t>(end);
  const auto at = std::lower_bound(ids_.begin() + static_cast<std::ptrdiff_t>(begin), last, id);
  return at == last || *at != id ? kNotFound : index_at(static_cast<std::size_t>(at - ids_.begin()));
}

IdIndex& IdIndex::own(std::shared_ptr<const IdIndex>& index) {
  if (!index->base_ || index.use_count() > 1) {
    auto changed = std::make_shared<IdIndex>();
    if (index->base_)
      *changed = *index;
    else
      changed->base_ = index;
    index = std::move(changed);
  }
  // the only owner, and the object wasn't created as a constant
  return const_cast<IdIndex&>(*index);
}

std::size_t IdIndex::first_change(std::int64_t id) const {
  const auto at =
      std::lower_bound(changes_.begin(), changes_.end(), id, [](const Change& c, std::int64_t wanted) { return c.id < wanted; });
  return static_cast<std::size_t>(at - changes_.begin());
}

void IdIndex::insert_change(std::size_t at, const Change& change) {
  const int by = change.index == kNotFound ? -1 : 1;
  changes_.insert(changes_.begin() + static_cast<std::ptrdiff_t>(at), change);
  changes_[at].shift = static_cast<std::int32_t>(at == 0 ? 0 : changes_[at - 1].shift + (changes_[at - 1].index == kNotFound ? -1 : 1));
  for (std::size_t i = at + 1; i < changes_.size(); ++i) changes_[i].shift += by;
  shift_ += by;
}

void IdIndex::erase_change(std::size_t at) {
  const int by = changes_[at].index == kNotFound ? -1 : 1;
  changes_.erase(changes_.begin() + static_cast<std::ptrdiff_t>(at));
  for (std::size_t i = at; i < changes_.size(); ++i) changes_[i].shift -= by;
  shift_ -= by;
}

void IdIndex::add(std::shared_ptr<const IdIndex>& index, std::int64_t id, std::uint32_t at) {
  IdIndex& mine = own(index);
  const std::size_t place = mine.first_change(id);
  if (place < mine.changes_.size() && mine.changes_[place].id == id) mine.erase_change(place);
  if (mine.base_->find(id) != at) mine.insert_change(place, {id, at, 0});
}

void IdIndex::remove(std::shared_ptr<const IdIndex>& index, std::int64_t id) {
  IdIndex& mine = own(index);
  const std::size_t place = mine.first_change(id);
  if (place < mine.changes_.size() && mine.changes_[place].id == id) mine.erase_change(place);
  if (mine.base_->find(id) != kNotFound) mine.insert_change(place, {id, kNotFound, 0});
}

std::uint32_t IdIndex::find_changed(std::int64_t id) const {
  const std::size_t place = first_change(id);
  return place < changes_.size() && changes_[place].id == id ? changes_[place].index : base_->find(id);
}

std::size_t IdIndex::rank_of(const Change& change) const {
  return static_cast<std::size_t>(static_cast<std::int64_t>(base_->lower_bound(change.id)) + change.shift);
}

std::pair<std::int64_t, std::uint32_t> IdIndex::at_changed(std::size_t rank) const {
  // Ranks ascend with the changes. The last change at or before the wanted rank gives the shift of the base there.
  const auto after = std::partition_point(changes_.begin(), changes_.end(), [&](const Change& change) { return rank_of(change) <= rank; });
  if (after == changes_.begin()) return base_->at(rank);
  const Change& change = *std::prev(after);
  const bool added = change.index != kNotFound;
  if (added && rank_of(change) == rank) return {change.id, change.index};
  return base_->at(static_cast<std::size_t>(static_cast<std::int64_t>(rank) - change.shift - (added ? 1 : -1)));
}

std::size_t IdIndex::lower_bound(std::int64_t id) const {
  if (base_) {
    const std::size_t place = first_change(id);
    const std::int64_t shift = place < changes_.size() ? changes_[place].shift : shift_;
    return static_cast<std::size_t>(static_cast<std::int64_t>(base_->lower_bound(id)) + shift);
  }
  if (!contiguous_) return static_cast<std::size_t>(std::lower_bound(ids_.begin(), ids_.end(), id) - ids_.begin());
  if (id <= first_) return 0;
  const std::uint64_t offset = static_cast<std::uint64_t>(id) - static_cast<std::uint64_t>(first_);
  return static_cast<std::size_t>(std::min<std::uint64_t>(offset, size_));
}

}  // namespace prismesh::mesh
