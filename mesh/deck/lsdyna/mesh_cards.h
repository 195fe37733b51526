// Node and element cards into arrays of ids: the part of reading that has to be fast. Runs on any thread.
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

/// What the cards of a block look like.
struct CardForm {
  CardKind kind = CardKind::node;
  bool thickness = false;  ///< shell: a card of corner thicknesses follows
  bool composite = false;  ///< layers follow, as many cards as there are
  bool composite_long = false;
  bool coordinate_system = false;  ///< shell: the fifth field of the thicknesses' card is one (_MCID), not an angle
  bool scalar_nodes = false;       ///< shell: the last extra line has nodes of its own for the corners (_DOF)
  int extra_lines = 0;             ///< that follow every element and don't matter here
  int node_lines = 0;              ///< solid: cards of nodes after the one with the ids; 0: seen from the card itself
  int node_fields = 8;             ///< element nodes on the first card
  /// Every entity is one line, so a block may be cut at any line.
  bool single_lines() const { return !thickness && !composite && extra_lines == 0 && kind != CardKind::solid; }
};

/// The form of a block with nodes or elements. nullopt: it has none, or none this version reads.
std::optional<CardForm> card_form(std::string_view keyword);

/// A shell's form and columns in a CardRun::style.
std::uint16_t shell_style(const CardForm& form, Columns columns);
/// Of either kind of run.
inline Columns columns_of(std::uint16_t style) { return static_cast<Columns>(style & 3u); }
CardForm shell_form_of(std::uint16_t style);

/// A stretch of text with cards of one form.
struct Segment {
  CardForm form;
  Columns columns = Columns::standard;
  std::uint32_t parameters = 0;  ///< index into the tables of parameters
  std::size_t begin = 0;         ///< offsets into the file's text
  std::size_t end = 0;
  std::uint32_t frame = 0;  ///< index into the contexts of includes, which is that into the deck's frames
  std::string_view word;    ///< what the deck calls the elements: "SHELL_THICKNESS"; must outlive what is read
};

/// Segments of one file and frame that are read together.
struct Piece {
  std::uint32_t file = 0;
  bool held = false;  ///< its nodes must not be moved
  std::vector<Segment> segments;
};

/// Layers of a composite element go on until the next keyword or a line that only an element's card can be: whole numbers alone, at least
/// five, where eight-column fields begin.
bool looks_like_element(std::string_view line, Columns columns);

PieceCards read_piece(std::string_view text, const Piece& piece, const std::vector<Parameters>& parameters,
                      const std::vector<IncludeContext>& contexts);

}  // namespace prismesh::mesh::deck::lsdyna
