// Node and element cards into arrays of ids: the part of reading that has to be fast. Runs on any thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/deck/deck.h"
#include "mesh/deck/lsdyna/parameters.h"

namespace prismesh::mesh::deck::lsdyna {

enum class CardKind : std::uint8_t { node, shell, beam, solid, tshell, discrete, mass, mass_of_set, mass_of_part, sph, other };

/// What the cards of a block look like.
struct CardForm {
  CardKind kind = CardKind::node;
  bool thickness = false;  ///< shell: a card of corner thicknesses follows
  bool composite = false;  ///< layers follow, as many cards as there are
  bool composite_long = false;
  int extra_lines = 0;  ///< that follow every element and don't matter here
  int node_lines = 0;   ///< solid: cards of nodes after the one with the ids; 0: seen from the card itself
  int node_fields = 8;  ///< element nodes on the first card
  /// Every entity is one line, so a block may be cut at any line.
  bool single_lines() const { return !thickness && !composite && extra_lines == 0 && kind != CardKind::solid; }
};

/// The form of a block with nodes or elements. nullopt: it has none, or none this version reads.
std::optional<CardForm> card_form(std::string_view keyword);

/// A stretch of text with cards of one form.
struct Segment {
  CardForm form;
  Columns columns = Columns::standard;
  std::uint32_t parameters = 0;  ///< index into the tables of parameters
  std::size_t begin = 0;         ///< offsets into the file's text
  std::size_t end = 0;
};

/// Segments of one file that are read together.
struct Piece {
  std::uint32_t file = 0;
  bool held = false;  ///< its nodes must not be moved
  std::vector<Segment> segments;
};

/// Something odd at a place, to be told once a kind.
struct Oddity {
  std::string kind;
  std::size_t offset = 0;  ///< of the first
  std::int64_t id = 0;
  std::size_t count = 0;
};

struct RawRun {
  std::uint32_t first_node = 0;  ///< within the piece
  Columns columns = Columns::standard;
};

struct RawShells {
  std::vector<std::int64_t> id;
  std::vector<std::int64_t> part;
  std::vector<std::array<std::int64_t, 4>> nodes;
  std::vector<float> thickness;  ///< empty where no shell of the piece has one of its own
  std::vector<std::uint64_t> offset;
  std::vector<std::pair<std::uint32_t, std::array<std::int64_t, 4>>> midside;  ///< shell within the piece
};

struct RawElements {
  std::vector<std::int64_t> id;
  std::vector<std::int64_t> part;
  std::vector<std::uint32_t> first_node{0};
  std::vector<std::int64_t> nodes;
  std::vector<std::uint64_t> offset;
};

/// What the cards of a piece say, in their order, by id.
struct PieceCards {
  std::vector<std::int64_t> node_id;
  std::vector<Vec3> position;
  std::vector<std::uint64_t> node_offset;
  std::vector<std::uint32_t> by_parameter;  ///< nodes whose coordinates a parameter gives, ascending
  std::vector<RawRun> runs;
  RawShells shells;
  std::array<RawElements, kElementClassCount> elements;
  ElementCounts counts;
  std::vector<Oddity> oddities;
  std::optional<std::pair<std::size_t, std::string>> error;  ///< offset and sentence
  bool encrypted = false;                                    ///< ran into an encrypted block

  void note(std::string_view kind, std::size_t offset, std::int64_t id);
};

PieceCards read_piece(std::string_view text, const Piece& piece, const std::vector<Parameters>& parameters);

}  // namespace prismesh::mesh::deck::lsdyna
