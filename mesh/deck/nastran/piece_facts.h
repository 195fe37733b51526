// A piece of a deck's bulk data, and what its cards say.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/deck/assembly/piece_cards.h"
#include "mesh/deck/nastran/definitions.h"
#include "mesh/deck/nastran/frames.h"
#include "mesh/deck/nastran/references.h"

namespace prismesh::mesh::deck::nastran {

/// Text of one file, from the beginning of a card to the end of one.
struct Piece {
  std::uint32_t file = 0;
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Thicknesses on a shell's card that its property completes.
struct ThicknessFields {
  std::uint32_t shell = 0;  ///< within the piece
  double sum = 0;           ///< of those given: lengths, or shares of the property's thickness
  int given = 0;
  int corners = 0;
  bool relative = false;
};

/// A warning; equal ones are counted.
struct Notice {
  std::string kind;
  std::size_t offset = 0;
  std::string message;
  std::size_t count = 1;
};

/// A card that numbers aerodynamic boxes and their corners from its own id on. A count of 0: a list of factors gives the divisions.
struct AeroPanel {
  std::int64_t id = 0;
  std::int64_t spans = 0, chords = 1;
  std::int64_t span_list = 0, chord_list = 0;  ///< ids of AEFACT cards
};

/// What a piece says besides its nodes and elements.
struct PieceFacts {
  Definitions definitions;
  std::vector<SystemCard> systems;
  std::vector<IdRange> scalar_points;
  std::vector<IdRange> unlisted_points;  ///< scalar points that elements name, which need no card
  std::vector<AeroPanel> panels;
  std::vector<std::pair<std::int64_t, std::int64_t>> factor_lists;  ///< AEFACT: id and number of factors
  std::vector<ThicknessFields> thickness;
  std::vector<std::pair<std::size_t, std::int64_t>> grid_default;                        ///< GRDSET: offset and system
  std::map<std::string, std::pair<std::size_t, std::size_t>, std::less<>> old_elements;  ///< first offset and count, by name
  std::vector<Notice> notices;
  bool has_cards = false;        ///< there is anything between the comments
  bool has_known_cards = false;  ///< an entry of bulk data that has a number; lines of other texts may begin with an entry's name
  References references;

  /// Adds a notice, or counts it if there is an equal one.
  void note(std::string_view kind, std::size_t offset, std::string message);
};

struct PieceContent {
  PieceCards cards;
  PieceFacts facts;
};

}  // namespace prismesh::mesh::deck::nastran
