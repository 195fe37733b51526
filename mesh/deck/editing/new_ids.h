// Chooses ids for nodes and elements that an edit adds.
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

/// Whether a set names all of `parents` in lists or ranges, on one card or on several cards of the set (same_set). `referred`: node or
/// shell; `parents`: ids of the deck; `referrer`: index of a card of the set.
bool all_named_by(const References& references, Referred referred, std::span<const std::int64_t> parents, std::uint32_t referrer);

/// Chooses free ids one after the other. The same deck, model and order of calls give the same ids.
/// An id is free for a new node or shell if no node (for a shell: no element) has or had it, nothing else of the deck takes it
/// (Deck::taken), no card names it, read or unread, and every
/// range of ids (GENERATE, THRU) that holds it also holds all that the new one comes from. It fits the fields of the file's cards.
/// In this order: an id within the ranges that hold all that the new one comes from; the next id after the file's own; the lowest free id.
class NewIds {
 public:
  /// Both must outlive this. The model may change between calls.
  NewIds(const Deck& deck, const Model& model);

  /// Errors: no id is left (with the file and what holds the others), or no card of the deck can be the new card's example.
  Result<std::int64_t> node(const NodeOrigin& origin);
  Result<std::int64_t> shell(ShellIndex parent);
  /// Whether the wanted id is free for what comes from these. If so, it isn't given again.
  Result<bool> take_node(const NodeOrigin& origin, std::int64_t wanted);
  Result<bool> take_shell(ShellIndex parent, std::int64_t wanted);
  /// For a node that lies between no others, with a card like those of its origin. `joins`: as PlacedNode.
  Result<std::int64_t> placed_node(const NodeOrigin& origin, std::uint32_t joins);
  /// For an element that is no shell. `example`: as TopologyChange::element_examples.
  Result<std::int64_t> element(ElementClass element_class, std::uint32_t example);

 private:
  struct IdSearch {
    Referred referred = Referred::node;
    std::vector<std::int64_t> parents;  ///< ids of the deck's nodes or shells that it comes from
    std::uint32_t file = 0;
    std::int64_t last_in_file = 0;
    std::int64_t min = 1;
    std::int64_t max = 0;
  };
  /// Without parents. Errors: as node.
  Result<IdSearch> node_search(const NodeOrigin& origin) const;
  /// With parents. Errors: as node.
  Result<IdSearch> search_for_node(const NodeOrigin& origin) const;
  IdSearch search_for_shell(ShellIndex parent) const;
  bool take(const IdSearch& search, std::int64_t wanted);
  Result<std::int64_t> find(const IdSearch& search);
  std::optional<std::int64_t> first_free(const IdSearch& search, std::int64_t from, std::int64_t to);
  std::int64_t beyond_taken(Referred referred, std::int64_t id);
  bool was_removed(Referred referred, std::int64_t id);
  std::int64_t beyond_references(const IdSearch& search, std::int64_t id) const;
  bool named_in_unread(std::int64_t id);

  const Deck& deck_;
  const Model& model_;
  std::unique_ptr<const CardWriter> writer_;
  std::vector<IdIndex> other_elements_;
  std::int64_t largest_in_shells_ = 0;
  std::optional<std::vector<std::int64_t>> unread_numbers_;          ///< ascending; gathered when first asked for
  std::vector<IdRange> unread_ranges_;                               ///< "a THRU b" in unread text; united
  std::map<std::pair<Referred, std::uint32_t>, std::int64_t> next_;  ///< by file: the next id after its own
  std::map<Referred, std::int64_t> lowest_;                          ///< ids below are taken
  std::map<Referred, std::vector<std::int64_t>> given_;              ///< ascending
  struct RemovedIds {
    std::size_t seen = 0;           ///< removals of the model that are among `ids`
    std::vector<std::int64_t> ids;  ///< ascending
  };
  std::map<Referred, RemovedIds> removed_;
  std::map<std::pair<ElementClass, std::uint32_t>, IdSearch> of_examples_;  ///< how elements like an example are numbered
};

}  // namespace prismesh::mesh::deck
