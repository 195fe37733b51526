// Node and element cards into arrays of ids: the part of reading that has to be fast. Runs on any thread.
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

/// What the cards of a block look like.
struct CardForm {
  std::string_view word;  ///< "SHELL"
  CardKind kind = CardKind::element;
  ElementClass element_class = ElementClass::other;
  std::array<std::uint8_t, 3> nodes{};  ///< on each of its lines, behind the id on the first
  std::uint8_t ends = 0;                ///< of them are joined; those that follow only give directions and may be missing
  bool id_alone = false;                ///< on the first line; the nodes are on the next
};
/// nullptr: no block of nodes or elements.
const CardForm* card_form(std::string_view word);

/// CardRun::style: how wide the fields are and how many corners a shell has.
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
  double thickness_unit = 1;  ///< what the cards' thicknesses are multiplied by
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Segments of one file that are read together.
struct Piece {
  std::uint32_t file = 0;
  bool held = false;
  std::vector<Segment> segments;
};

/// What the cards' numbers are read with.
struct MeshContext {
  std::span<const Context> contexts;
  const Parameters* parameters = nullptr;
};

/// Nodes that elements only take a direction from, of a piece: node, offset of the card, and the element's word.
struct Direction {
  std::int64_t node = 0;
  std::uint64_t offset = 0;
  const CardForm* form = nullptr;
};

PieceCards read_piece(std::string_view text, const Piece& piece, const MeshContext& context, std::vector<Direction>& directions);

}  // namespace prismesh::mesh::deck::radioss
