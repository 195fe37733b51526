// Sorts blocks into pieces of mesh text and definitions, and completes the contents of the deck when the pieces are read.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "mesh/deck/assembly/deck_contents.h"
#include "mesh/deck/radioss/definitions.h"
#include "mesh/deck/radioss/mesh_cards.h"
#include "mesh/deck/radioss/walk.h"

namespace prismesh::mesh::deck::radioss {

class Collected {
 public:
  explicit Collected(Walk& walk) : walk_(walk) {}

  /// Reads parameters and definitions, and makes the pieces. Errors: this is no starter deck in block format.
  Result<void> sort_blocks();
  /// Fills parts, frames, offsets and references. `found`: with the files and the pieces' cards; `directions`: by piece, as from
  /// read_piece.
  void complete(DeckContents& found, const std::vector<std::vector<Direction>>& directions);

  Parameters parameters;
  std::vector<Piece> pieces;

 private:
  DeckTables tables(std::span<const SourceFile> files) const { return {files, walk_.contexts, parameters, systems_}; }
  void read_unit_system(const Block& block, const Keyword& keyword);
  void add_directions(DeckContents& found, const std::vector<std::vector<Direction>>& directions);
  static void check_positions(DeckContents& found);
  void check_submodel_units();
  void add_mesh(const Block& block, const Keyword& keyword, const CardForm& form);
  void add_segment(std::uint32_t file, const Segment& segment);
  /// The unit of length of a block, in that of the main file. Warns if it isn't defined.
  double length_unit(const Block& block, std::int64_t system);
  std::uint32_t frame_of(std::uint32_t context, double unit);

  Walk& walk_;
  UnitSystems systems_;
  Definitions definitions_;
  /// The contexts and units of length of nodes' cards, by frame.
  std::vector<std::pair<std::uint32_t, double>> places_{{0, 1.0}};
  std::map<std::pair<std::uint32_t, double>, std::uint32_t> place_index_{{{0, 1.0}, 0}};
};

}  // namespace prismesh::mesh::deck::radioss
