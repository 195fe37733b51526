// Writes the cards of nodes and shells, and the cards that name them. A format implements it. It works on text alone and knows no model:
// saving (mesh/deck/editing) decides what to write.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/writing/cards.h"

namespace prismesh::mesh::deck {

/// Errors carry the reason only, as the end of a sentence about the card: "has mid-side nodes". A `triangle` has three corners, otherwise
/// a shell has four.
class CardWriter {
 public:
  virtual ~CardWriter() = default;

  /// One past the card's last character, before its last line's end. Includes continuations and, for shells, the cards of their options.
  virtual std::size_t node_end(const CardRef& card) const = 0;
  virtual std::size_t shell_end(const CardRef& card) const = 0;

  /// The coordinates as the card gives them; nullopt: a parameter gives one.
  virtual std::optional<Vec3> node_coordinates(const CardRef& card) const = 0;
  /// Changes only the coordinates that differ between `from` and `to`. Everything else stays: other fields, columns or commas, the side
  /// that numbers are aligned to.
  virtual WrittenCard move_node(const CardRef& card, const Vec3& from, const Vec3& to) const = 0;
  /// A new node's card in the format and frame of `example`, without the example's constraints.
  virtual WrittenCard new_node(const CardRef& example, std::int64_t id, const Vec3& at) const = 0;

  /// The card with another id, other corners, or both. Everything else is carried over. Errors: something can't be carried over, for
  /// instance mid-side nodes.
  virtual Result<WrittenCard> shell(const CardRef& card, const ShellCard& shell) const = 0;

  /// False: the card's text also makes other shells, or others are made from it, so it can't be removed.
  virtual bool stands_alone(const CardRef&) const { return true; }

  /// Whether the card can hold a triangle as well as a quad. False: its keyword or type fixes the number of corners.
  virtual bool holds_triangles_and_quads(const CardRef& card) const = 0;

  /// A block to insert at `offset`, for cards that need a keyword of their own. The cards follow its header in the given order.
  struct NewBlock {
    std::size_t offset = 0;
    std::string header;  ///< keyword line, without its end
  };

  /// What the card gives its node and a new node between such nodes must have too: constraints, an output system, a set that its keyword
  /// names. Empty: nothing. Equal texts: the same.
  virtual std::string node_constraints(const CardRef&) const { return {}; }
  /// As new_node, with what node_constraints reports of the example.
  virtual Result<WrittenCard> new_constrained_node(const CardRef& example, std::int64_t id, const Vec3& at) const;

  /// Whether a node between nodes with different node_constraints must be refused. False: it gets none of them, as with sets.
  virtual bool constraints_must_agree() const { return true; }
  /// Where the block, not the card, gives the node_constraints: a block that gives none, for the cards of new_node. nullopt: cards beside
  /// this one get none.
  virtual std::optional<NewBlock> block_without_constraints(const CardRef&) const { return std::nullopt; }

  /// As shell, where holds_triangles_and_quads is false. The result has the keyword of `example`, a card of the same part with the wanted
  /// number of corners, and keeps the fields of `card` (thickness, angle, ...).
  virtual Result<WrittenCard> shell_in_manner(const CardRef& card, const CardRef& example, const ShellCard& shell) const;

  /// Whether a card that names shells can name a triangle (true) or a quad (false). False: it names only the other kind.
  virtual bool can_name(const Referrer&, bool) const { return true; }

  /// The set for those members of a set that become triangles or quads, where can_name is false for these: whatever uses the one must use
  /// the other as well. `set`: index into References::referrers. nullopt: such a set isn't there, and new_companion makes it. Errors: there
  /// can't be one; the reason as the end of a sentence about the set, empty where the format has no such sets.
  virtual Result<std::optional<std::uint32_t>> companion(const Deck& deck, std::uint32_t set) const;
  /// A set of `ids`, which aren't empty, behind `set`, and the changes of the cards that use `set`, so that they use both.
  virtual std::vector<FileReplacement> new_companion(const Deck& deck, std::uint32_t set, std::span<const std::int64_t> ids) const;

  /// A block for triangles or for quads, beside the block of `card`, for a part that has no card of that kind yet.
  virtual Result<NewBlock> block_of_kind(const CardRef& card, bool triangles) const;
  /// As shell, for a card in such a block.
  virtual Result<WrittenCard> shell_in_block(const CardRef& card, const ShellCard& shell) const;

  /// Adds ids to a set that lists them (ReferenceRole::list), in the format of its lines.
  virtual Result<std::vector<Replacement>> join(std::string_view text, const Referrer& set, std::span<const std::int64_t> ids) const = 0;
  /// As join, and removes ids. Saving doesn't call join too where ids leave. Errors also: nothing would be left.
  virtual Result<std::vector<Replacement>> change_list(std::string_view text, const Referrer& set, std::span<const std::int64_t> joining,
                                                       std::span<const std::int64_t> leaving) const;
  /// The corners of the segment whose line is at `card`, as the text has them; nullopt: they can't be told.
  virtual std::optional<std::array<std::int64_t, 4>> segment(std::string_view, const Referrer&, std::size_t) const { return std::nullopt; }
  /// Replaces the segment whose line is at `card` (Reference::card) by others, which keep its further fields. No segments: the line is
  /// removed. A triangle repeats its third corner.
  virtual Result<std::vector<Replacement>> replace_segment(std::string_view text, const Referrer& set, std::size_t card,
                                                           std::span<const std::array<std::int64_t, 4>> with) const;

  /// Whether ids on all cards of a file are those of the model less the file's offsets (Deck::offsets_of). False: cards that are changed
  /// have the model's ids.
  virtual bool shifts_whole_files() const { return true; }

  /// How a card that names a single node or shell applies to those that come from it.
  virtual Inheritance inheritance(const Referrer& card, Referred referred) const;
  /// Where inheritance is `follows`: repeats the card at `single.card` for each of `ids`, right behind it. `single` names one id.
  virtual Result<std::vector<Replacement>> copy_single(std::string_view text, const Referrer& card, const Reference& single,
                                                       std::span<const std::int64_t> ids) const;

  /// Searches the card of an element that is no shell. `id`: of the model; `nodes`: its nodes' ids, for the search must not mistake another
  /// for it. Errors: it can't be found or is of a kind that can't be an example; the reason as the end of a sentence about the element.
  virtual Result<ElementPlace> find_element(const Deck& deck, ElementClass element_class, std::int64_t id,
                                            std::span<const std::int64_t> nodes) const;
  /// A new element's card in the format of the one at `example`, of the same part. Everything but its id and nodes is carried over.
  virtual Result<WrittenCard> element_like(std::string_view text, const ElementPlace& example, const ElementCard& element) const;

  /// Whether the card of a weld names the parts of the sheets that it joins (ElementCard::sheets).
  virtual bool names_sheets() const { return false; }
  /// The class of the welds of weld_part.
  virtual ElementClass weld_class() const { return ElementClass::beam; }

  /// Where cards without an example go: behind all others of the main file, before the line that ends it.
  virtual std::size_t end_of_cards(std::string_view text) const { return text.size(); }
  /// The keyword line of such a block for elements of a class and a part (empty: cards need none), and a card in it. Errors: as
  /// shell_in_block.
  virtual Result<std::string> element_header(ElementClass element_class, const Part& part) const;
  virtual Result<WrittenCard> new_element(std::string_view text, ElementClass element_class, const ElementCard& element) const;

  /// What a part of new welds needs that no existing weld is an example for.
  struct WeldPart {
    double diameter = 0;               ///< deck's length unit
    std::vector<std::int64_t> sheets;  ///< ids of the parts that it joins, ascending
    std::optional<double> density;     ///< of the sheets; deck's units, here and below
    std::optional<double> youngs_modulus;
    std::optional<double> poissons_ratio;
    std::optional<double> yield_stress;  ///< absent: the least of the sheets' materials
  };
  /// The part with its name, section and material, and its cards (AddedPart::cards). Ids are above all taken in their class. Errors: a
  /// value isn't known, or the format has no such welds; a whole sentence.
  virtual Result<std::pair<Part, std::string>> weld_part(const Deck& deck, const Model& model, const WeldPart& wanted) const;

  /// What a part of adhesive needs that no existing solid is an example for.
  struct BondPart {
    /// A side of the shells of a part.
    struct SheetSide {
      std::int64_t part = 0;
      bool positive = false;  ///< the side to which the normal points
      auto operator<=>(const SheetSide&) const = default;
    };
    std::vector<std::int64_t> sheets;  ///< ids of the parts that it joins, ascending
    /// The sides that face the first four corners of the hexahedra, and those that face the other four; ascending, each once.
    std::array<std::vector<SheetSide>, 2> facing;
    double density = 0;  ///< of the adhesive; deck's units, here and below
    double youngs_modulus = 0;
    double poissons_ratio = 0;
  };
  /// As weld_part.
  virtual Result<std::pair<Part, std::string>> bond_part(const Deck& deck, const Model& model, const BondPart& wanted) const;

  /// The largest id that fits the field.
  virtual std::int64_t largest_node_id(std::uint16_t style) const = 0;
  virtual std::int64_t largest_shell_id(std::uint16_t style) const = 0;
};

}  // namespace prismesh::mesh::deck
