// The whole numbers in text that the reader doesn't understand: each may be an id.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

/// Appends every whole number that a text may hold, without its sign, however its columns are cut: words between separators and, on lines
/// with words of more than 8 characters, also fields of 8, 10, 16 and 20 columns.
void gather_whole_numbers(std::string_view text, std::vector<std::int64_t>& numbers);

/// Searches a deck's unread text, once, when it is first asked.
class UnreadNumbers {
 public:
  /// The deck must outlive this.
  explicit UnreadNumbers(const Deck& deck) : deck_(deck) {}
  /// The first unread text that holds all these ids, each as in the model or less an offset of an include; nullptr: none. Encrypted text
  /// holds none. `ids` isn't empty.
  const UnreadText* holding_all(Referred referred, std::span<const std::int64_t> ids);

 private:
  void gather();
  std::vector<std::uint32_t> texts_with(Referred referred, std::int64_t id) const;

  const Deck& deck_;
  std::optional<std::vector<std::pair<std::int64_t, std::uint32_t>>> numbers_;  ///< with the index of their text, ascending
};

}  // namespace prismesh::mesh::deck
