// Reads node and element cards into arrays of ids. Most of a deck is such cards, so this must be fast. Runs on any thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/deck/assembly/piece_cards.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/lsdyna/includes.h"
#include "mesh/deck/lsdyna/parameters.h"

namespace prismesh::mesh::deck::lsdyna {

enum class CardKind : std::uint8_t { node, shell, beam, solid, tshell, discrete, mass, mass_of_set, mass_of_part, sph, other };

/// Which cards an entity of a block has.
struct CardForm {
  CardKind kind = CardKind::node;
  bool thickness = false;  ///< shell: a card of corner thicknesses follows
  bool composite = false;  ///< layers follow, as many cards as there are
  bool composite_long = false;
  bool coordinate_system = false;  ///< shell: the fifth field of the thicknesses' card is one (_MCID), not an angle
  bool scalar_nodes = false;       ///< shell: the last extra line has nodes of its own for the corners (_DOF)
  int extra_lines = 0;             ///< lines behind every element that aren't read
  int node_lines = 0;              ///< solid: cards of nodes after the one with the ids; 0: the card itself tells
  int node_fields = 8;             ///< element nodes on the first card
  /// Whether every entity is one line, so that a block can be cut at any line.
  bool single_lines() const { return !thickness && !composite && extra_lines == 0 && kind != CardKind::solid; }
};

/// The form of a block. nullopt: it has no nodes or elements, or none that this version reads.
std::optional<CardForm> card_form(std::string_view keyword);

/// Packs a shell's form and columns into a CardRun::style.
std::uint16_t shell_style(const CardForm& form, Columns columns);
/// The columns in a CardRun::style of nodes or shells.
inline Columns columns_of(std::uint16_t style) { return static_cast<Columns>(style & 3u); }
CardForm shell_form_of(std::uint16_t style);

/// A stretch of text with cards of one form.
struct Segment {
  CardForm form;
  Columns columns = Columns::standard;
  std::uint32_t parameters = 0;  ///< index into the tables of parameters
  std::size_t begin = 0;         ///< offsets into the file's text
  std::size_t end = 0;
  std::uint32_t frame = 0;  ///< index into the contexts of includes, equal to that into the deck's frames
  std::string_view word;    ///< the deck's own word for the elements: "SHELL_THICKNESS"; must outlive the result
};

/// Segments of one file and frame, read together.
struct Piece {
  std::uint32_t file = 0;
  bool held = false;  ///< as PieceCards::held
  std::vector<Segment> segments;
};

/// Whether a line can only be an element's card, which ends the layers of a composite element: at least five numbers, all whole, where
/// eight-column fields begin.
bool looks_like_element(std::string_view line, Columns columns);

PieceCards read_piece(std::string_view text, const Piece& piece, const std::vector<Parameters>& parameters,
                      const std::vector<IncludeContext>& contexts);

}  // namespace prismesh::mesh::deck::lsdyna
