// The tables of the fields that name nodes, elements, parts and sets, and the language of these tables (LS-DYNA keyword manual, volume I;
// materials: volume II).
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "mesh/model/references.h"

namespace prismesh::mesh::deck::lsdyna {

enum class RuleKind : std::uint8_t {
  nothing,         ///< names no node, element, part or set
  cards,           ///< as `cards` describes
  set,             ///< *SET_NODE, *SET_SHELL, ...
  contact,         ///< *CONTACT with its options in front
  initial,         ///< *INITIAL_STRESS_..., _STRAIN_...: a card with the element, then as many with values as that one says
  transformation,  ///< *DEFINE_TRANSFORMATION: some of its steps name nodes
};

enum class FieldWidths : std::uint8_t { tens, eights, moves };  ///< moves: 8, 16, 16, 16, 8, 8

/// How `cards` is written. Cards are separated by ';', the fields of a card by blanks; a field is
///   .   names nothing (.5: five such fields); fields behind the last one given are skipped
///   n s b h t d m o e p   names a node, shell, beam, solid, thick shell, discrete element, mass, other or any element, a part (n8: eight)
///   N S B H T D P G E     names a set of those; G of segments
///   p-P   names a part, or a part set if the number is negative
///   rn    two fields: the first and the last id of a range
///   #     the card's own id; !   the same, of a part
///   @3:0P1p   field 3 of this card gives the kind: 0 a part set, 1 a part (z: nothing; a text: its first letter, T if it contains "SET";
///             @2.3: field 3 of card 2)
/// A card may begin with
///   ?1.2=9,10   the card exists if field 2 of card 1 has one of these values (?1.2!=0: hasn't)
///   %1.2        the card is repeated as often as field 2 of card 1 says
///   &1.2        this card and those behind it, together, are repeated as often
///   *           the card is repeated to the end of the block
/// A '^' in front of all cards: a title line comes first.
struct ReferenceRule {
  std::string_view keyword;
  RuleKind kind = RuleKind::nothing;
  std::string_view cards{};
  /// Options that may follow the keyword: "ID^" adds a line before the cards of each entity, "SPC+" a card behind them ("PID+p,p" with
  /// fields), "COLLECT" changes nothing. "*": any option, and none changes the cards.
  std::string_view options{};
  bool once = false;    ///< the block has one entity; further cards are skipped
  bool partly = false;  ///< the block has other cards, which aren't understood
  FieldWidths widths = FieldWidths::tens;
};

/// The rule of a keyword with its options; `options` gets the words behind the rule's own. nullptr: no rule covers it.
const ReferenceRule* find_reference_rule(std::string_view keyword, std::string_view& options);

/// What a letter of the language names. False: nothing.
bool referred_of(char letter, Referred& referred);

/// A field of a card that names something.
struct FieldRule {
  enum class Kind : std::uint8_t { id, range, own_id, own_part, typed };
  Kind kind = Kind::id;
  std::uint8_t field = 0;
  Referred referred = Referred::node;
  Referred negative = Referred::node;  ///< what a negative number names
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
  std::uint8_t condition_card = 0;  ///< from 1; 0: the card always exists
  std::uint8_t condition_field = 0;
  bool unless = false;  ///< the card exists if the field has none of the values
  std::vector<std::int64_t> condition_values;
};

/// Compiles a rule's cards with those of the options. `headers` gets the number of lines before them. False: the rule doesn't know an
/// option.
bool compile(const ReferenceRule& rule, std::string_view options, std::vector<CardRule>& cards, int& headers);

}  // namespace prismesh::mesh::deck::lsdyna
