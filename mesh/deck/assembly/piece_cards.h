// What the cards of a stretch of text say, by id: what every format's fast part fills, any number at a time, and assemble puts together.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

/// As an element's part: it has none.
inline constexpr std::int64_t kNoPart = std::numeric_limits<std::int64_t>::min();

/// Something odd at a place, to be told once a kind.
struct Oddity {
  std::string kind;
  std::size_t offset = 0;  ///< of the first
  std::int64_t id = 0;     ///< 0: none to tell
  std::size_t count = 0;
};

/// Nodes or shells of a piece from `first` on.
struct PieceRun {
  std::uint32_t first = 0;  ///< within the piece
  std::uint16_t style = 0;  ///< CardRun::style
  /// Index into the deck's frames (and id_offsets). A format that learns its frames late may put a number of its own here and turn it
  /// into the index before assembling.
  std::uint32_t frame = 0;
};

struct RawShells {
  std::vector<std::int64_t> id;
  std::vector<std::int64_t> part;
  std::vector<std::array<std::int64_t, 4>> nodes;  ///< corners; a triangle repeats its third
  std::vector<float> thickness;                    ///< empty where no shell of the piece has one of its own
  std::vector<std::uint64_t> offset;
  std::vector<PieceRun> runs;
  std::vector<std::pair<std::uint32_t, std::array<std::int64_t, 4>>> midside;  ///< shell within the piece; 0: none there
};

struct RawElements {
  std::vector<std::int64_t> id;
  std::vector<std::int64_t> part;
  std::vector<std::uint32_t> first_node{0};
  std::vector<std::int64_t> nodes;
  std::vector<std::uint64_t> offset;
};

/// The cards of a piece of one file, in their order.
struct PieceCards {
  std::uint32_t file = 0;
  bool held = false;  ///< its nodes must not be moved: they stand for several places

  std::vector<std::int64_t> node_id;
  std::vector<Vec3> position;  ///< as the cards give it, in the run's frame
  std::vector<std::uint64_t> node_offset;
  std::vector<std::uint32_t> by_parameter;                    ///< nodes whose coordinates a parameter gives, ascending
  std::vector<std::pair<std::uint32_t, std::uint8_t>> holds;  ///< nodes that must not be moved for other reasons: NodeHold bits
  std::vector<PieceRun> node_runs;
  RawShells shells;
  std::array<RawElements, kElementClassCount> elements;  ///< by ElementClass; [shell] stays empty
  ElementCounts counts;
  std::vector<std::pair<std::string, std::size_t>> kinds;  ///< element cards by the deck's own keyword
  std::vector<Oddity> oddities;
  std::optional<std::pair<std::size_t, std::string>> error;  ///< offset and sentence
  bool encrypted = false;                                    ///< ran into an encrypted block

  /// What follows is in this style and frame.
  void begin_nodes(std::uint16_t style, std::uint32_t frame);
  void begin_shells(std::uint16_t style, std::uint32_t frame = 0);
  void note(std::string_view kind, std::size_t offset, std::int64_t id);
  void count_kind(std::string_view kind, std::size_t count = 1);
};

}  // namespace prismesh::mesh::deck
