// Changes of the cards that name nodes and shells, collected before they are written.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <vector>

#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

/// The deck's shells with the added shells that come from each and are still there.
using ShellFamilies = std::map<ShellIndex, std::vector<ShellIndex>>;

struct CardLine {
  std::uint32_t referrer = 0;  ///< index into References::referrers
  std::uint64_t offset = 0;    ///< of the line in its file
  auto operator<=>(const CardLine&) const = default;
};

struct ChangedSet {
  std::uint32_t referrer = 0;
  bool nodes = false;  ///< nodes join or leave it; false: elements
  auto operator<=>(const ChangedSet&) const = default;
};

/// Ids as in the model.
struct SetChange {
  std::vector<std::int64_t> joining, leaving;
};

/// A card that is copied for a new id.
struct CopiedCard {
  Reference single;  ///< the card's own id
  Referred referred = Referred::node;
};

struct ReferencePlan {
  std::map<ChangedSet, SetChange> sets;
  std::map<std::uint32_t, std::vector<std::int64_t>> companions;  ///< sets to make: ids by the set that they belong to, as a referrer
  std::map<CardLine, std::map<std::int64_t, CopiedCard>> copies;  ///< by the copied line, then by the new id
};

}  // namespace prismesh::mesh::deck
