// What reading the references of one block takes and gives. Private to references.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/lsdyna/keyword.h"
#include "mesh/deck/lsdyna/parameters.h"
#include "mesh/model/references.h"

namespace prismesh::mesh::deck::lsdyna {

/// Greater than any id: for what names all there are.
inline constexpr std::int64_t kEveryId = std::numeric_limits<std::int64_t>::max() / 4;

/// A block to read. Offsets are into the file's text.
struct ReferenceBlock {
  std::string_view text;  ///< of the file
  std::uint32_t file = 0;
  std::string keyword;             ///< upper case, options and all, without the asterisk
  std::size_t keyword_offset = 0;  ///< of the asterisk
  std::size_t begin = 0;           ///< of the first line after the keyword
  std::size_t end = 0;
  Columns columns = Columns::standard;
  std::span<const int> widths;  ///< standard widths of the cards' fields
  const Parameters& parameters;
  const IdOffsets& offsets;
};

/// The cards' owner that references belong to: a set, a contact, ...
struct ReferrerCard {
  std::size_t offset = 0;
  std::int64_t id = 0;
  std::string_view title;
  std::optional<Referred> defines;
};

/// Ids that a card names: first, first + step, ... last, as the card gives them.
struct NamedIds {
  Referred referred = Referred::node;
  ReferenceRole role = ReferenceRole::single;
  std::int64_t first = 0;
  std::int64_t last = 0;
  std::int64_t step = 1;
  bool takes_away = false;  ///< the set is to be without them
};

}  // namespace prismesh::mesh::deck::lsdyna
