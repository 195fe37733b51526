// The nodes and elements of a stretch of text, by id. Every format's fast part fills them, many at a time; `assemble` puts them together.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

/// The part of an element that has none.
inline constexpr std::int64_t kNoPart = std::numeric_limits<std::int64_t>::min();

/// Something odd, reported once for each kind.
struct Oddity {
  std::string kind;
  std::size_t offset = 0;  ///< of the first
  std::int64_t id = 0;     ///< of the first; 0: none
  std::size_t count = 0;
};

/// The card of a node that can't be read. The deck is refused only if an element may need the node.
struct UnreadNode {
  std::int64_t id = 0;  ///< 0: not known
  std::size_t offset = 0;
  std::string message;
};

/// Nodes or shells of a piece from `first` on.
struct PieceRun {
  std::uint32_t first = 0;  ///< within the piece
  std::uint16_t style = 0;  ///< CardRun::style
  /// Index into the deck's frames and id_offsets. A format that knows its frames only later may store another number here and replace it
  /// by the index before `assemble`.
  std::uint32_t frame = 0;
  /// Shells of different numberings may have the same ids.
  std::uint8_t numbering = 0;
};

/// An element that isn't among the piece's shells and elements, though it has a card.
struct RawHiddenElement {
  ElementClass element_class = ElementClass::other;
  std::int64_t id = 0;
  std::size_t offset = 0;
  std::vector<std::int64_t> nodes;  ///< ids; those below 1 are none
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

/// A number for a kind of elements that are numbered by themselves. Different words give different numbers, but for rare exceptions.
constexpr std::uint32_t numbering_of(std::string_view word) {
  std::uint32_t hash = 2166136261u;  // FNV-1a
  for (const char c : word) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  return hash;
}

struct RawElements {
  std::vector<std::int64_t> id;
  std::vector<std::int64_t> part;
  std::vector<std::uint32_t> first_node{0};
  std::vector<std::int64_t> nodes;
  std::vector<std::uint64_t> offset;
  /// Masses and other elements of different numberings may have the same ids. Empty: all are of one.
  std::vector<std::uint32_t> numbering;
};

/// The cards of a piece of one file, in their order.
struct PieceCards {
  std::uint32_t file = 0;
  bool held = false;  ///< the file stands for several places of the model, so its nodes must not be moved

  std::vector<std::int64_t> node_id;
  std::vector<Vec3> position;  ///< as the cards give it, in the run's frame
  std::vector<std::uint64_t> node_offset;
  std::vector<std::uint32_t> by_parameter;                    ///< nodes whose coordinates a parameter gives, ascending
  std::vector<std::pair<std::uint32_t, std::uint8_t>> holds;  ///< nodes that must not be moved for other reasons: NodeHold bits
  std::vector<PieceRun> node_runs;
  RawShells shells;
  std::array<RawElements, kElementClassCount> elements;  ///< by ElementClass; [shell] stays empty
  std::vector<RawHiddenElement> hidden;
  ElementCounts counts;
  ElementCounts left_out;                                  ///< of these, cards that are in no array here
  std::vector<std::pair<std::string, std::size_t>> kinds;  ///< element cards by the deck's own keyword
  std::vector<Oddity> oddities;
  std::vector<UnreadNode> unread_nodes;
  std::optional<std::pair<std::size_t, std::string>> error;  ///< offset and sentence
  bool encrypted = false;                                    ///< an encrypted block stands in the piece

  /// Begins a run: the nodes or shells that are added from here on have this style and frame.
  void begin_nodes(std::uint16_t style, std::uint32_t frame);
  void begin_shells(std::uint16_t style, std::uint32_t frame = 0, std::uint8_t numbering = 0);
  /// Adds an element that is left out. `nodes`: ids; those below 1 are none.
  void hide(ElementClass element_class, std::size_t offset, std::int64_t id, std::span<const std::int64_t> nodes);
  void note(std::string_view kind, std::size_t offset, std::int64_t id);
  void count_kind(std::string_view kind, std::size_t count = 1);
};

}  // namespace prismesh::mesh::deck
