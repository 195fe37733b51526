// A stretch of bulk data into arrays of ids and the little else that counts: the part of reading that has to be fast. Runs on any thread.
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

/// A stretch of one file's text, from the beginning of a card to the end of one.
struct Piece {
  std::uint32_t file = 0;
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// In PieceRun::frame until the deck's systems are known: the system's id, or this for grid points that leave it to GRDSET.
inline constexpr std::uint32_t kSystemOfGrdset = 0xffffffffu;
inline constexpr std::int64_t kMaxSystem = 0xfffffffe;

/// Corner thicknesses of a shell's own that only the property completes.
struct ThicknessFields {
  std::uint32_t shell = 0;  ///< within the piece
  double sum = 0;           ///< of those given: lengths, or shares of the property's thickness
  int given = 0;
  int corners = 0;
  bool relative = false;
};

/// Something to warn of, each kind once.
struct Notice {
  std::string kind;
  std::size_t offset = 0;
  std::string message;
  std::size_t count = 1;
};

struct IdRange {
  std::int64_t first = 0;
  std::int64_t last = 0;
};

/// What a piece says besides its nodes and elements.
struct PieceFacts {
  Definitions definitions;
  std::vector<SystemCard> systems;
  std::vector<IdRange> scalar_points;
  std::vector<ThicknessFields> thickness;
  std::vector<std::pair<std::size_t, std::int64_t>> grid_default;                        ///< GRDSET: offset and system
  std::map<std::string, std::pair<std::size_t, std::size_t>, std::less<>> old_elements;  ///< first offset and count, by name
  std::vector<Notice> notices;
  References references;

  void note(std::string_view kind, std::size_t offset, std::string message);
};

struct PieceContent {
  PieceCards cards;
  PieceFacts facts;
};

PieceContent read_piece(std::string_view text, const Piece& piece);

}  // namespace prismesh::mesh::deck::nastran
