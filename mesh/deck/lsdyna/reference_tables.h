// Which fields of which keyword's cards name something: the tables behind the reverse index, and the language they are written in
// (LS-DYNA keyword manual, volume I; materials: volume II).
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "mesh/model/references.h"

namespace prismesh::mesh::deck::lsdyna {

enum class RuleKind : std::uint8_t {
  nothing,         ///< names no node, element, part or set
  cards,           ///< as `cards` says
  set,             ///< *SET_NODE, *SET_SHELL, ...
  contact,         ///< *CONTACT with its options in front
  initial,         ///< *INITIAL_STRESS_..., _STRAIN_...: a card with the element, then as many with values as that one says
  transformation,  ///< *DEFINE_TRANSFORMATION: some of its steps name nodes
};

enum class FieldWidths : std::uint8_t { tens, eights, moves };  ///< moves: 8, 16, 16, 16, 8, 8

/// How `cards` is written. Cards are separated by ';', the fields of a card by blanks; a field is
///   .   names nothing (.5: five of them); what follows the last field named is passed over
///   n s b h t d m o e p   a node, shell, beam, solid, thick shell, discrete element, mass, other or any element, a part (n8: eight)
///   N S B H T D P G E     a set of those; G of segments
///   p-P   a part, or where the number is negative a part set
///   rn    two fields: from this id to that
///   #     the card's own id, !   the same, which is a part's
///   @3:0P1p   what it is tells field 3 of this card: 0 a part set, 1 a part (z: nothing; text: its first letter, T where it has "SET";
///             @2.3: field 3 of card 2)
/// A card may begin with
///   ?1.2=9,10   it is there if field 2 of card 1 has one of these values (?1.2!=0)
///   %1.2        there are as many as that field says
///   &1.2        this one and those behind it come as often
///   *           it goes on to the end of the block
/// A '^' in front of all cards: a line of title comes first.
struct ReferenceRule {
  std::string_view keyword;
  RuleKind kind = RuleKind::nothing;
  std::string_view cards{};
  /// What may follow the keyword: "ID^" puts a line before the cards of each entity, "SPC+" a card behind them ("PID+p,p" with fields),
  /// "COLLECT" changes nothing. "*": anything, and nothing of it matters.
  std::string_view options{};
  bool once = false;    ///< the keyword has one entity; further cards are of no interest
  bool partly = false;  ///< what else it says isn't understood
  FieldWidths widths = FieldWidths::tens;
};

/// The rule of a keyword, options and all; `options` gets what follows the rule's own words. nullptr: nobody understands it.
const ReferenceRule* find_reference_rule(std::string_view keyword, std::string_view& options);

/// What a letter of the language means; false: nothing.
bool referred_of(char letter, Referred& referred);

/// A field of a card that names something.
struct FieldRule {
  enum class Kind : std::uint8_t { id, range, own_id, own_part, typed };
  Kind kind = Kind::id;
  std::uint8_t field = 0;
  Referred referred = Referred::node;
  Referred negative = Referred::node;  ///< where the number is negative
  bool has_negative = false;
  std::uint8_t type_card = 0;  ///< from 1; 0: this one
  std::uint8_t type_field = 0;
  std::string_view types{};
};

struct CardRule {
  enum class Repeat : std::uint8_t { no, count, group, to_the_end };
  std::vector<FieldRule> fields;
  Repeat repeat = Repeat::no;
  std::uint8_t count_card = 0;  ///< from 1
  std::uint8_t count_field = 0;
  std::uint8_t condition_card = 0;  ///< from 1; 0: it is always there
  std::uint8_t condition_field = 0;
  bool unless = false;
  std::vector<std::int64_t> condition_values;
};

/// A rule's cards with those of the options; `headers` gets the number of lines before them. False: an option that the rule doesn't know.
bool compile(const ReferenceRule& rule, std::string_view options, std::vector<CardRule>& cards, int& headers);

}  // namespace prismesh::mesh::deck::lsdyna
