// Ids for nodes and shells that an edit adds.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "base/error.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/writing/card_writer.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::deck {

/// Whether what comes from `parents` (nodes or shells of the deck) belongs to a set, a range or the like of cards: all of them do, be it by
/// several cards of one set (Referrer::group). `referred`: node or shell.
bool all_named_by(const References& references, Referred referred, std::span<const std::int64_t> parents, std::uint32_t referrer);

/// Gives out ids one after the other: for the same deck, model and order of questions the same ones. An id is free if nothing of its class
/// has or had it (shells: no element at all), no card names it, readable or not, and no range of ids (GENERATE, THRU) holds it that
/// doesn't hold all it comes from. An id within the ranges that hold all it comes from is taken first, else the file's own ids go on, else
/// the lowest free one is taken. It fits the fields of the file's cards.
class NewIds {
 public:
  /// Both must outlive this; what is added to the model meanwhile is seen.
  NewIds(const Deck& deck, const Model& model);

  /// Errors: no id is left (which file, what stands in the way), or there is no card behind which a card for it could go.
  Result<std::int64_t> node(const NodeOrigin& origin);
  Result<std::int64_t> shell(ShellIndex parent);

 private:
  struct Search {
    Referred referred = Referred::node;
    std::vector<std::int64_t> parents;  ///< ids of what it comes from in the deck
    std::uint32_t file = 0;
    std::int64_t last_in_file = 0;
    std::int64_t least = 1;
    std::int64_t largest = 0;
  };
  Result<std::int64_t> find(const Search& search);
  std::optional<std::int64_t> first_free(const Search& search, std::int64_t from, std::int64_t to);
  std::int64_t beyond_taken(Referred referred, std::int64_t id);
  bool was_removed(Referred referred, std::int64_t id);
  std::int64_t beyond_references(const Search& search, std::int64_t id) const;
  bool named_in_unread(std::int64_t id);

  const Deck& deck_;
  const Model& model_;
  std::unique_ptr<const CardWriter> writer_;
  std::vector<IdIndex> other_elements_;
  std::int64_t largest_in_shells_ = 0;
  std::optional<std::vector<std::int64_t>> unread_numbers_;          ///< ascending; gathered when first asked for
  std::map<std::pair<Referred, std::uint32_t>, std::int64_t> next_;  ///< by file: where its own ids go on
  std::map<Referred, std::int64_t> lowest_;                          ///< below none is looked for
  std::map<Referred, std::vector<std::int64_t>> given_;              ///< ascending
  struct Removed {
    std::size_t seen = 0;
    std::vector<std::int64_t> ids;  ///< ascending
  };
  std::map<Referred, Removed> removed_;
};

}  // namespace prismesh::mesh::deck
