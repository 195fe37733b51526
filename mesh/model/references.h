// The reverse index: every card of a deck that names a node, an element or a part, besides the elements themselves. It tells what an
// edit must carry along: which sets a new node joins, which ids are caught by a range, what mustn't be deleted.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace prismesh::mesh {

/// What a number names. Ids are unique within one of these only. Sets are named by the cards that use them; what is in a set is named by
/// the set.
enum class Referred : std::uint8_t {
  node,
  shell,
  beam,
  solid,
  tshell,
  discrete,
  mass,
  sph,
  other,  ///< belts and whatever has no class of its own
  any_element,
  part,
  node_set,
  shell_set,
  beam_set,
  solid_set,
  tshell_set,
  discrete_set,
  part_set,
  segment_set,
  element_set,  ///< of any class
};
inline constexpr int kReferredCount = 20;
std::string_view name(Referred referred);  ///< "node", "shell", "node set", ...

constexpr bool is_element(Referred referred) { return referred >= Referred::shell && referred <= Referred::any_element; }
constexpr bool is_set(Referred referred) { return referred >= Referred::node_set; }

/// How a card names it.
enum class ReferenceRole : std::uint8_t {
  list,     ///< one of many in a set that others may join
  range,    ///< everything in a range of ids, whoever comes later too (GENERATE, THRU)
  segment,  ///< a corner of a segment, in order
  single,   ///< this one alone: a constraint, a load, a weld, a history, a property of it
};

/// A card, or a set of cards under one keyword, that names entities.
struct Referrer {
  std::string keyword;       ///< as the deck says: "SET_NODE_LIST", "SPC1"
  std::int64_t id = 0;       ///< of the set or the card; 0: none
  std::string title;         ///< of the set, where it has one
  std::uint32_t file = 0;    ///< index into Deck::files
  std::uint64_t offset = 0;  ///< of its keyword, or of its card where cards stand alone
  std::uint64_t end = 0;     ///< one past its last line
  std::uint16_t style = 0;   ///< the format's own, as CardRun::style
  /// What the card makes under `id`, where it does: a set, or a part (a rigid body of nodes has a part's id). Formats that name their
  /// sets by words leave this out.
  std::optional<Referred> defines{};
  /// Cards with the same keyword, id and group, which isn't empty, are one set; an empty group: the card stands alone.
  std::string group{};
};

bool same_set(const Referrer& a, const Referrer& b);  ///< of cards of one group; true as well if they are the same card

/// The ids first, first + step, ... last; a single one has first == last.
struct Reference {
  Referred referred = Referred::node;
  ReferenceRole role = ReferenceRole::single;
  std::int64_t first = 0;
  std::int64_t last = 0;
  std::int64_t step = 1;
  std::uint32_t referrer = 0;
  std::uint64_t card = 0;   ///< offset of the line
  bool takes_away = false;  ///< the set is to be without it

  bool names(std::int64_t id) const { return first <= id && id <= last && (id - first) % step == 0; }
};

/// Cards nobody understands: they may name anything.
struct UnreadText {
  std::string keyword;
  std::uint32_t file = 0;
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
  bool encrypted = false;                        ///< then not even a search for the number tells
  std::vector<std::int64_t> parameter_values{};  ///< whole numbers that parameters stand for in it, ascending
};

class References {
 public:
  std::uint32_t add(Referrer referrer) {
    referrers_.push_back(std::move(referrer));
    return static_cast<std::uint32_t>(referrers_.size() - 1);
  }
  Referrer& referrer(std::uint32_t index) { return referrers_[index]; }
  /// Ids that count up within one line or across lines of one referrer are kept as one entry. Ids below 1 are passed over; a step below
  /// 1 counts as 1.
  void add(Reference reference);
  void add(UnreadText unread) { unread_.push_back(std::move(unread)); }
  void append(References&& more);  ///< of another piece of the deck, after this one's
  void finish();                   ///< sorts; after this only reading

  std::span<const Referrer> referrers() const { return referrers_; }
  std::span<const UnreadText> unread() const { return unread_; }
  /// Ascending by (referred, first).
  std::span<const Reference> all() const { return references_; }
  std::span<const Reference> all(Referred referred) const;
  /// Those that name the id; references to any_element count for every class of elements. After finish().
  std::vector<Reference> naming(Referred referred, std::int64_t id) const;
  bool named(Referred referred, std::int64_t id) const;
  /// Whether a referrer defines it. After finish().
  bool defined(Referred referred, std::int64_t id) const;

 private:
  std::vector<Referrer> referrers_;
  std::vector<Reference> references_;
  std::vector<std::int64_t> reaches_;  ///< greatest `last` of the references of the same kind up to each
  std::vector<UnreadText> unread_;
  std::vector<std::pair<Referred, std::int64_t>> defined_;  ///< ascending
};

}  // namespace prismesh::mesh
