// The contents of a deck as a format's reader gives them, by id.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/hash.h"
#include "mesh/deck/assembly/piece_cards.h"
#include "mesh/deck/assembly/warnings.h"
#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

/// Everything a format's reader has found. It becomes a deck and a model.
struct DeckContents {
  Format format = Format::ls_dyna;
  std::vector<SourceFile> files;
  std::vector<Hash128> hashes;  ///< of the files; read_pieces fills them
  std::vector<PieceCards> cards;
  std::vector<Frame> frames{Frame()};  ///< [0]: the basic system
  std::vector<IdOffsets> id_offsets;   ///< as Deck::id_offsets
  std::vector<Part> parts;             ///< defined ones, ascending by id
  References references;
  TimeStepControl time_step;
  ContactCards contacts;
  std::optional<LengthUnit> length_unit;  ///< nullopt: the deck doesn't give it
  Warnings warnings;
  std::vector<std::string> missing_files;
  std::vector<CompanionFile> companions;
  std::vector<UnreadFile> unread_files;
  TakenIds taken;  ///< in any order
};

}  // namespace prismesh::mesh::deck
