// How a format writes the cards of nodes and shells. A writer knows no model: text in, text out. Saving decides what is to be written.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

/// A card's new text, from its first character to the end of its last line (without that line's end).
struct WrittenCard {
  std::string text;
  int rounded = 0;            ///< numbers whose field can't hold them exactly
  double largest_error = 0;   ///< of those
  bool turned = false;        ///< angles were changed because the first edge has turned
  bool by_parameter = false;  ///< what would have to change is given by a parameter: the text isn't usable
};

/// A shell to be written: a changed one, or a new one after the example of the one it comes from.
struct ShellCard {
  std::int64_t id = 0;
  std::array<std::int64_t, 4> nodes{};  ///< corners; a triangle repeats its third
  /// The weights of the example's corners at each of this one's: what corner thicknesses and offsets are mixed by.
  std::array<std::array<double, 4>, 4> share{};
  double turn_degrees =
      0;  ///< about the example's normal, from the example's first edge to this one's: what material angles are relative to
};

/// What a card that names one node or shell alone (ReferenceRole::single) means for those that come from it: for a node between others
/// that are all named so, and for the pieces of a split shell.
enum class Inheritance : std::uint8_t {
  stays,    ///< nothing, it goes on meaning the one it names: a history, a concentrated force, a weld
  follows,  ///< it holds of them as well, each by a card of its own (`copy_single`): a constraint, a pressure, an initial stress
  forbids,  ///< nobody knows how to divide it: the edit is refused
};

/// Some text instead of other text of one file.
struct Replacement {
  std::size_t offset = 0;
  std::size_t length = 0;
  std::string text;
};

/// Every card is given by its file's whole text, the offset of its first line, and its run's style.
class CardWriter {
 public:
  virtual ~CardWriter() = default;

  /// One past the card's last character before its last line's end: with continuations, and for shells with the cards of their options.
  virtual std::size_t node_end(std::string_view text, std::size_t offset, std::uint16_t style) const = 0;
  virtual std::size_t shell_end(std::string_view text, std::size_t offset, std::uint16_t style) const = 0;

  /// The coordinates as the card gives them; nullopt where a parameter does.
  virtual std::optional<Vec3> node_coordinates(std::string_view text, std::size_t offset, std::uint16_t style) const = 0;
  /// Only the fields of coordinates that differ between `from` and `to` change; the rest, the columns or commas and the side numbers
  /// lean to stay.
  virtual WrittenCard move_node(std::string_view text, std::size_t offset, std::uint16_t style, const Vec3& from, const Vec3& to) const = 0;
  /// A new node's card in the manner of the one at `offset`, in the same frame, without its constraints and the like.
  virtual WrittenCard new_node(std::string_view text, std::size_t offset, std::uint16_t style, std::int64_t id, const Vec3& at) const = 0;

  /// The shell of the card at `offset` with another id, other corners, or both, everything else carried over. Errors: what the card has
  /// can't be carried over (mid-side nodes, ...): the reason, as the end of a sentence about the shell.
  virtual Result<WrittenCard> shell(std::string_view text, std::size_t offset, std::uint16_t style, const ShellCard& shell) const = 0;

  /// False: the text at the offset also makes other shells, or others are made from it, so it can't be taken out.
  virtual bool stands_alone(std::string_view, std::size_t, std::uint16_t) const { return true; }

  /// Whether a triangle may stand in for a quad on this card (false: its keyword or type says how many corners it has).
  virtual bool holds_triangles_and_quads(std::string_view text, std::size_t offset, std::uint16_t style) const = 0;

  /// A block of its own for some cards, to be put in at `offset`. They follow its header in the given order.
  struct NewBlock {
    std::size_t offset = 0;
    std::string header;  ///< keyword line, without its end
  };

  /// Whether the card gives its node what a new node between such nodes must have as well: constraints, an output system, a set that its
  /// keyword names. Empty: it doesn't; else the same text for cards that give the same.
  virtual std::string node_constraints(std::string_view, std::size_t, std::uint16_t) const { return {}; }
  /// As new_node, with what node_constraints tells of the card.
  virtual Result<WrittenCard> new_constrained_node(std::string_view text, std::size_t offset, std::uint16_t style, std::int64_t id,
                                                   const Vec3& at) const;

  /// Whether nothing may lie between nodes whose cards give different such things (false: it has none of them there, as of sets).
  virtual bool constraints_must_agree() const { return true; }
  /// Where the block gives its nodes these things, and not each card: one without, for new nodes (as new_node writes them) that must not
  /// have them. nullopt: beside the card at `offset` they don't.
  virtual std::optional<NewBlock> block_without_constraints(std::string_view, std::size_t, std::uint16_t) const { return std::nullopt; }

  /// As shell, for where holds_triangles_and_quads says no: the card in the manner of the one at `manner_offset` (another keyword's, with
  /// the wanted number of corners and of the same part), with what the one at `offset` has of its own (thickness, angle, ...).
  virtual Result<WrittenCard> shell_in_manner(std::string_view text, std::size_t offset, std::uint16_t style, std::string_view manner_text,
                                              std::size_t manner_offset, std::uint16_t manner_style, const ShellCard& shell) const;

  /// Whether a card that names shells can name one with so many corners (false: it names only those of the other kind).
  virtual bool can_name(const Referrer&, bool) const { return true; }

  /// Where the part has no card of the wanted kind beside which those shells could stand.
  /// Beside the block that the card at `offset` stands in. Errors: the reason.
  virtual Result<NewBlock> block_of_kind(std::string_view text, std::size_t offset, std::uint16_t style, bool triangles) const;
  /// As shell, as a card of such a block.
  virtual Result<WrittenCard> shell_in_block(std::string_view text, std::size_t offset, std::uint16_t style, const ShellCard& shell) const;

  /// More ids for a set that lists them (ReferenceRole::list), in the manner of its lines. Errors: the reason.
  virtual Result<std::vector<Replacement>> join(std::string_view text, const Referrer& set, std::span<const std::int64_t> ids) const = 0;
  /// As join, and some ids taken out. Unless `leaving` is empty, saving calls this alone. Errors: the reason; also if nothing would be
  /// left.
  virtual Result<std::vector<Replacement>> change_list(std::string_view text, const Referrer& set, std::span<const std::int64_t> joining,
                                                       std::span<const std::int64_t> leaving) const;
  /// The corners of the segment whose line is at `card`, as the text has them; nullopt: it can't be told.
  virtual std::optional<std::array<std::int64_t, 4>> segment(std::string_view, const Referrer&, std::size_t) const { return std::nullopt; }
  /// The segment whose line is at `card` (Reference::card) replaced by others, with its own further fields; by none: its line goes. A
  /// triangle repeats its third corner.
  virtual Result<std::vector<Replacement>> replace_segment(std::string_view text, const Referrer& set, std::size_t card,
                                                           std::span<const std::array<std::int64_t, 4>> with) const;

  /// Whether all cards of a file give ids less the offsets of its mesh. False: the cards that are changed give those of the model.
  virtual bool shifts_whole_files() const { return true; }

  /// What a card that names one alone means for those that come from it.
  virtual Inheritance inheritance(const Referrer& card, Referred referred) const;
  /// Where inheritance says `follows`: the card at `single.card`, once more for each of `ids`, right behind it. `single` names one id,
  /// in the place that counts. Errors: the reason.
  virtual Result<std::vector<Replacement>> copy_single(std::string_view text, const Referrer& card, const Reference& single,
                                                       std::span<const std::int64_t> ids) const;

  /// The largest id that fits the field.
  virtual std::int64_t largest_node_id(std::uint16_t style) const = 0;
  virtual std::int64_t largest_shell_id(std::uint16_t style) const = 0;
};

}  // namespace prismesh::mesh::deck
