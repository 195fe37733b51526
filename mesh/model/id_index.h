// From a deck's id to an index. Ids are sparse, up to 19 digits, and mostly ascending.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace prismesh::mesh {

class IdIndex {
 public:
  static constexpr std::uint32_t kNotFound = 0xffffffffu;

  IdIndex() = default;
  /// `ids[i]` belongs to index i; of equal ids the first counts.
  explicit IdIndex(std::span<const std::int64_t> ids);

  /// The index, or kNotFound.
  std::uint32_t find(std::int64_t id) const;
  /// Ids and indices ascending by id, each id once.
  std::size_t size() const { return sorted_.size(); }
  std::pair<std::int64_t, std::uint32_t> at(std::size_t rank) const { return {sorted_[rank].first, sorted_[rank].second}; }
  /// Rank of the first id >= `id`.
  std::size_t lower_bound(std::int64_t id) const;
  /// Ids that occur more than once, ascending, each once.
  const std::vector<std::int64_t>& duplicates() const { return duplicates_; }

 private:
  std::vector<std::pair<std::int64_t, std::uint32_t>> sorted_;
  std::vector<std::uint32_t> dense_;  ///< id - first_ -> index, where the ids are dense enough
  std::int64_t first_ = 0;
  std::vector<std::int64_t> duplicates_;
};

}  // namespace prismesh::mesh
