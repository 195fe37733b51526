// The reverse index: every card of a deck that names a node, an element or a part, except the elements themselves. Edits use it to find
// which sets a new node joins, which ids are in a range, and what must not be deleted.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/model/element_class.h"

namespace prismesh::mesh {

/// The class of entity that a number names. Ids are unique within a class only. The cards that use a set name the set; the set names its
/// members.
enum class Referred : std::uint8_t {
  node,
  shell,
  beam,
  solid,
  tshell,
  discrete,
  mass,
  sph,
  other,  ///< belts and elements without a class of their own
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

/// The numbers of a class of elements.
Referred referred(ElementClass element_class);

constexpr bool is_element(Referred referred) { return referred >= Referred::shell && referred <= Referred::any_element; }
constexpr bool is_set(Referred referred) { return referred >= Referred::node_set; }

/// How a card names an entity.
enum class ReferenceRole : std::uint8_t {
  list,     ///< one of many in a set that new entities may join
  range,    ///< everything in a range of ids, also what is added later (GENERATE, THRU)
  segment,  ///< a corner of a segment, in order
  single,   ///< this one alone: a constraint, a load, a weld, a history, a property of it
};

/// Which shells a card can name by their numbers, in formats that number quads and triangles apart.
enum class ShellKind : std::uint8_t { any, quads, triangles };

/// A card, or a set of cards under one keyword, that names entities.
struct Referrer {
  std::string keyword;       ///< as in the deck: "SET_NODE_LIST", "SPC1"
  std::int64_t id = 0;       ///< of the set or the card; 0: none
  std::string title;         ///< of the set, where it has one
  std::uint32_t file = 0;    ///< index into Deck::files
  std::uint64_t offset = 0;  ///< of its keyword, or of its card where each card is alone
  std::uint64_t end = 0;     ///< one past its last line
  std::uint16_t style = 0;   ///< as CardRun::style: a number that only the format's own reader and writer know
  /// The class of what the card defines under `id`: a set, or a part (a rigid body of nodes has a part's id). Formats whose sets have
  /// names instead of ids leave this out.
  std::optional<Referred> defines{};
  /// Cards with the same keyword, id and (non-empty) group are one set. Empty: the card is a set by itself.
  std::string group{};
  ShellKind shells = ShellKind::any;
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
  bool takes_away = false;  ///< it is removed from the set

  bool names(std::int64_t id) const { return first <= id && id <= last && (id - first) % step == 0; }
};

/// Cards that can't be read: they may name anything.
struct UnreadText {
  std::string keyword;
  std::uint32_t file = 0;
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
  bool encrypted = false;                        ///< then a search for a number finds nothing
  std::vector<std::int64_t> parameter_values{};  ///< whole numbers that parameters stand for in it, ascending
};

class References {
 public:
  /// References in any order, as they are. Precondition: each is of one of the referrers, with 1 <= first <= last and step >= 1.
  static References of(std::vector<Referrer> referrers, std::vector<Reference> references, std::vector<UnreadText> unread);

  std::uint32_t add(Referrer referrer) {
    referrers_.push_back(std::move(referrer));
    return static_cast<std::uint32_t>(referrers_.size() - 1);
  }
  Referrer& referrer(std::uint32_t index) { return referrers_[index]; }
  /// Ids that count up within one line or across lines of one referrer are kept as one entry. Ids below 1 are passed over; a step below
  /// 1 counts as 1.
  void add(Reference reference);
  void add(UnreadText unread) { unread_.push_back(std::move(unread)); }
  void append(References&& more);  ///< appends those of the next piece of the deck
  void finish();                   ///< sorts; after it nothing may be added

  std::span<const Referrer> referrers() const { return referrers_; }
  std::span<const UnreadText> unread() const { return unread_; }
  /// Ascending by (referred, first).
  std::span<const Reference> all() const { return references_; }
  std::span<const Reference> all(Referred referred) const;
  /// The references that name the id; those to any_element count for every class of elements. Precondition: finish() was called.
  std::vector<Reference> naming(Referred referred, std::int64_t id) const;
  bool named(Referred referred, std::int64_t id) const;
  /// Whether a referrer defines the id. Precondition: finish() was called.
  bool defined(Referred referred, std::int64_t id) const;

 private:
  std::vector<Referrer> referrers_;
  std::vector<Reference> references_;
  std::vector<std::int64_t> reaches_;  ///< max `last` of the references of the same kind up to each
  std::vector<UnreadText> unread_;
  std::vector<std::pair<Referred, std::int64_t>> defined_;  ///< ascending
};

}  // namespace prismesh::mesh
