// Finds the index of a deck's id. Ids are sparse, have up to 19 digits, and mostly ascend.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace prismesh::mesh {

/// Costs no memory for ids that count up by one, 8 bytes an id for other ascending ids, and 12 for ids in any order, plus a direct table
/// where the ids are dense enough, and up to 8 bytes an id for a table of spans where they aren't.
class IdIndex {
 public:
  static constexpr std::uint32_t kNotFound = 0xffffffffu;

  IdIndex() = default;
  /// `ids[i]` belongs to index i; of equal ids the first counts.
  explicit IdIndex(std::span<const std::int64_t> ids);

  /// The index, or kNotFound.
  std::uint32_t find(std::int64_t id) const {
    if (size_ == 0 || id < first_) return base_ ? find_changed(id) : kNotFound;
    const std::uint64_t offset = static_cast<std::uint64_t>(id) - static_cast<std::uint64_t>(first_);
    if (contiguous_) return offset < size_ ? static_cast<std::uint32_t>(offset) : kNotFound;
    if (!dense_.empty()) return offset < dense_.size() ? dense_[offset] : kNotFound;
    return find_sorted(id);
  }
  /// Ids and indices ascending by id, each id once.
  std::size_t size() const { return base_ ? static_cast<std::size_t>(static_cast<std::int64_t>(base_->size()) + shift_) : size_; }
  std::pair<std::int64_t, std::uint32_t> at(std::size_t rank) const {
    return base_ ? at_changed(rank) : std::pair(id_at(rank), index_at(rank));
  }
  /// Rank of the first id >= `id`.
  std::size_t lower_bound(std::int64_t id) const;
  /// Ids that occur more than once, ascending, each once.
  const std::vector<std::int64_t>& duplicates() const { return base_ ? base_->duplicates() : duplicates_; }

  /// Adds an id, which must not exist, or removes one. The large index is shared; changes are listed beside it. The list is copied if
  /// another index holds it too. A new entry costs a move of those after it (ids mostly come in ascending order).
  static void add(std::shared_ptr<const IdIndex>& index, std::int64_t id, std::uint32_t at);
  static void remove(std::shared_ptr<const IdIndex>& index, std::int64_t id);

 private:
  /// An id that is missing in the base, or was removed.
  struct Change {
    std::int64_t id = 0;
    std::uint32_t index = kNotFound;  ///< kNotFound: the base has it, and it is gone
    std::int32_t shift = 0;           ///< how many ids more than in the base there are before this one
  };
  static IdIndex& own(std::shared_ptr<const IdIndex>& index);
  std::size_t first_change(std::int64_t id) const;
  void insert_change(std::size_t at, const Change& change);
  void erase_change(std::size_t at);
  std::uint32_t find_changed(std::int64_t id) const;
  std::pair<std::int64_t, std::uint32_t> at_changed(std::size_t rank) const;
  std::size_t rank_of(const Change& change) const;

  std::int64_t id_at(std::size_t rank) const { return contiguous_ ? first_ + static_cast<std::int64_t>(rank) : ids_[rank]; }
  std::uint32_t index_at(std::size_t rank) const { return order_.empty() ? static_cast<std::uint32_t>(rank) : order_[rank]; }
  std::uint32_t find_sorted(std::int64_t id) const;
  void build_dense(std::span<const std::int64_t> ids, std::uint64_t range);
  void build_sorted(std::span<const std::int64_t> ids);
  void build_spans();

  std::size_t size_ = 0;
  std::int64_t first_ = 0;
  bool contiguous_ = false;           ///< index i has id first_ + i: nothing else is stored
  std::vector<std::int64_t> ids_;     ///< ascending
  std::vector<std::uint32_t> order_;  ///< rank -> index; empty where both are the same
  std::vector<std::uint32_t> dense_;  ///< id - first_ -> index, where the ids are dense enough
  int span_bits_ = 0;
  std::vector<std::uint32_t>
      spans_;  ///< where ids aren't dense: (id - first_) >> span_bits_ -> rank of the span's first id; one more at the end
  std::vector<std::int64_t> duplicates_;
  std::shared_ptr<const IdIndex> base_;  ///< if set, only it and the members below count
  std::vector<Change> changes_;          ///< ascending by id
  std::int64_t shift_ = 0;               ///< of all changes
};

}  // namespace prismesh::mesh
