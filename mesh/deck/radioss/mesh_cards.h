// Reads node and element cards into arrays of ids. Most of a deck is such cards, so this must be fast. Runs on any thread.
// Source: Radioss Reference Guide, "/NODE", "/SHELL", "/SH3N", ... of the elements.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "mesh/deck/assembly/piece_cards.h"
#include "mesh/deck/radioss/context.h"
#include "mesh/deck/radioss/parameters.h"

namespace prismesh::mesh::deck::radioss {

enum class CardKind : std::uint8_t { node, shell, element };

/// The layout of the cards of a block.
struct CardForm {
  std::string_view word;  ///< "SHELL"
  CardKind kind = CardKind::element;
  ElementClass element_class = ElementClass::other;
  std::array<std::uint8_t, 3> nodes{};  ///< number of nodes on each of its lines, behind the id on the first
  std::uint8_t ends = 0;                ///< number of nodes that the element joins; further ones only give directions and may be missing
  bool id_alone = false;                ///< the first line has only the id; the nodes are on the next
};
/// The form of a block by its keyword. nullptr: it has no nodes or elements.
const CardForm* card_form(std::string_view word);

/// CardRun::style of this format: the width of the fields, and the number of corners of a shell.
struct Style {
  bool old = false;  ///< fields of 8 columns
  bool triangle = false;

  std::size_t width() const { return old ? kOldField : kField; }
  std::uint16_t number() const { return static_cast<std::uint16_t>((old ? 1 : 0) | (triangle ? 2 : 0)); }
  static Style of(std::uint16_t number) { return {(number & 1) != 0, (number & 2) != 0}; }
};

/// A stretch of text with cards of one form.
struct Segment {
  const CardForm* form = nullptr;
  bool old = false;
  std::uint32_t context = 0;
  std::uint32_t frame = 0;
  std::int64_t part = 0;      ///< of the elements, as the model numbers it
  double thickness_unit = 1;  ///< factor of the cards' thicknesses
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Segments of one file, read together.
struct Piece {
  std::uint32_t file = 0;
  bool held = false;  ///< as PieceCards::held
  std::vector<Segment> segments;
};

/// The submodels and parameters with which the cards' numbers are read.
struct MeshContext {
  std::span<const Context> contexts;
  const Parameters* parameters = nullptr;
};

/// A node that an element only takes a direction from.
struct Direction {
  std::int64_t node = 0;
  std::uint64_t offset = 0;        ///< of the element's card
  const CardForm* form = nullptr;  ///< of the element
};

/// Reads a piece of a file's text. `directions` gets the nodes of that kind.
PieceCards read_piece(std::string_view text, const Piece& piece, const MeshContext& context, std::vector<Direction>& directions);

}  // namespace prismesh::mesh::deck::radioss
